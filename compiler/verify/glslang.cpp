// glslang as a judge of GLSL, ESSL and HLSL.
//
// Text in; messages with their lines and, for Vulkan, SPIR-V out. `nan-clamp` is always on: min,
// max and clamp become NMin, NMax and NClamp, whose result with a NaN operand is specified.
// glslang's own use of the optimizer is always off, so that the SPIR-V holds the operations in
// the order the text has them.
#include "verify/judge.h"

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <memory>
#include <optional>
#include <set>
#include <utility>

namespace lobe::verify {
namespace {

/// glslang wants one initialization per process; threads may compile at the same time after it.
void initialize_once()
{
    struct Process {
        Process() { glslang::InitializeProcess(); }
        ~Process() { glslang::FinalizeProcess(); }
    };
    static const Process process;
}

bool starts_with_digit(std::string_view text)
{
    return !text.empty() && text.front() >= '0' && text.front() <= '9';
}

/// The line of `ERROR: 0:12: ...`, `WARNING: 0:12: ...` and the HLSL parser's
/// `(12): error at column 5, ...`. 0 when the message names none.
int line_of(std::string_view message)
{
    if (message.starts_with('(')) {
        message.remove_prefix(1);
    } else {
        // The line stands between the second and third colon, after the string's number.
        const std::size_t severity = message.find(": ");
        if (severity == std::string_view::npos) return 0;
        message.remove_prefix(severity + 2);
        if (!starts_with_digit(message)) return 0;
        const std::size_t string_number = message.find(':');
        if (string_number == std::string_view::npos) return 0;
        message.remove_prefix(string_number + 1);
    }
    int line = 0;
    const auto [end, error] =
        std::from_chars(message.data(), message.data() + message.size(), line);
    return error == std::errc{} ? line : 0;
}

/// What the messages of the front ends, of the linker and of the SPIR-V generator begin with.
bool starts_message(std::string_view line)
{
    for (const std::string_view severity :
         {"ERROR: ", "WARNING: ", "NOTE: ", "INTERNAL ERROR", "UNIMPLEMENTED",
          "error: ", "warning: ", "Missing functionality: ", "TBD functionality: "})
        if (line.starts_with(severity)) return true;
    return line.starts_with('(') && starts_with_digit(line.substr(1));
}

/// What ends a log says nothing that the messages before it do not.
bool is_summary(std::string_view line)
{
    return line.starts_with("ERROR: ") && (line.find("compilation errors.") != line.npos ||
                                           line.ends_with(": '' : compilation terminated"));
}

/// Splits a log into messages; a line that starts none continues the one before it.
void append_log(std::string_view log, std::vector<Message>& messages)
{
    while (!log.empty()) {
        const std::size_t end = log.find('\n');
        std::string_view line = log.substr(0, end);
        log.remove_prefix(end == std::string_view::npos ? log.size() : end + 1);
        while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back())))
            line.remove_suffix(1);
        if (line.empty() || is_summary(line)) continue;
        if (starts_message(line) || messages.empty())
            messages.push_back({line_of(line), std::string{line}});
        else
            messages.back().text.append("\n").append(line);
    }
}

bool is_warning(const Message& message)
{
    return message.text.starts_with("WARNING: ") || message.text.starts_with("NOTE: ") ||
           message.text.starts_with("warning: ");
}

/// The HLSL parser never recovers: what follows its first error is about the wreckage.
void keep_first_error(std::vector<Message>& messages)
{
    bool seen = false;
    std::erase_if(messages, [&seen](const Message& message) {
        if (is_warning(message)) return false;
        return std::exchange(seen, true);
    });
}

EShLanguage stage_of(Stage stage)
{
    return stage == Stage::compute ? EShLangCompute : EShLangFragment;
}

enum class Rules {
    vulkan,
    opengl
};

/// What the first line of code of a GLSL or ESSL text says it is.
struct Version {
    int number = 0;
    bool is_essl = false;
};

std::string_view without_blanks(std::string_view text)
{
    const std::size_t start = text.find_first_not_of(" \t\r\n");
    return start == text.npos ? std::string_view{} : text.substr(start);
}

std::string_view without_comments(std::string_view text)
{
    for (text = without_blanks(text);; text = without_blanks(text)) {
        const bool is_line = text.starts_with("//");
        if (!is_line && !text.starts_with("/*")) return text;
        const std::size_t end = is_line ? text.find('\n', 2) : text.find("*/", 2);
        text.remove_prefix(end == text.npos ? text.size() : end + (is_line ? 1 : 2));
    }
}

std::optional<Version> stated_version(std::string_view text)
{
    constexpr std::string_view directive = "#version";
    text = without_comments(text);
    if (!text.starts_with(directive)) return std::nullopt;
    text = text.substr(directive.size());
    text = without_blanks(text.substr(0, text.find('\n')));
    Version version;
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), version.number);
    if (error != std::errc{}) return std::nullopt;
    version.is_essl =
        version.number == 100 ||
        text.substr(static_cast<std::size_t>(end - text.data())).find("es") != text.npos;
    return version;
}

