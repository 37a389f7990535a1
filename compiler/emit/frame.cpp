#include "emit/frame.h"

#include "emit/dialect.h"
#include "emit/template.h"

namespace lobe::emit {

std::string function_prefix(const ir::Module& module, const Target& target)
{
    return target.name == "ue4" ? dialect(target).styled(module.name) + "_" : "";
}

std::string unreal_prelude() { return render_embedded("ue4/prelude.ush", {}).text; }

}  // namespace lobe::emit
