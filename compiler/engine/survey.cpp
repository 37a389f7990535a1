#include "engine/survey.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace lobe::engine {
namespace {

bool contains(const std::vector<std::string>& list, const std::string& item)
{
    return std::ranges::find(list, item) != list.end();
}

int shown_line(std::size_t line) { return static_cast<int>(line) + 1; }

void read_file(SurveyedFile& file, std::vector<Obstacle>& obstacles)
{
    if (!file.bytes) return;
    if (file.bytes->find('\0') != std::string::npos) {
        obstacles.push_back({file.path,
                             0,
                             {},
                             {},
                             "has NUL bytes in it, so it is no text that edits fit in",
                             "save it as UTF-8"});
        return;
    }
    file.text = to_lines(*file.bytes);
    for (const Line& line : file.text.lines)
        if (line.end != LineEnd::none) file.crlf += line.end == LineEnd::crlf ? 1 : -1;
    FoundRegions found = find_regions(file.text);
    for (const BrokenMark& mark : found.broken)
        obstacles.push_back(
            {file.path,
             shown_line(mark.line),
             {},
             {},
             mark.what,
             "restore the file from version control, or take the marks and what is between them "
             "out by hand"});
    file.sound = found.broken.empty();
    file.regions = std::move(found.regions);
}

/// No path out of the tree, whatever a mark says.
bool stays_inside(std::string_view path)
{
    if (path.empty() || path.starts_with('/')) return false;
    for (std::size_t at = 0; at <= path.size();) {
        const auto end = std::min(path.find('/', at), path.size());
        if (path.substr(at, end - at) == "..") return false;
        at = end + 1;
    }
    return true;
}

/// Adds the models that came after those that are known, because their regions say so or are
/// inside of theirs; true if any.
bool add_later(const std::vector<Region>& regions, bool inside, const std::string& model,
               std::vector<std::string>& later)
{
    bool any = false;
    for (const Region& region : regions) {
        const bool known = region.model == model || contains(later, region.model);
        const bool on_top =
            inside || std::ranges::any_of(region.under, [&](const std::string& other) {
                return other == model || contains(later, other);
            });
        if (on_top && !known) {
            later.push_back(region.model);
            any = true;
        }
        any |= add_later(region.inside, inside || known, model, later);
    }
    return any;
}

}  // namespace

bool is_later(const Survey& survey, const std::string& model)
{
    return contains(survey.later, model);
}

Survey survey_tree(const Tree& tree, const EditList& list, const std::string& model,
                   std::vector<Obstacle>& obstacles)
{
    Survey survey;
    survey.model = model;
    for (const TreeFile& listed : list.files) {
        SurveyedFile& file = survey.files.emplace_back();
        file.path = listed.path;
        file.bytes = tree.read(listed.path);
        read_file(file, obstacles);
        for_each_region(file.regions, [&](const Region& region, int) {
            if (region.model == model) ++survey.regions;
        });
    }
    for (bool more = true; more;) {
        more = false;
        for (const SurveyedFile& file : survey.files)
            more |= add_later(file.regions, false, model, survey.later);
    }
    for (const SurveyedFile& file : survey.files)
        for_each_region(file.regions, [&](const Region& region, int) {
            const std::string& other = region.model;
            if (other != model && !is_later(survey, other) && !contains(survey.earlier, other))
                survey.earlier.push_back(other);
        });
    std::ranges::sort(survey.earlier);
    std::ranges::sort(survey.later);
    return survey;
}

void check_unedited(const Survey& survey, std::vector<Obstacle>& obstacles)
{
    for (const SurveyedFile& file : survey.files)
        for_each_region(file.regions, [&](const Region& region, int) {
            if (!region.edited) return;
            if (region.model != survey.model && !is_later(survey, region.model)) return;
            obstacles.push_back(
                {file.path,
                 shown_line(region.begin),
                 region.name,
                 {},
                 fmt::format("the generated region in lines {}-{} was edited by hand",
                             shown_line(region.begin), shown_line(region.end)),
                 "undo that edit, or move it out of the region; to change what is generated, "
                 "change the model"});
        });
}

void check_complete(const Survey& survey, const std::vector<std::string>& lacking,
                    std::vector<Obstacle>& obstacles)
{
    // Regions that could not be read are not missing, and that they could not has been said.
    const auto is_broken = [](const SurveyedFile& file) { return file.bytes && !file.sound; };
    if (std::ranges::any_of(survey.files, is_broken)) return;
    struct Place {
        std::string file;
        std::size_t line;
    };
    std::map<int, Place> found;
    std::set<int> totals;
    for (const SurveyedFile& file : survey.files)
        for_each_region(file.regions, [&](const Region& region, int) {
            if (region.model != survey.model) return;
            totals.insert(region.total);
            const auto [place, is_new] = found.insert({region.number, {file.path, region.begin}});
            if (is_new) return;
            obstacles.push_back(
                {file.path,
                 shown_line(region.begin),
                 region.name,
                 {},
                 fmt::format("region {} of {} is there twice, also at {}:{}", region.number,
                             survey.model, place->second.file, shown_line(place->second.line)),
                 "take the copy out by hand"});
        });
    if (found.empty()) return;
    const int total = *totals.rbegin();
    if (totals.size() == 1 && std::cmp_equal(found.size(), total)) return;

    const std::string seen =
        totals.size() > 1
            ? fmt::format("regions of patches with {} regions each", fmt::join(totals, " and "))
            : fmt::format("{} of {} regions", found.size(), total);
    const std::string where =
        lacking.empty() ? "none of the files that this version of lobec changes lacks one"
                        : fmt::format("these files lack theirs: {}", fmt::join(lacking, ", "));
    obstacles.push_back({lacking.empty() ? found.begin()->second.file : lacking.front(),
                         0,
                         {},
                         {},
                         fmt::format("a patch of {} was applied in half: there are {}; {}",
                                     survey.model, seen, where),
                         "revert it (that takes out what is there), then patch again"});
}

std::vector<std::string> named_new_files(const Survey& survey)
{
    std::vector<std::string> paths;
    for (const SurveyedFile& file : survey.files)
        for_each_region(file.regions, [&](const Region& region, int) {
            if (region.model != survey.model) return;
            for (const std::string& path : region.new_files)
                if (stays_inside(path) && !contains(paths, path)) paths.push_back(path);
        });
    return paths;
}

}  // namespace lobe::engine
