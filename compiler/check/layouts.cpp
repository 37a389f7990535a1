#include "check/layouts.h"

#include "check/engines.h"
#include "check/exactness.h"
#include "check/gbuffers.h"
#include "check/order.h"

#include <fmt/format.h>

#include <algorithm>

namespace lobe::check {
namespace {

void decide_gbuffers(Program& program, Diagnostics& diagnostics)
{
    for (std::size_t i = 0; i < program.gbuffers.size(); ++i) {
        GbufferDeclaration& declared = program.gbuffers[i];
        if (program.files[declared.file]->broken ||
            !is_needed(program, NameKind::gbuffer, i, declared.file))
            continue;
        declared.gbuffer = resolve_gbuffer(program, declared, diagnostics);
    }
}

void report_second(const ReadPacking& packing, const ReadPacking& first, Diagnostics& diagnostics)
{
    diagnostics.report({.code = Code::duplicate_name,
                        .message = "a module has one packing",
                        .primary = {packing.packing.span, "the second"},
                        .secondary = {{first.packing.span, "the first"}},
                        .notes = {"functions that pack are named after channels and parameters"},
                        .helps = {"move it into a module of its own, which imports the model"}});
}

/// Its own, and those that its packings and engines name.
void keep_gbuffers(const Program& program, Declarations& declarations)
{
    const std::size_t root = program.files.size() - 1;
    for (const GbufferDeclaration& declared : program.gbuffers) {
        if (!declared.gbuffer) continue;
        const std::string& name = declared.gbuffer->name;
        const auto names = [&](const auto& block) { return block.gbuffer == name; };
        if (declared.file == root || std::ranges::any_of(declarations.packings, names) ||
            std::ranges::any_of(declarations.engines, names))
            declarations.gbuffers.push_back(*declared.gbuffer);
    }
}

// ---- numbers

bool overlap(const ir::Field& a, const ir::Field& b)
{
    for (const ir::Slot& x : a.slots)
        for (const ir::Slot& y : b.slots)
            if (x.channel == y.channel && x.low < y.low + y.bits && y.low < x.low + x.bits)
                return true;
    return false;
}

/// Whether a field's channels are unorm somewhere that has to work; those configurations are left
/// in `where`.
bool holds_codes(const ir::Gbuffer& gbuffer, const ir::Field& field, ir::Configurations& where)
{
    ir::Configurations left = where;
    for (const ir::Slot& slot : field.slots) {
        const ir::Channel& channel = gbuffer.channels[slot.channel];
        for (std::size_t i = 0; i < left.size(); ++i)
            left[i] = left[i] && channel.exists[i] &&
                      channel.formats[i].storage == ir::Storage::unorm &&
                      channel.formats[i].bits >= slot.low + slot.bits;
    }
    if (!ir::any(left)) return false;
    where = left;
    return true;
}

/// Parts of a packing with errors that are packings without: together they have every field that
/// numbers can be said of.
std::vector<ir::Packing> sound_parts(const ir::Gbuffer& gbuffer, const ir::Packing& packing)
{
    std::vector<ir::Packing> parts;
    for (const ir::Field& field : packing.fields) {
        bool placed = false;
        for (std::size_t i = 0; !placed && i <= parts.size(); ++i) {
            if (i == parts.size()) {
                parts.push_back(packing);
                parts.back().fields.clear();
            }
            ir::Packing& part = parts[i];
            if (std::ranges::any_of(part.fields,
                                    [&](const ir::Field& other) { return overlap(field, other); }))
                continue;
            const bool fresh = part.fields.empty();
            placed = holds_codes(gbuffer, field, part.supported);
            if (placed)
                part.fields.push_back(field);
            else if (fresh)
                break;
        }
    }
    std::erase_if(parts, [](const ir::Packing& part) { return part.fields.empty(); });
    for (ir::Packing& part : parts)
        std::erase_if(part.exact, [&part](const ir::ExactRequirement& exact) {
            return std::ranges::find(part.fields, exact.parameter, &ir::Field::parameter) ==
                   part.fields.end();
        });
    return parts;
}

}  // namespace

void read_layouts(Program& program, Declarations& declarations, Diagnostics& diagnostics)
{
    decide_gbuffers(program, diagnostics);
    const File& root = program.root();
    if (root.broken) return;
    std::vector<ReadPacking> packings;
    for (const syntax::Item& item : root.tree.items) {
        const auto* node = std::get_if<syntax::PackingItem>(&item.node);
        if (!node) continue;
        if (auto packing = read_packing(program, item, *node, diagnostics)) {
            if (!packings.empty()) report_second(*packing, packings.front(), diagnostics);
            packings.push_back(std::move(*packing));
        }
    }
    for (const syntax::Item& item : root.tree.items)
        if (const auto* node = std::get_if<syntax::EngineItem>(&item.node))
            if (auto engine = read_engine(program, *node, packings, diagnostics))
                declarations.engines.push_back(std::move(*engine));
    for (ReadPacking& packing : packings)
        declarations.packings.push_back(std::move(packing.packing));
    keep_gbuffers(program, declarations);
}

void build_packings(ir::Module& module, Diagnostics& diagnostics)
{
    const bool sound = !diagnostics.has_errors();
    for (std::size_t i = 0; i < module.packings.size(); ++i) {
        ir::Packing& packing = module.packings[i];
        const ir::Gbuffer& gbuffer = *module.find_gbuffer(packing.gbuffer);
        if (sound) {
            place_anchors(module, packing);
            ir::build_functions(module, packing, gbuffer);
            check_values(module, packing, gbuffer, diagnostics);
            continue;
        }
        for (ir::Packing& part : sound_parts(gbuffer, packing)) {
            ir::Module scratch = module;
            place_anchors(scratch, part);
            ir::build_functions(scratch, part, gbuffer);
            check_values(scratch, part, gbuffer, diagnostics);
        }
    }
}

}  // namespace lobe::check
