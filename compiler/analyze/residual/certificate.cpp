#include "analyze/residual/certificate.h"

#include "analyze/kept_lines.h"
#include "analyze/physics/emitted_function.h"
#include "analyze/residual/comparison.h"
#include "analyze/tasks.h"
#include "optimize/inline.h"
#include "optimize/optimize.h"
#include "optimize/rewrite.h"

#include <algorithm>
#include <memory>
#include <mutex>

namespace lobe::analyze {
namespace {

/// Points that one thread takes at a time.
constexpr std::size_t chunk = 512;

/// What is proved needs no points; so many of them hold the proof itself, and the emitted text on
/// the device, against the general function.
constexpr std::size_t share_of_proved = 4;

/// What was dropped is compared where it is off; an effect that is off has its own constants, or
/// what the residual set in place of a range.
SceneBox scene_box(const ir::Module& general, const CertificateSubject& subject)
{
    SceneBox box{*subject.called, subject.residual->settings};
    optimize::Settings own = subject.called->constants;
    for (const ir::Effect& effect : general.effects)
        if (std::ranges::count(subject.dropped, effect.name, &Dropped::effect) > 0)
            for (const ir::Input& input : general[effect.off_when].inputs) own.erase(input.name);
    for (const auto& [name, value] : own) box.constants[name] = value;
    return box;
}

/// The general function with nothing done to it but constants put in, against the residual one.
bool same_graph(const ir::Module& bound, ir::FunctionId meant, const ir::Module& residual,
                ir::FunctionId emitted)
{
    ir::Function f = optimize::inline_calls(bound, meant);
    const ir::Function g = optimize::inline_calls(residual, emitted);
    if (f.inputs.size() != g.inputs.size()) return false;
    // What is known of the inputs is no part of what is computed of them.
    for (std::size_t i = 0; i < f.inputs.size(); ++i) f.inputs[i].range = g.inputs[i].range;
    return optimize::same_function(f, g);
}

const ir::Model* find_model(const ir::Module& module, std::string_view name)
{
    const auto found = std::ranges::find(module.models, name, &ir::Model::name);
    return found == module.models.end() ? nullptr : &*found;
}

/// A function of both modules.
struct Pair {
    std::string name;
    ir::FunctionId meant;
    ir::FunctionId emitted;
    std::string light;  ///< that it shades under; empty: an output
};

/// The outputs of a model, and what it is under the lights that the residual knows.
std::vector<Pair> pairs_of(const ir::Module& general, const ir::Module& residual,
                           const std::string& model)
{
    std::vector<Pair> pairs;
    const ir::Model* const meant = find_model(general, model);
    const ir::Model* const left = find_model(residual, model);
    if (meant == nullptr || left == nullptr) return pairs;
    for (std::size_t i = 0; i < meant->outputs.size(); ++i)
        pairs.push_back(
            {meant->outputs[i].name, meant->outputs[i].function, left->outputs[i].function, ""});
    for (const ir::Shading& shading : residual.shadings) {
        const auto same = std::ranges::find_if(general.shadings, [&](const ir::Shading& other) {
            return other.model.name == model && other.light.name == shading.light.name;
        });
        if (shading.model.name == model && same != general.shadings.end())
            pairs.push_back({"under " + shading.light.name, same->function, shading.function,
                             shading.light.name});
    }
    return pairs;
}

/// A device for every thread that asks for one at the same time: none can be shared.
class Devices {
public:
    explicit Devices(const CertificateOptions& options) : options_(options)
    {
        if (options.execute) give_back(open());
        if (!free_.empty()) facts_ = free_.front()->facts();
    }

    /// Nothing where there is no device.
    std::unique_ptr<device::Device> take()
    {
        const std::lock_guard lock{mutex_};
        if (!facts_) return nullptr;
        if (free_.empty()) return open();
        auto device = std::move(free_.back());
        free_.pop_back();
        return device;
    }
    void give_back(std::unique_ptr<device::Device> device)
    {
        const std::lock_guard lock{mutex_};
        if (device) free_.push_back(std::move(device));
    }
    bool any() const { return facts_.has_value(); }

private:
    std::unique_ptr<device::Device> open() const
    {
        std::string why;
        auto device = device::Device::open(options_.device, why);
        return device ? std::make_unique<device::Device>(*std::move(device)) : nullptr;
    }

    const CertificateOptions& options_;
    std::mutex mutex_;
    std::vector<std::unique_ptr<device::Device>> free_;
    std::optional<device::DeviceFacts> facts_;
};

/// All of one function.
class Work {
public:
    Work(const ir::Module& general, const ir::Module& residual, const Pair& pair,
         const Sources& sources, const SceneBox& box, std::size_t points, Devices& devices)
        : residual_(residual), pair_(pair), sources_(sources),
          comparison_(general, ir::entry_point(general, pair.meant), residual,
                      ir::entry_point(residual, pair.emitted), box, points)
    {
        // The device is part of what results depend on.
        auto device = devices.take();
        key_ = "certificate 2\n" +
               EmittedFunction{residual, sources, pair.emitted, device.get()}.key() +
               comparison_.key();
        devices.give_back(std::move(device));
    }

