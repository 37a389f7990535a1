#include "analyze/corners/fields.h"

#include "analyze/heads.h"

#include <string_view>

namespace lobe::analyze {
namespace {

using evaluate::Acceptance;
using evaluate::Interval;

class Selection {
public:
    Selection(const EntryInputs& inputs, const Points& points, evaluate::Precision precision,
              Inside which)
        : inputs_{inputs}, points_{points}, precision_{precision}, which_{which}
    {
        for (std::size_t i = 0; i < points.size(); ++i) kept_.push_back(i);
    }

    /// Keeps the points whose column lies in the side.
    void keep_column(std::size_t column, const Interval& side)
    {
        std::erase_if(kept_, [&](std::size_t point) {
            const double value = points_.columns[column][point];
            return value < side.low || value > side.high;
        });
    }

    /// Keeps the points at which this expression of the entry point does.
    void keep_field(const EntryInputs::Field& field, const Interval& side)
    {
        ir::Function function = inputs_.entry();
        function.result = field.value;
        // The expressions of a field call nothing.
        const evaluate::Tape tape = evaluate::compile(ir::Module{}, function);
        std::vector<std::vector<Acceptance>> in;
        for (const std::vector<float>& column : points_.columns) {
            in.emplace_back();
            for (const std::size_t point : kept_)
                in.back().push_back({column[point], column[point], false});
        }
        std::vector<std::vector<Acceptance>> out(tape.outputs.size(),
                                                 std::vector<Acceptance>(kept_.size()));
        evaluate::run_acceptance(tape, precision_, evaluate::Columns<Acceptance>{heads(in)},
                                 evaluate::Results<Acceptance>{heads(out)}, kept_.size());
        std::vector<std::size_t> left;
        for (std::size_t i = 0; i < kept_.size(); ++i)
            if (lies(out[field.component][i], side)) left.push_back(kept_[i]);
        kept_ = std::move(left);
    }

    std::vector<bool> flags() const
    {
        std::vector<bool> result(points_.size());
        for (const std::size_t point : kept_) result[point] = true;
        return result;
    }

private:
    bool lies(const Acceptance& value, const Interval& side) const
    {
        if (which_ == Inside::certainly)
            return !value.undefined && value.low >= side.low && value.high <= side.high;
        return value.undefined || (value.low <= side.high && value.high >= side.low);
    }

    const EntryInputs& inputs_;
    const Points& points_;
    evaluate::Precision precision_;
    Inside which_;
    std::vector<std::size_t> kept_;
};

}  // namespace

std::vector<bool> inside(const EntryInputs& inputs, const Points& points,
                         evaluate::Precision precision, const NamedBox& box, Inside which)
{
    Selection selection{inputs, points, precision, which};
    // Fields last: they are what takes time.
    for (const auto& [name, side] : box.sides) {
        const std::string_view stem = std::string_view{name}.substr(0, name.find('.'));
        if (const EntryInputs::Value* const value = inputs.find(stem)) {
            for (std::size_t k = 0; k < value->size; ++k)
                selection.keep_column(value->first + k, side);
            continue;
        }
        // A component of a direction.
        for (std::size_t column = 0; column < inputs.columns(); ++column)
            if (inputs.names()[column] == name) selection.keep_column(column, side);
    }
    for (const auto& [name, side] : box.sides)
        for (const EntryInputs::Field& field : inputs.fields())
            if (field.name == name) selection.keep_field(field, side);
    return selection.flags();
}

}  // namespace lobe::analyze
