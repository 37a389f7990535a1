// Columns as the evaluators take them: pointers to their first numbers.
#pragma once

#include <vector>

namespace lobe::analyze {

template <class Number>
std::vector<const Number*> heads(const std::vector<std::vector<Number>>& columns)
{
    std::vector<const Number*> result;
    for (const auto& column : columns) result.push_back(column.data());
    return result;
}

template <class Number>
std::vector<Number*> heads(std::vector<std::vector<Number>>& columns)
{
    std::vector<Number*> result;
    for (auto& column : columns) result.push_back(column.data());
    return result;
}

}  // namespace lobe::analyze
