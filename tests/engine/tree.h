// Trees in memory, and a small list of edits for them: the shape of an engine, none of its text.
#pragma once

#include "engine/patch.h"

#include <map>
#include <string>
#include <string_view>

namespace lobe::engine {

using Files = std::map<std::string, std::string>;

Tree tree_of(const Files& files);
Files applied(Files files, const Plan& plan);

/// Parsed; the test fails if it cannot be.
EditList list_of(std::string_view text);

Request request_of(std::string model);

/// Every LF becomes CRLF.
Files with_crlf(const Files& files);

/// What stands in the way, a line each: `file:line: edit: what`.
std::string shown(const std::vector<Obstacle>& obstacles);

/// Two shaders, a header and a source that know two shading models.
const Files& small_tree();
const EditList& small_list();

}  // namespace lobe::engine
