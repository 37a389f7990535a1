#include "analyze/physics/physics.h"

#include "analyze/kept_lines.h"
#include "analyze/physics/laws.h"
#include "analyze/tasks.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <optional>

namespace lobe::analyze {
namespace {

/// Rows of one task, as they are kept.
std::string text_of(const std::vector<PhysicsRow>& rows)
{
    std::string text;
    for (const PhysicsRow& row : rows)
        write_line(text, row.subject, static_cast<int>(row.law), row.where, row.value, row.exact,
                   row.uncertainty, row.kept, row.note);
    return text;
}

void read(std::string_view text, std::vector<PhysicsRow>& out)
{
    for (LineReader reader{text}; !reader.done();) {
        PhysicsRow& row = out.emplace_back();
        int law = 0;
        reader(row.subject);
        reader(law);
        row.law = static_cast<Law>(law);
        reader(row.where);
        reader(row.value);
        reader(row.exact);
        reader(row.uncertainty);
        reader(row.kept);
        reader(row.note);
    }
}

// ---- which laws are asked of what

bool reads_light(const ir::Function& function)
{
    using ir::GeometryField;
    return std::ranges::any_of(function.inputs, [](const ir::Input& input) {
        if (input.origin != ir::Origin::geometry) return false;
        switch (static_cast<GeometryField>(input.which)) {
        case GeometryField::v:
        case GeometryField::n:
        case GeometryField::x:
        case GeometryField::y:
        case GeometryField::cos_o:
        case GeometryField::x_dot_v:
        case GeometryField::y_dot_v: return false;
        default: return true;
        }
    });
}

bool reads_view(const ir::Function& function)
{
    using ir::GeometryField;
    return std::ranges::any_of(function.inputs, [](const ir::Input& input) {
        if (input.origin != ir::Origin::geometry) return false;
        switch (static_cast<GeometryField>(input.which)) {
        case GeometryField::l:
        case GeometryField::n:
        case GeometryField::x:
        case GeometryField::y:
        case GeometryField::cos_i:
        case GeometryField::x_dot_l:
        case GeometryField::y_dot_l: return false;
        default: return true;
        }
    });
}

/// What the field calls a distribution of normals.
bool is_distribution(const ir::Function& function)
{
    const bool geometry = std::ranges::any_of(function.inputs, [](const ir::Input& input) {
        return input.origin == ir::Origin::geometry;
    });
    return function.name.starts_with("D_") && geometry && function.type() == ir::Type::scalar;
}

/// Rows that are made, or kept, together.
struct Task {
    std::string what;
    std::vector<ir::FunctionId> functions;
    std::function<std::vector<PhysicsRow>(std::vector<EmittedFunction>&)> rows;
};

std::vector<Task> tasks_of(const ir::Module& module)
{
    std::vector<Task> tasks;
    const auto add = [&](std::string_view law, ir::FunctionId function, auto rows) {
        tasks.push_back({fmt::format("{}, {}", module[function].name, law),
                         {function},
                         [rows](std::vector<EmittedFunction>& of) { return rows(of.front()); }});
    };
    const std::vector<ir::FunctionId> functions = checked_functions(module);
    for (const ir::FunctionId function : functions)
        if (is_distribution(module[function]))
            add(name(Law::normalized), function, normalized_rows);
    for (const ir::Model& model : module.models) {
        bool all_light = true;
        for (const ir::ModelOutput& output : model.outputs) {
            const ir::Function& of = module[output.function];
            const bool light = reads_light(of);
            all_light &= light;
            add(name(Law::albedo), output.function,
                [light](EmittedFunction& one) { return albedo_rows(one, light); });
            if (light && reads_view(of))
                add(name(Law::reciprocal), output.function, reciprocal_rows);
        }
        if (model.outputs.size() < 2 || !all_light) continue;
        Task& whole = tasks.emplace_back();
        whole.what = fmt::format("{}, {}", model.name, name(Law::albedo));
        for (const ir::ModelOutput& output : model.outputs)
            whole.functions.push_back(output.function);
        whole.rows = [&model](std::vector<EmittedFunction>& of) {
            return whole_albedo_rows(of, model.name);
        };
    }
    for (const ir::FunctionId function : functions)
        if (module[function].kind != ir::Function::Kind::storage)
            add(name(Law::positive), function, positive_rows);
    return tasks;
}

}  // namespace

std::string_view name(Law law)
{
    switch (law) {
    case Law::normalized: return "normalized";
    case Law::albedo: return "albedo";
    case Law::reciprocal: return "reciprocal";
    case Law::positive: return "positive";
    }
    return "";
}

std::string physics_subject(std::string_view name, std::string_view setting)
{
    return setting.empty() ? std::string{name} : fmt::format("{}, {}", name, setting);
}

PhysicsRow failed_row(std::string_view name, Law law, std::string why)
{
    PhysicsRow row;
    row.subject = name;
    row.law = law;
    std::ranges::replace_if(
        why, [](char c) { return c == '\n' || c == '\t'; }, ' ');
    row.note = std::move(why);
    return row;
}

std::vector<PhysicsRow> physics(const ir::Module& module, const Sources& sources,
                                const PhysicsOptions& options, const Store& store)
{
    std::string no_device;
    std::optional<device::Device> device;
    if (options.execute) device = device::Device::open(options.device, no_device);

    const std::vector<Task> tasks = tasks_of(module);
    std::vector<std::string> texts(tasks.size());
    std::mutex mutex;
    std::size_t done = 0;
    for_each_task(tasks.size(), options.jobs, [&](std::size_t i) {
        const Task& task = tasks[i];
        std::vector<EmittedFunction> functions;
        std::string key = fmt::format("physics 1\n{}\n", task.what);
        for (const ir::FunctionId function : task.functions) {
            functions.emplace_back(module, sources, function, device ? &*device : nullptr);
            key += functions.back().key();
        }
        texts[i] = kept(store, key, [&] { return text_of(task.rows(functions)); });
        const std::lock_guard lock{mutex};
        ++done;
        if (options.progress) options.progress({done, tasks.size(), task.what});
    });
    std::vector<PhysicsRow> rows;
    for (const std::string& text : texts) read(text, rows);
    return rows;
}

}  // namespace lobe::analyze
