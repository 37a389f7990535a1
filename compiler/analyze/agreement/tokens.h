// Shader text as tokens: enough to change it in one place, and no more.
//
// Reads GLSL and HLSL alike: names, numbers and symbols, with the space and comments between them
// left out. Token ranges are bytes of the text.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace lobe::analyze {

struct Token {
    enum class Kind {
        name,
        number,
        symbol
    };

    Kind kind{};
    std::size_t begin = 0;
    std::size_t end = 0;
    int line = 1;
    std::string_view text;  ///< into the text that was read
};

/// The tokens of a shader. Comments, space and preprocessor lines are no tokens.
std::vector<Token> tokenize(std::string_view text);

/// The index of the bracket that closes the one at `open`; `tokens.size()` if none does.
std::size_t closing(const std::vector<Token>& tokens, std::size_t open);

/// Half-open ranges of token indices: what lies between the brackets at `open` and its closing
/// one, split at commas that are in no deeper bracket. Empty for `()`.
struct TokenRange {
    std::size_t first = 0;
    std::size_t last = 0;
};
std::vector<TokenRange> arguments(const std::vector<Token>& tokens, std::size_t open);

}  // namespace lobe::analyze
