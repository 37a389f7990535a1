#include "engine/patch.h"

#include "engine/answers.h"
#include "engine/new_files.h"
#include "engine/placing.h"
#include "engine/survey.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>

namespace lobe::engine {
namespace {

/// Says so, if less than half of the files that every engine has are there.
bool is_engine(const EditList& list, const Survey& survey, const Answers& answers,
               std::vector<Obstacle>& obstacles)
{
    std::size_t needed = 0;
    std::vector<std::string> missing;
    for (std::size_t i = 0; i < list.files.size(); ++i) {
        const TreeFile& file = list.files[i];
        const Condition& condition = file.condition;
        if (file.optional || condition.since || condition.until || !holds(condition, answers))
            continue;
        ++needed;
        if (!survey.files[i].bytes) missing.push_back(file.path);
    }
    if (2 * missing.size() <= needed) return true;
    constexpr std::size_t most = 4;
    std::string names;
    for (std::size_t i = 0; i < std::min(most, missing.size()); ++i)
        names += fmt::format("{}{}", i == 0 ? "" : ", ", missing[i]);
    if (missing.size() > most) names += fmt::format(" and {} more", missing.size() - most);
    obstacles.push_back({{},
                         0,
                         {},
                         {},
                         fmt::format("this is no engine's tree: it lacks {} of {} files: {}",
                                     missing.size(), needed, names),
                         "name the folder that has Engine/ in it"});
    return false;
}

std::function<bool(const std::string&)> later_models(const Survey& survey)
{
    return [&survey](const std::string& model) { return is_later(survey, model); };
}

std::function<bool(const std::string&)> later_models_and_this(const Survey& survey)
{
    return [&survey](const std::string& model) {
        return model == survey.model || is_later(survey, model);
    };
}

/// What anchors see: the file without the model's edits and without what came on top of them. Takes
/// the texts of files without regions.
SearchedFiles pristine_files(Survey& survey)
{
    SearchedFiles result;
    for (SurveyedFile& file : survey.files) {
        auto& pristine = result.emplace_back();
        if (!file.sound) continue;
        if (file.regions.empty()) {
            const std::size_t size = file.text.lines.size();
            std::vector<std::size_t> origins(size);
            std::iota(origins.begin(), origins.end(), std::size_t{0});
            pristine = make_searched(file.path, std::move(file.text), std::move(origins),
                                     std::vector<bool>(size));
            continue;
        }
        Restored restored = without_regions(file.text, file.regions, later_models_and_this(survey));
        std::vector<bool> marks = mark_lines(restored.text, find_regions(restored.text).regions);
        pristine = make_searched(file.path, std::move(restored.text), std::move(restored.origins),
                                 std::move(marks));
    }
    return result;
}

void check_presence(const EditList& list, const Survey& survey, const Answers& answers,
                    std::vector<Obstacle>& obstacles)
{
    for (std::size_t i = 0; i < list.files.size(); ++i) {
        const TreeFile& file = list.files[i];
        if (survey.files[i].bytes || file.optional || !holds(file.condition, answers)) continue;
        obstacles.push_back({file.path,
                             0,
                             {},
                             {},
                             "this file is not in the tree",
                             fmt::format("find out where the engine keeps it, and change line {} "
                                         "of the list",
                                         file.line)});
    }
}

/// By file of the list. Numbered in the list's order.
std::vector<std::vector<Placement>> place_all(const EditList& list, const SearchedFiles& files,
                                              const Answers& answers, int& count,
                                              std::vector<Obstacle>& obstacles)
{
    std::vector<std::vector<Placement>> places(files.size());
    count = 0;
    for (const Edit& edit : list.edits) {
        if (!is_active(list, files, edit.file, answers) || !holds(edit.condition, answers))
            continue;
        const auto file = static_cast<std::size_t>(edit.file);
        for (Placement& placement : place(edit, *files[file], answers.record, obstacles)) {
            placement.number = ++count;
            places[file].push_back(std::move(placement));
        }
    }
    for (std::size_t file = 0; file < files.size(); ++file)
        if (files[file]) check_places(*files[file], places[file], obstacles);
    return places;
}

/// Files with fewer of the model's regions than they should have.
std::vector<std::string> lacking_files(const Survey& survey,
                                       const std::vector<std::vector<Placement>>& places)
{
    std::vector<std::string> lacking;
    for (std::size_t i = 0; i < survey.files.size(); ++i) {
        std::size_t found = 0;
        for_each_region(survey.files[i].regions, [&](const Region& region, int) {
            if (region.model == survey.model) ++found;
        });
        if (found < places[i].size()) lacking.push_back(survey.files[i].path);
    }
    return lacking;
}

void check_writable(const Tree& tree, const std::vector<Change>& changes,
                    std::vector<Obstacle>& obstacles)
{
    if (!tree.refuses_write) return;
    for (const Change& change : changes) {
        if (!change.before) continue;
        const std::string why = tree.refuses_write(change.path);
        if (!why.empty())
            obstacles.push_back({change.path,
                                 0,
                                 {},
                                 {},
                                 fmt::format("this file cannot be written: {}", why),
                                 "check it out, or give yourself the right to write it"});
    }
}

bool mostly_crlf(const Survey& survey)
{
    std::ptrdiff_t balance = 0;
    for (const SurveyedFile& file : survey.files) balance += file.crlf;
    return balance > 0;
}

/// Changes of files that stand in the tree, against what they would be without later models.
std::vector<Change> change_files(const Survey& survey, const SearchedFiles& files,
                                 std::vector<std::vector<Placement>> places, int total)
{
    std::vector<Change> changes;
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (!files[i]) continue;
        const SurveyedFile& file = survey.files[i];
        std::string after = with_regions(*files[i], std::move(places[i]), survey.model, total);
        std::optional<std::string> below;
        if (!survey.later.empty() && !file.regions.empty())
            below = to_bytes(without_regions(file.text, file.regions, later_models(survey)).text);
        const std::string& before = below ? *below : *file.bytes;
        if (before != after) changes.push_back({file.path, before, std::move(after)});
    }
    return changes;
}

/// The first region names the models below and the files that come along.
void complete_first(std::vector<std::vector<Placement>>& places, const Survey& survey,
                    const std::vector<PlannedFile>& new_files)
{
    for (std::vector<Placement>& in_file : places)
        for (Placement& place : in_file) {
            if (place.number != 1) continue;
            place.under = survey.earlier;
            for (const PlannedFile& file : new_files) place.new_files.push_back(file.path);
        }
}

Plan finished(Plan plan, std::vector<Change> changes, std::vector<Obstacle> obstacles)
{
    if (obstacles.empty()) plan.changes = std::move(changes);
    std::ranges::stable_sort(plan.changes, {}, &Change::path);
    plan.obstacles = std::move(obstacles);
    return plan;
}

/// One obstacle, if other models came on top of this one.
void refuse_later(const Survey& survey, std::string_view verb, std::vector<Obstacle>& obstacles)
{
    if (survey.later.empty()) return;
    const std::string others = fmt::format("{}", fmt::join(survey.later, " and "));
    std::optional<Obstacle> first;
    for (const SurveyedFile& file : survey.files)
        for_each_region(file.regions, [&](const Region& region, int) {
            if (first || !is_later(survey, region.model)) return;
            first = {file.path,
                     static_cast<int>(region.begin) + 1,
                     region.name,
                     {},
                     fmt::format("{} was patched in on top of {}", others, survey.model),
                     fmt::format("revert {} first, {} {}, then patch {} again", others, verb,
                                 survey.model, others)};
        });
    obstacles.push_back(*first);
}

std::vector<std::string> former_new_files(const Survey& survey, const EditList& list,
                                          const Answers& answers)
{
    std::vector<std::string> paths = named_new_files(survey);
    for (std::string& path : possible_new_files(list, answers))
        if (std::ranges::find(paths, path) == paths.end()) paths.push_back(std::move(path));
    return paths;
}

}  // namespace

