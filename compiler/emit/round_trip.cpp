// The compute shader that takes codes out of a packing's channels and puts them back, at many
// points.
#include "emit/frame.h"
#include "emit/packing.h"

#include <fmt/format.h>

namespace lobe::emit {
namespace {

/// The statements of main, and how many floats a point has on both sides.
class MainFunction {
public:
    MainFunction(const ir::Module& module, const ir::Packing& packing, const Dialect& dialect,
                 const PackingFiles& file)
        : module_(module), packing_(packing), dialect_(dialect), file_(file),
          inputs_(packing.channels.size())
    {
        for (const auto& parameter : packing.parameters)
            values_ += ir::components(module[parameter.unpack].type());
        outputs_ = static_cast<int>(inputs_) + values_;
    }

    int outputs() const { return outputs_; }
    const std::vector<std::string>& statements() const { return statements_; }

    /// By the functions themselves.
    void call_functions()
    {
        for (std::size_t i = 0; i < inputs_; ++i)
            say(fmt::format("float harness_read_{} = {};", i, point(i)));
        for (std::size_t i = 0; i < packing_.parameters.size(); ++i) {
            const auto& parameter = packing_.parameters[i];
            std::vector<std::string> operands;
            for (const std::size_t channel : parameter.channels)
                operands.push_back(fmt::format("harness_read_{}", channel));
            say(fmt::format("{} harness_value_{} = {}({});",
                            dialect_.type(module_[parameter.unpack].type()), i,
                            file_.name_of(parameter.unpack), fmt::join(operands, ", ")));
        }
        for (std::size_t i = 0; i < inputs_; ++i) {
            std::vector<std::string> operands;
            for (const ir::Input& input : module_[packing_.channels[i].pack].inputs)
                operands.push_back(fmt::format("harness_value_{}", index_of(input.which)));
            store(static_cast<int>(i),
                  fmt::format("{}({})", file_.name_of(packing_.channels[i].pack),
                              fmt::join(operands, ", ")));
        }
        store_values([](std::size_t i) { return fmt::format("harness_value_{}", i); });
    }

    /// As the engine's shaders do it.
    void call_access(const GbufferAccess& access)
    {
        say("FGBufferData GBuffer = (FGBufferData)0;");
        for (std::size_t i = 0; i < inputs_; ++i)
            say(fmt::format("{} = {};", access.fields[i], point(i)));
        say("FHarnessParameters Parameters = (FHarnessParameters)0;");
        say(fmt::format("{}( GBuffer, Parameters )", access.macro));
        say("FGBufferData Packed = (FGBufferData)0;");
        std::vector<std::string> operands{"Packed"};
        for (const Member& member : access.members) operands.push_back("Parameters." + member.name);
        say(fmt::format("{}( {} );", access.function, fmt::join(operands, ", ")));
        for (std::size_t i = 0; i < inputs_; ++i)
            store(static_cast<int>(i),
                  "Packed" + access.fields[i].substr(access.fields[i].find('.')));
        store_values([&](std::size_t i) { return "Parameters." + access.members[i].name; });
    }

private:
    void say(std::string text) { statements_.push_back(std::move(text)); }

    std::string point(std::size_t channel) const
    {
        return fmt::format("harness_points[harness_index * {}u + {}u]", inputs_, channel);
    }

    void store(int at, const std::string& value)
    {
        say(fmt::format("harness_results[harness_index * {}u + {}u] = {};", outputs_, at, value));
    }

    template <class Name>
    void store_values(const Name& name)
    {
        int at = static_cast<int>(inputs_);
        for (std::size_t i = 0; i < packing_.parameters.size(); ++i) {
            const ir::Type type = module_[packing_.parameters[i].unpack].type();
            for (int k = 0; k < ir::components(type); ++k) {
                std::string value = name(i);
                if (type == ir::Type::boolean)
                    value += " ? 1.0 : 0.0";
                else if (type != ir::Type::scalar)
                    value += fmt::format(".{}", "xyzw"[k]);
                store(at++, value);
            }
        }
    }

    std::size_t index_of(std::uint32_t parameter) const
    {
        for (std::size_t i = 0; i < packing_.parameters.size(); ++i)
            if (packing_.parameters[i].parameter == parameter) return i;
        return 0;
    }

    const ir::Module& module_;
    const ir::Packing& packing_;
    const Dialect& dialect_;
    const PackingFiles& file_;
    std::size_t inputs_;
    int values_ = 0;
    int outputs_ = 0;
    std::vector<std::string> statements_;
};

}  // namespace

Harness packing_harness(const ir::Module& module, const Sources& sources, std::size_t packing,
                        const Target& target)
{
    const ir::Packing& packed = module.packings[packing];
    PackingFiles file{module, sources, target};
    const Artifact artifact = file.artifact(target);
    MainFunction body{module, packed, dialect(target), file};
    const auto access = target.name == "ue4" ? gbuffer_access(module, packing) : std::nullopt;
    if (access)
        body.call_access(*access);
    else
        body.call_functions();

    Record values;
    values.lists["statements"] = lines(body.statements());
    std::string path = "harness/packing.comp";
    if (target.language == Language::hlsl) {
        path = "harness/packing.hlsl";
        values.lists["prelude"] = target.name == "ue4" ? lines({unreal_prelude()}) : lines({});
        values.lists["structures"] = {};
        if (access) {
            Record structure;
            for (const Member& member : access->members)
                structure.lists["members"].push_back(
                    {{{"type", std::string{dialect(target).type(member.input.type)}},
                      {"name", member.name}},
                     {}});
            values.lists["structures"].push_back(std::move(structure));
        }
    } else {
        const bool es = target.language == Language::essl;
        values.texts["version"] = es ? "#version 310 es" : "#version 450";
        values.lists["extensions"] = lines({});
        if (es)
            values.lists["extensions"] = lines({"precision highp float;\nprecision highp int;"});
    }
    Framed framed = insert(render_embedded(path, values).text, artifact.text);

    Harness result;
    result.inputs = static_cast<int>(packed.channels.size());
    result.outputs = body.outputs();
    result.artifact.path =
        fmt::format("{}/{}/harness/{}_on_{}{}", module.name, target.name, packed.model.name,
                    packed.gbuffer, target.language == Language::hlsl ? ".hlsl" : ".comp");
    result.artifact.text = std::move(framed.text);
    result.artifact.origins = moved_down(artifact.origins, framed.first_line - 1);
    return result;
}

}  // namespace lobe::emit
