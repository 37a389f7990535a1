// The forms for programs: JSON lines, and SARIF 2.1.0 for code-review tools.
#include "base/render.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace lobe {
namespace {

// Members in the order they were added: readers see what matters first.
using Json = nlohmann::ordered_json;

/// Texts come from files and paths, which may hold any bytes.
std::string dump(const Json& json, int indent)
{
    return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string_view level(Code code)
{
    return severity(code) == Severity::error ? "error" : "warning";
}

bool has_place(const Sources& sources, const Span& span) { return span.source < sources.size(); }

Json place(const Sources& sources, const Span& span)
{
    if (!has_place(sources, span)) return nullptr;
    const Source& source = sources[span.source];
    const Position begin = source.position(span.begin);
    const Position end = source.position(span.end);
    return {{"path", source.path()},          {"line", begin.line},       {"column", begin.column},
            {"end_line", end.line},           {"end_column", end.column}, {"offset", span.begin},
            {"length", span.end - span.begin}};
}

Json labeled_place(const Sources& sources, const Label& label)
{
    Json result = place(sources, label.span);
    if (result.is_object()) result["label"] = label.text;
    return result;
}

Json object(const Sources& sources, const Diagnostic& diagnostic)
{
    Json result{{"code", id(diagnostic.code)},
                {"severity", level(diagnostic.code)},
                {"message", diagnostic.message},
                {"primary", labeled_place(sources, diagnostic.primary)}};
    result["secondary"] = Json::array();
    for (const Label& label : diagnostic.secondary)
        result["secondary"].push_back(labeled_place(sources, label));
    result["notes"] = diagnostic.notes;
    result["helps"] = diagnostic.helps;
    if (diagnostic.fix) {
        result["fix"] = place(sources, diagnostic.fix->span);
        if (result["fix"].is_object()) {
            result["fix"]["replacement"] = diagnostic.fix->replacement;
            result["fix"]["text"] = diagnostic.fix->text;
        }
    }
    return result;
}

// ---- SARIF

/// A path as a URI reference [RFC3986]: everything but unreserved characters and `/` is escaped.
std::string uri(std::string_view path)
{
    std::string result = path.starts_with('/') ? "file://" : "";
    for (const char c : path) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9') || c == '/' || c == '-' || c == '.' || c == '_' ||
                           c == '~';
        if (plain)
            result += c;
        else
            result += fmt::format("%{:02X}", static_cast<unsigned>(static_cast<unsigned char>(c)));
    }
    return result;
}

Json region(const Source& source, const Span& span)
{
    const Position begin = source.position(span.begin);
    const Position end = source.position(span.end);
    return {{"startLine", begin.line},
            {"startColumn", begin.column},
            {"endLine", end.line},
            {"endColumn", end.column}};
}

Json location(const Sources& sources, const Label& label, bool with_text)
{
    const Source& source = sources[label.span.source];
    Json result{{"physicalLocation",
                 {{"artifactLocation", {{"uri", uri(source.path())}}},
                  {"region", region(source, label.span)}}}};
    if (with_text && !label.text.empty()) result["message"] = {{"text", label.text}};
    return result;
}

/// SARIF has one text per result: the message, what is seen there, and what follows from it.
std::string full_text(const Diagnostic& diagnostic)
{
    std::string result = diagnostic.message;
    if (!diagnostic.primary.text.empty()) result += ": " + diagnostic.primary.text;
    for (const std::string& note : diagnostic.notes) result += "\nnote: " + note;
    for (const std::string& help : diagnostic.helps) result += "\nhelp: " + help;
    return result;
}

Json result(const Sources& sources, const Diagnostic& diagnostic)
{
    Json json{{"ruleId", id(diagnostic.code)},
              {"ruleIndex", static_cast<int>(diagnostic.code)},
              {"level", level(diagnostic.code)},
              {"message", {{"text", full_text(diagnostic)}}}};
    json["locations"] = Json::array();
    if (has_place(sources, diagnostic.primary.span))
        json["locations"].push_back(location(sources, diagnostic.primary, false));

    Json related = Json::array();
    for (const Label& label : diagnostic.secondary)
        if (has_place(sources, label.span)) related.push_back(location(sources, label, true));
    if (!related.empty()) json["relatedLocations"] = std::move(related);

    if (diagnostic.fix && has_place(sources, diagnostic.fix->span)) {
        const Fix& fix = *diagnostic.fix;
        const Source& source = sources[fix.span.source];
        Json replacement{{"deletedRegion", region(source, fix.span)},
                         {"insertedContent", {{"text", fix.replacement}}}};
        Json change{{"artifactLocation", {{"uri", uri(source.path())}}},
                    {"replacements", Json::array({std::move(replacement)})}};
        json["fixes"] = Json::array({Json{{"description", {{"text", fix.text}}},
                                          {"artifactChanges", Json::array({std::move(change)})}}});
    }
    return json;
}

Json rules()
{
    Json result = Json::array();
    for (const Code code : all_codes())
        result.push_back({{"id", id(code)},
                          {"shortDescription", {{"text", summary(code)}}},
                          {"defaultConfiguration", {{"level", level(code)}}}});
    return result;
}

}  // namespace

std::string render_json(const Sources& sources, const Diagnostics& diagnostics)
{
    std::string result;
    for (const Diagnostic& diagnostic : diagnostics.sorted())
        result += dump(object(sources, diagnostic), -1) + "\n";
    return result;
}

std::string render_sarif(const Sources& sources, const Diagnostics& diagnostics,
                         std::string_view version)
{
    Json results = Json::array();
    for (const Diagnostic& diagnostic : diagnostics.sorted())
        results.push_back(result(sources, diagnostic));

    Json run{{"tool", {{"driver", {{"name", "lobec"}, {"version", version}, {"rules", rules()}}}}},
             {"columnKind", "unicodeCodePoints"},
             {"results", std::move(results)}};
    const Json log{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                   {"version", "2.1.0"},
                   {"runs", Json::array({std::move(run)})}};
    return dump(log, 2) + "\n";
}

}  // namespace lobe