Plan plan_patch(const Tree& tree, const EditList& list, const Request& request)
{
    Plan plan;
    std::vector<Obstacle> obstacles;
    Survey survey = survey_tree(tree, list, request.model, obstacles);
    Answers answers = first_answers(request);
    if (!is_engine(list, survey, answers, obstacles)) return finished({}, {}, {obstacles.back()});

    const SearchedFiles files = pristine_files(survey);
    const bool known = ask_what_it_is(list, files, answers, obstacles);
    plan.version = answers.version_text;
    if (!known) return finished(std::move(plan), {}, std::move(obstacles));
    check_presence(list, survey, answers, obstacles);
    check_unedited(survey, obstacles);
    ask_for_values(list, files, answers, obstacles);
    plan.read = answers.values;

    auto places = place_all(list, files, answers, plan.regions, obstacles);
    check_complete(survey, lacking_files(survey, places), obstacles);
    const auto planned = new_files(list, request, answers, obstacles);
    complete_first(places, survey, planned);
    std::vector<Change> changes = change_files(survey, files, std::move(places), plan.regions);
    if (!changes.empty()) refuse_later(survey, "patch", obstacles);
    for (Change& change :
         change_new_files(tree, request.model, planned, former_new_files(survey, list, answers),
                          mostly_crlf(survey), obstacles))
        changes.push_back(std::move(change));
    check_writable(tree, changes, obstacles);
    return finished(std::move(plan), std::move(changes), std::move(obstacles));
}

Plan plan_revert(const Tree& tree, const EditList& list, const Request& request)
{
    Plan plan;
    std::vector<Obstacle> obstacles;
    const Survey survey = survey_tree(tree, list, request.model, obstacles);
    const Answers answers = first_answers(request);
    if (!is_engine(list, survey, answers, obstacles)) return finished({}, {}, {obstacles.back()});

    check_unedited(survey, obstacles);
    refuse_later(survey, "revert", obstacles);
    std::vector<Change> changes;
    if (survey.later.empty())
        for (const SurveyedFile& file : survey.files) {
            if (!file.sound || file.regions.empty()) continue;
            std::string after = to_bytes(
                without_regions(file.text, file.regions, later_models_and_this(survey)).text);
            if (after != *file.bytes) changes.push_back({file.path, file.bytes, std::move(after)});
        }
    for (Change& change : change_new_files(
             tree, request.model, {}, former_new_files(survey, list, answers), false, obstacles))
        changes.push_back(std::move(change));
    check_writable(tree, changes, obstacles);
    return finished(std::move(plan), std::move(changes), std::move(obstacles));
}

}  // namespace lobe::engine
