// One function as it ships and as it is meant: the emitted shader on the device (or the float
// evaluator, where there is none) and the definition in double, over the same points.
#pragma once

#include "analyze/entry_inputs.h"
#include "device/device.h"
#include "emit/emit.h"
#include "evaluate/tape.h"
#include "ir/module.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lobe::analyze {

/// Results at many points: one column per component.
using ResultColumns = std::vector<std::vector<double>>;

class EmittedFunction {
public:
    /// A batch of points in double, column by column.
    class Batch {
    public:
        explicit Batch(std::size_t columns) : columns_(columns) {}
        void add(const EntryInputs::Values& values)
        {
            for (std::size_t i = 0; i < columns_.size(); ++i) columns_[i].push_back(values[i]);
            ++size_;
        }
        std::size_t size() const { return size_; }
        const std::vector<std::vector<double>>& columns() const { return columns_; }
        EntryInputs::Values point(std::size_t index) const;

    private:
        std::vector<std::vector<double>> columns_;
        std::size_t size_ = 0;
    };

    /// `device` may be null; it and the others outlive this.
    EmittedFunction(const ir::Module& module, const Sources& sources, ir::FunctionId function,
                    device::Device* device);

    const EntryInputs& inputs() const { return inputs_; }
    const std::string& name() const { return inputs_.entry().name; }
    std::size_t components() const { return tape_.outputs.size(); }

    /// What results depend on, for a store: the emitted text, the definition, the device, and the
    /// ranges that points are chosen by.
    std::string key() const;

    /// What was emitted, at the points rounded to float. Why it could not run, or empty.
    std::string emitted(const Batch& batch, ResultColumns& results);
    /// The definition in double, at the points as they are.
    ResultColumns exact(const Batch& batch) const;
    /// The definition in double, at the points rounded to float.
    ResultColumns exact_at_floats(const Batch& batch) const;
    /// How far from exact a conforming device may be at the points rounded to float; infinite
    /// where the contract lets it be anything.
    ResultColumns allowed(const Batch& batch) const;

private:
    ResultColumns run(const std::vector<std::vector<double>>& columns, std::size_t count) const;

    EntryInputs inputs_;
    evaluate::Tape tape_;
    device::Device* device_;
    emit::Harness harness_;
    std::vector<std::uint32_t> spirv_;  ///< made when first asked for
};

}  // namespace lobe::analyze
