// What the codes of one field mean, as expressions: the inside of encode_<field> and
// decode_<field>.
#pragma once

#include "ir/module.h"

#include <string>

namespace lobe::ir {

/// A number as a shader's literal: the shortest decimal that reads back as a float where it is one.
/// So a step has the nine digits that a shader takes, and an end that was written as 0.9 stays 0.9.
std::string literal_text(double value);

/// Builds one function; arithmetic with 0 and 1 is left out.
class Writer {
public:
    Graph graph;
    Span span;

    ExprId number(double value) { return graph.literal(literal_text(value), span); }
    ExprId add(ExprId x, double value)
    {
        if (value == 0) return x;
        return value < 0 ? graph.apply(Op::subtract, {x, number(-value)}, span)
                         : graph.apply(Op::add, {x, number(value)}, span);
    }
    /// value + x
    ExprId from(double value, ExprId x)
    {
        return value == 0 ? x : graph.apply(Op::add, {number(value), x}, span);
    }
    /// value - x
    ExprId below(double value, ExprId x)
    {
        return graph.apply(Op::subtract, {number(value), x}, span);
    }
    ExprId times(ExprId x, double value)
    {
        return value == 1 ? x : graph.apply(Op::multiply, {x, number(value)}, span);
    }
    ExprId multiply(ExprId x, ExprId y) { return graph.apply(Op::multiply, {x, y}, span); }
    ExprId apply(Op op, ExprId x) { return graph.apply(op, {x}, span); }
    ExprId at_least(ExprId x, double low)
    {
        return graph.apply(Op::maximum, {x, number(low)}, span);
    }
    ExprId at_most(ExprId x, double high)
    {
        return graph.apply(Op::minimum, {x, number(high)}, span);
    }
    ExprId clamp(ExprId x, const Range& range)
    {
        if (range == Range{0, 1}) return apply(Op::saturate, x);
        return graph.apply(Op::clamp, {x, number(range.low), number(range.high)}, span);
    }
    /// To the nearest whole number, halves up.
    ExprId rounded(ExprId x) { return apply(Op::floor, add(x, 0.5)); }
    ExprId named(ExprId x, std::string_view name)
    {
        graph.set_name(x, name);
        return x;
    }
};

/// Value to code and back, for one field.
/// The code of a value, whatever the value is.
ExprId encode(Writer& write, const Module& module, const Packing& packing, const Field& field,
              ExprId x);

/// The value of a code, which is a whole number of the field's bits. Never outside of the field's
/// range.
ExprId decode(Writer& write, const Module& module, const Packing& packing, const Field& field,
              ExprId code);

/// The same over the reals, for people: `round(127 * x^(1/8))`, `(code / 127)^8`.
std::string encode_formula(const Field& field);
std::string decode_formula(const Field& field);

/// The largest float that is not above a number.
double float_below(double x);

}  // namespace lobe::ir
