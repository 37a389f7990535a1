// What the tests of this folder share: small functions by hand, and runs without the columns.
#pragma once

#include "evaluate/run.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace lobe::tests {

ir::Input number_input(std::string name, double low, double high);
ir::Input color_input(std::string name);

/// A module of one function `f` of `arity` numbers x0, x1, ... that applies one operation.
ir::Module module_of(ir::Op op, int arity);

/// A function of a module over points; `points[p][i]` is scalar input i of point p, and
/// `result[p][k]` is output k.
template <class Number>
using Table = std::vector<std::vector<Number>>;

Table<float> evaluate_float(const evaluate::Tape& tape, const Table<float>& points);
Table<double> evaluate_double(const evaluate::Tape& tape, const Table<double>& points);
Table<float> evaluate_half(const evaluate::Tape& tape, evaluate::HalfMode mode,
                           const Table<float>& points);
Table<evaluate::Interval> evaluate_interval(const evaluate::Tape& tape,
                                            const Table<evaluate::Interval>& points);
Table<evaluate::Acceptance> evaluate_acceptance(const evaluate::Tape& tape,
                                                evaluate::Precision precision,
                                                const Table<float>& points);
Table<evaluate::Real> evaluate_real(const evaluate::Tape& tape, int bits,
                                    const Table<double>& points);

/// One operation on one point.
double apply_double(ir::Op op, std::initializer_list<double> operands);
float apply_float(ir::Op op, std::initializer_list<float> operands);
float apply_half(ir::Op op, evaluate::HalfMode mode, std::initializer_list<float> operands);
evaluate::Interval apply_interval(ir::Op op, std::initializer_list<evaluate::Interval> operands);
evaluate::Acceptance apply_acceptance(ir::Op op, std::initializer_list<float> operands,
                                      evaluate::Precision precision = evaluate::Precision::float32);

}  // namespace lobe::tests
