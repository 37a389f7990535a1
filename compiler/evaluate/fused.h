// Two and three operations at a time: what the float kernels run instead of single ones.
//
// A kernel spends more time on loads and stores than on arithmetic, so sums, differences and
// products that are used once are computed where they are used. Each is still rounded by itself,
// so nothing changes in the result. A constant operand is loaded once per block.
//
//   chain    (a . b) . c   and   ((a . b) . c) . d
//   tree     (a . b) . (c . d)
//   root     sqrt((a . b) . c)
//   select   d ? a . b : constant
//   lerp     lerp(constant, a . b, d)   and   lerp(constant, d, a . b)
#pragma once

#include "evaluate/tape.h"

namespace lobe::evaluate {

constexpr std::size_t tape_op_count = 0
#define LOBE_TAPE_OP(name, arity) +1
#include "evaluate/tape_ops.def"
#undef LOBE_TAPE_OP
    ;

/// The innermost operation, of `a` and `b`. A constant is always `b`.
enum class Pair : std::uint8_t {
    add,
    add_constant,
    subtract,
    subtract_constant,
    constant_subtract,  ///< b - a
    multiply,
    multiply_constant,
};
constexpr std::size_t pair_count = 7;

/// What is done next to the result t so far, with one more operand `o`.
enum class Link : std::uint8_t {
    add,
    add_constant,
    subtract,
    subtract_constant,
    subtract_from,  ///< o - t
    subtract_from_constant,
    multiply,
    multiply_constant,
};
constexpr std::size_t link_count = 8;

/// How the two results of a tree meet.
enum class Join : std::uint8_t {
    add,
    subtract,
    multiply
};
constexpr std::size_t join_count = 3;

/// Index into a table of float kernels: the tape's own operations first.
using FusedOp = std::uint16_t;

constexpr std::size_t power_of_log2 = tape_op_count;                ///< log2 x, y: x^y, total
constexpr std::size_t lerp_from_constant = power_of_log2 + 1;       ///< lerp, `a` constant
constexpr std::size_t select_or_constant = lerp_from_constant + 1;  ///< select, `c` constant
constexpr std::size_t first_select = select_or_constant + 1;        ///< a . b, constant c, if d
constexpr std::size_t first_lerp_to = first_select + pair_count;    ///< constant c, a . b, by d
constexpr std::size_t first_lerp_by = first_lerp_to + pair_count;   ///< constant c, d, by a . b
constexpr std::size_t first_root = first_lerp_by + pair_count;
constexpr std::size_t first_chain2 = first_root + pair_count * link_count;
constexpr std::size_t first_chain3 = first_chain2 + pair_count * link_count;
constexpr std::size_t first_tree = first_chain3 + pair_count * link_count * link_count;
constexpr std::size_t fused_op_count = first_tree + pair_count * pair_count * join_count;

constexpr FusedOp plain(TapeOp op) { return static_cast<FusedOp>(op); }

/// One of a family that starts at `first` and is indexed by its pair.
constexpr FusedOp paired_op(std::size_t first, Pair pair)
{
    return static_cast<FusedOp>(first + static_cast<std::size_t>(pair));
}

constexpr FusedOp root(Pair pair, Link link)
{
    return static_cast<FusedOp>(first_root + static_cast<std::size_t>(pair) * link_count +
                                static_cast<std::size_t>(link));
}

constexpr FusedOp chain(Pair pair, Link link)
{
    return static_cast<FusedOp>(first_chain2 + static_cast<std::size_t>(pair) * link_count +
                                static_cast<std::size_t>(link));
}

constexpr FusedOp chain(Pair pair, Link first, Link second)
{
    return static_cast<FusedOp>(
        first_chain3 +
        (static_cast<std::size_t>(pair) * link_count + static_cast<std::size_t>(first)) *
            link_count +
        static_cast<std::size_t>(second));
}

constexpr FusedOp tree(Pair left, Pair right, Join join)
{
    return static_cast<FusedOp>(
        first_tree +
        (static_cast<std::size_t>(left) * pair_count + static_cast<std::size_t>(right)) *
            join_count +
        static_cast<std::size_t>(join));
}

}  // namespace lobe::evaluate
