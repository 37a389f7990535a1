// glslang as a judge of GLSL, ESSL and HLSL.
//
// Text in; messages with their lines and, for Vulkan, SPIR-V out. `nan-clamp` is always on: min,
// max and clamp become NMin, NMax and NClamp, whose result with a NaN operand is specified.
// glslang's own use of the optimizer is always off, so that the SPIR-V holds the operations in
// the order the text has them.
#include "verify/judge.h"

#include <glslang/MachineIndependent/localintermediate.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include <cctype>
#include <charconv>
#include <optional>
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

bool starts_message(std::string_view line)
{
    return line.starts_with("ERROR: ") || line.starts_with("WARNING: ") ||
           line.starts_with("INTERNAL ERROR") || line.starts_with("UNIMPLEMENTED") ||
           line.starts_with("NOTE: ") ||
           (line.starts_with('(') && line.size() > 1 && starts_with_digit(line.substr(1)));
}

/// The count that ends a log says nothing that the messages before it do not.
bool is_summary(std::string_view line)
{
    return line.starts_with("ERROR: ") && line.find("compilation errors.") != line.npos;
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
    return message.text.starts_with("WARNING: ") || message.text.starts_with("NOTE: ");
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

/// A text without `#version`, or with that of the other language, is accepted by glslang as
/// whatever it says it is. We know what it should be.
std::optional<Message> wrong_dialect(const glslang::TIntermediate& intermediate, Dialect dialect)
{
    if (dialect == Dialect::hlsl) return std::nullopt;
    const bool is_essl = intermediate.getProfile() == EEsProfile;
    if (is_essl == (dialect == Dialect::essl)) return std::nullopt;
    return Message{1, is_essl ? "the text says it is ESSL, GLSL was expected"
                              : "the text says it is GLSL, ESSL was expected"};
}

Verdict judge(std::string_view text, Dialect dialect, Stage stage, std::string_view entry,
              Rules rules)
{
    initialize_once();
    Verdict verdict;
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

    // Versions that the language has when a text states none.
    const int unstated = dialect == Dialect::essl ? 100 : is_hlsl ? 500 : 110;
    bool ok = shader.parse(GetDefaultResources(), unstated, false, options);
    append_log(shader.getInfoLog(), verdict.messages);

    // The program must go before the shader, whose memory it uses.
    glslang::TProgram program;
    if (ok) {
        program.addShader(&shader);
        ok = program.link(options) && (!is_hlsl || program.mapIO());
        append_log(program.getInfoLog(), verdict.messages);
    }
    if (ok) {
        const glslang::TIntermediate& intermediate = *program.getIntermediate(language);
        if (auto message = wrong_dialect(intermediate, dialect)) {
            verdict.messages.push_back(std::move(*message));
            ok = false;
        } else if (rules == Rules::vulkan) {
            glslang::SpvOptions spv;
            spv.disableOptimizer = true;
            spv::SpvBuildLogger logger;
            glslang::GlslangToSpv(intermediate, verdict.spirv, &logger, &spv);
            append_log(logger.getAllMessages(), verdict.messages);
        }
    }
    if (is_hlsl) keep_first_error(verdict.messages);
    verdict.accepted = ok;
    return verdict;
}

}  // namespace

Verdict compile(std::string_view text, Dialect dialect, Stage stage, std::string_view entry)
{
    return judge(text, dialect, stage, entry, Rules::vulkan);
}

Verdict parse_only(std::string_view text, Dialect dialect, Stage stage)
{
    return judge(text, dialect, stage, "main", Rules::opengl);
}

}  // namespace lobe::verify
