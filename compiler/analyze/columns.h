// Which column of a table feeds which input of a function: the binding, before any row is read.
#pragma once

#include "analyze/table.h"
#include "evaluate/tape.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lobe::analyze {

/// Where one scalar input of the tape gets its value from.
struct Feed {
    std::size_t column = 0;  ///< of the table; used when `text` is empty
    std::string text;        ///< else the value for every row, as a decimal
};

struct Binding {
    evaluate::Tape tape;
    std::vector<Feed> feeds;            ///< one per tape input
    std::vector<std::string> warnings;  ///< in the order of the columns
    std::optional<TableError> error;    ///< then the rest means nothing
};

/// Binds the columns of a table with these names to a function, as table.h describes.
Binding bind_columns(const ir::Module& module, ir::FunctionId function,
                     std::span<const std::string> header);

}  // namespace lobe::analyze