    const std::string& key() const { return key_; }
    const Comparison& comparison() const { return comparison_; }
    const ResultColumns& on_device() const { return on_device_; }
    const std::string& device() const { return device_; }

    void execute(Devices& devices)
    {
        auto device = devices.take();
        if (!device) return;
        EmittedFunction emitted{residual_, sources_, pair_.emitted, device.get()};
        if (emitted.emitted(comparison_.inputs_of_other(), on_device_).empty())
            device_ = device->facts().name;
        else
            on_device_.clear();
        devices.give_back(std::move(device));
    }

private:
    const ir::Module& residual_;
    const Pair& pair_;
    const Sources& sources_;
    Comparison comparison_;
    std::string key_;
    ResultColumns on_device_;
    std::string device_;
};

/// A function of a subject, from its name to what was found.
struct Item {
    std::size_t subject = 0;
    Pair pair;
    SceneBox box;
    std::unique_ptr<Work> work;
    std::optional<std::string> known;  ///< what a store had
    Equality equality;
};

void read(const std::string& text, Equality& equality)
{
    LineReader reader{text};
    reader(equality.points);
    reader(equality.outside);
    reader(equality.worst);
    reader(equality.device_outside);
    reader(equality.device);
}

/// Everything of the items that no store has, on all threads.
void compare(std::vector<Item*>& items, const CertificateOptions& options, Devices& devices,
             const Store& store)
{
    for_each_task(items.size(), options.jobs,
                  [&](std::size_t i) { items[i]->work->execute(devices); });
    struct Part {
        std::size_t item = 0;
        std::size_t first = 0;
        Disagreement found;
    };
    std::vector<Part> parts;
    for (std::size_t i = 0; i < items.size(); ++i)
        for (std::size_t first = 0; first < items[i]->work->comparison().points(); first += chunk)
            parts.push_back({i, first, {}});
    for_each_task(parts.size(), options.jobs, [&](std::size_t task) {
        Part& part = parts[task];
        const Work& work = *items[part.item]->work;
        const std::size_t left = work.comparison().points() - part.first;
        part.found = work.comparison().count(part.first, std::min(chunk, left), work.on_device());
    });
    std::vector<Disagreement> found(items.size());
    for (const Part& part : parts) found[part.item].add(part.found);
    for (std::size_t i = 0; i < items.size(); ++i) {
        const Disagreement& all = found[i];
        std::string line;
        write_line(line, items[i]->work->comparison().points(), all.outside, all.worst,
                   all.device_outside, items[i]->work->device());
        if (store.save) store.save(items[i]->work->key(), line);
        items[i]->known = std::move(line);
    }
}

}  // namespace

bool Certificate::ok() const { return std::ranges::all_of(outputs, &Equality::ok); }

std::vector<Certificate> certify(const ir::Module& general, const Sources& sources,
                                 const std::string& model,
                                 const std::vector<CertificateSubject>& subjects,
                                 const CertificateOptions& options, const Store& store)
{
    std::vector<Certificate> result(subjects.size());
    std::vector<ir::Module> residuals(subjects.size());
    const ir::Module whole = optimize::optimize(general);
    Devices devices{options};

    // What there is to do, subject by subject, each function for itself.
    std::vector<std::vector<Item>> of_subject(subjects.size());
    for_each_task(subjects.size(), options.jobs, [&](std::size_t s) {
        const CertificateSubject& subject = subjects[s];
        residuals[s] = optimize::optimize(subject.residual->module);
        const SceneBox box = scene_box(general, subject);
        const ir::Module bound = optimize::optimize(optimize::specialize(general, box.constants));
        for (Pair& pair : pairs_of(whole, residuals[s], model)) {
            Item& item = of_subject[s].emplace_back();
            item.subject = s;
            item.box = box;
            if (subject.lights != nullptr)
                if (const auto light = subject.lights->find(pair.light);
                    light != subject.lights->end())
                    item.box.light = &light->second;
            item.equality.output = pair.name;
            item.equality.same_graph = same_graph(bound, pair.meant, residuals[s], pair.emitted);
            item.pair = std::move(pair);
        }
    });
    std::vector<Item*> items;
    for (auto& some : of_subject)
        for (Item& item : some) items.push_back(&item);
    for_each_task(items.size(), options.jobs, [&](std::size_t i) {
        Item& item = *items[i];
        const std::size_t points =
            item.equality.same_graph ? options.points / share_of_proved : options.points;
        item.work = std::make_unique<Work>(whole, residuals[item.subject], item.pair, sources,
                                           item.box, points, devices);
        if (store.load) item.known = store.load(item.work->key());
    });
    std::vector<Item*> unknown;
    for (Item* item : items)
        if (!item->known) unknown.push_back(item);
    compare(unknown, options, devices, store);

    for (Item* item : items) {
        read(*item->known, item->equality);
        result[item->subject].outputs.push_back(item->equality);
    }
    for (std::size_t s = 0; s < subjects.size(); ++s) {
        const CertificateSubject& subject = subjects[s];
        result[s].model = model;
        result[s].dropped = subject.dropped;
        optimize::Called left_out = *subject.called;
        for (const Dropped& each : subject.dropped) left_out.off.insert(each.effect);
        result[s].kept = not_droppable(general, model, left_out, options);
    }
    return result;
}

}  // namespace lobe::analyze
