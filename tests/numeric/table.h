// Reference tables in, comparisons out: rows of tests/data held against what a term computes.
#pragma once

#include "ir/module.h"

#include <map>
#include <string>
#include <vector>

namespace lobe::tests {

/// One row of a table: column name to text.
using Row = std::map<std::string, std::string>;

/// Every row of a CSV file in data/.
std::vector<Row> read_table(const std::string& path);

/// Inputs of one evaluation, by the names that `lobec evaluate` takes, as decimals.
using Inputs = std::map<std::string, std::string>;

/// A function's result at every set of inputs, as text, through the evaluation of tables. The
/// result's components follow each other; all sets name the same inputs. `number` is
/// `double`, `mpfr:200`, ….
std::vector<std::vector<std::string>> evaluate(const ir::Module& module,
                                               const std::string& function,
                                               const std::vector<Inputs>& inputs,
                                               const std::string& number);

/// Arithmetic on decimals, exact to 400 bits.
std::string square(const std::string& decimal);
std::string product(const std::string& a, const std::string& b);
std::string quotient(const std::string& a, const std::string& b);
std::string sum(const std::string& a, const std::string& b);

/// |computed - expected|, and that over |expected|; exact to 400 bits whatever the texts hold.
struct Distance {
    double absolute = 0;
    double relative = 0;
};
Distance distance(const std::string& computed, const std::string& expected);

/// A relative bound, an absolute one, or whichever is met.
struct Tolerance {
    double relative = 0;
    double absolute = 0;
};
bool within(const Distance& distance, const Tolerance& tolerance);
/// With enough digits to see how far off it is; Catch prints small doubles as 0.
std::string shown(double value);

}  // namespace lobe::tests
