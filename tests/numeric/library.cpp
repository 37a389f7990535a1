#include "numeric/library.h"

#include "analyze/cells.h"
#include "base/render.h"
#include "compile.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <map>
#include <sstream>

namespace lobe::tests {
namespace {

std::string model_path(std::string_view name) { return "../models/" + std::string{name} + ".lobe"; }

std::string read(const std::string& path)
{
    std::ifstream file{path, std::ios::binary};
    INFO(path);
    REQUIRE(file);
    std::ostringstream text;
    text << file.rdbuf();
    return std::move(text).str();
}

ir::Module compile(const std::string& path, const std::string& text)
{
    const check::Loader loader = [](Sources& sources, std::string_view module, std::string_view) {
        const std::string imported = model_path(module);
        return std::optional{sources.add(imported, read(imported))};
    };
    Sources sources;
    Diagnostics diagnostics;
    const std::uint32_t root = sources.add(path, text);
    const auto module = front(sources, root, loader, diagnostics);
    INFO(render_text(sources, diagnostics));
    REQUIRE(module);
    return *module;
}

}  // namespace

ir::Module module_of(const std::string& text) { return compile("test.lobe", text); }
ir::Module compiled(const std::string& text) { return middle(module_of(text)); }

const ir::Module& definition(const std::string& name)
{
    static std::map<std::string, ir::Module> modules;
    const auto known = modules.find(name);
    if (known != modules.end()) return known->second;
    const std::string path = model_path(name);
    return modules.emplace(name, compile(path, read(path))).first->second;
}

const ir::Module& optimized(const std::string& name)
{
    static std::map<std::string, ir::Module> modules;
    const auto known = modules.find(name);
    if (known != modules.end()) return known->second;
    return modules.emplace(name, middle(definition(name))).first->second;
}

template <class Number>
std::vector<std::vector<Number>> run(const ir::Module& module, const std::string& function,
                                     const Points& points)
{
    std::vector<std::string> header;
    for (const auto& [name, values] : points) header.push_back(name);
    const auto id = module.find(function);
    INFO(function);
    REQUIRE(id);
    const analyze::Binding binding = analyze::bind_columns(module, *id, header);
    INFO((binding.error ? binding.error->message : ""));
    REQUIRE(!binding.error);

    const std::size_t count = points.empty() ? 1 : points.front().second.size();
    std::vector<std::vector<Number>> inputs;
    for (const analyze::Feed& feed : binding.feeds) {
        Number constant{};
        if (feed.text.empty()) {
            const auto& values = points[feed.column].second;
            REQUIRE(values.size() == count);
            std::vector<Number> column;
            for (const double value : values) column.push_back(static_cast<Number>(value));
            inputs.push_back(std::move(column));
        } else {
            REQUIRE(analyze::read_cell(feed.text, {}, constant));
            inputs.emplace_back(count, constant);
        }
    }
    std::vector<std::vector<Number>> results(binding.tape.outputs.size(),
                                             std::vector<Number>(count));
    std::vector<const Number*> in;
    for (const auto& column : inputs) in.push_back(column.data());
    std::vector<Number*> out;
    for (auto& column : results) out.push_back(column.data());
    evaluate::run(binding.tape, evaluate::Columns<Number>{in}, evaluate::Results<Number>{out},
                  count);
    return results;
}

template std::vector<std::vector<float>> run(const ir::Module&, const std::string&, const Points&);
template std::vector<std::vector<double>> run(const ir::Module&, const std::string&, const Points&);

}  // namespace lobe::tests