/// glslang takes a text for whatever it says it is, and for something of its own choice if it
/// says nothing. We know what it should be.
std::optional<Message> misstated_version(std::string_view text, Dialect dialect, Stage stage)
{
    if (dialect == Dialect::hlsl) return std::nullopt;
    const auto version = stated_version(text);
    if (!version) return Message{0, "the text does not begin with `#version`"};
    if (version->is_essl != (dialect == Dialect::essl))
        return Message{0, version->is_essl ? "the text says it is ESSL, GLSL was expected"
                                           : "the text says it is GLSL, ESSL was expected"};
    // Asked for a compute shader of a version without profiles, glslang prints its built-ins.
    constexpr int first_with_profiles = 150;
    if (stage == Stage::compute && !version->is_essl && version->number < first_with_profiles)
        return Message{0, "compute shaders need `#version 430` or higher"};
    return std::nullopt;
}

/// Hands glslang the texts it asks for. It knows no `#pragma once`, so a file that has one is
/// empty from the second time on.
class Includer : public glslang::TShader::Includer {
public:
    explicit Includer(const Includes& includes) : includes_(includes) {}

    IncludeResult* includeLocal(const char* name, const char*, std::size_t depth) override
    {
        constexpr std::size_t deepest = 64;  // a file that includes itself would never end
        if (!includes_ || depth > deepest) return nullptr;
        std::optional<std::string> text = includes_(name);
        if (!text) return nullptr;
        if (text->find("#pragma once") != text->npos && !once_.insert(name).second) text->clear();
        const auto& kept = texts_.emplace_back(std::make_unique<std::string>(std::move(*text)));
        results_.push_back(
            std::make_unique<IncludeResult>(name, kept->data(), kept->size(), nullptr));
        return results_.back().get();
    }
    IncludeResult* includeSystem(const char* name, const char* from, std::size_t depth) override
    {
        return includeLocal(name, from, depth);
    }
    void releaseInclude(IncludeResult*) override {}  // all at the end

private:
    const Includes& includes_;
    std::set<std::string> once_;
    std::vector<std::unique_ptr<std::string>> texts_;
    std::vector<std::unique_ptr<IncludeResult>> results_;
};

Verdict judge(std::string_view text, Dialect dialect, Stage stage, std::string_view entry,
              Rules rules, const Includes& includes = {})
{
    initialize_once();
    Verdict verdict;
    if (auto message = misstated_version(text, dialect, stage)) {
        verdict.messages.push_back(std::move(*message));
        return verdict;
    }
    const bool is_hlsl = dialect == Dialect::hlsl;
    const EShLanguage language = stage_of(stage);
    glslang::TShader shader{language};
    const char* const start = text.data();
    const int length = static_cast<int>(text.size());
    shader.setStringsWithLengths(&start, &length, 1);
    const std::string entry_name{entry};
    shader.setNanMinMaxClamp(true);

    unsigned wanted = EShMsgDefault;
    if (is_hlsl) {
        shader.setEntryPoint(entry_name.c_str());
        shader.setAutoMapBindings(true);
        shader.setAutoMapLocations(true);
        wanted |= EShMsgReadHlsl;
    }
    if (rules == Rules::vulkan) {
        constexpr int vulkan_glsl_version = 100;  // the only one of KHR_vulkan_glsl
        shader.setEnvInput(is_hlsl ? glslang::EShSourceHlsl : glslang::EShSourceGlsl, language,
                           glslang::EShClientVulkan, vulkan_glsl_version);
        shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
        shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
        wanted |= EShMsgSpvRules | EShMsgVulkanRules;
    }
    const auto options = static_cast<EShMessages>(wanted);

    constexpr int unstated_version = 100;  // of no use: HLSL has its own, and others state it
    Includer includer{includes};
    bool ok = shader.parse(GetDefaultResources(), unstated_version, false, options, includer);
    append_log(shader.getInfoLog(), verdict.messages);

    // The program must go before the shader, whose memory it uses.
    glslang::TProgram program;
    if (ok) {
        program.addShader(&shader);
        ok = program.link(options) && (!is_hlsl || program.mapIO());
        append_log(program.getInfoLog(), verdict.messages);
    }
    if (ok && rules == Rules::vulkan) {
        glslang::SpvOptions spv;
        spv.disableOptimizer = true;
        spv::SpvBuildLogger logger;
        glslang::GlslangToSpv(*program.getIntermediate(language), verdict.spirv, &logger, &spv);
        std::vector<Message> said;
        append_log(logger.getAllMessages(), said);
        // SPIR-V that lacks what the text asks for is not SPIR-V of that text.
        ok = std::ranges::all_of(said, is_warning);
        if (!ok) verdict.spirv.clear();
        verdict.messages.insert(verdict.messages.end(), said.begin(), said.end());
    }
    if (is_hlsl) keep_first_error(verdict.messages);
    verdict.accepted = ok;
    return verdict;
}

}  // namespace

Verdict compile(std::string_view text, Dialect dialect, Stage stage, std::string_view entry,
                const Includes& includes)
{
    return judge(text, dialect, stage, entry, Rules::vulkan, includes);
}

Verdict parse_only(std::string_view text, Dialect dialect, Stage stage)
{
    return judge(text, dialect, stage, "main", Rules::opengl);
}

}  // namespace lobe::verify
