#include "syntax/tree.h"

namespace lobe::syntax {

std::string doc_text(const std::vector<Comment>& comments)
{
    std::string result;
    for (const Comment& comment : comments) {
        if (!comment.doc) continue;
        if (!result.empty()) result += '\n';
        result += comment.text;
    }
    return result;
}

}  // namespace lobe::syntax
