// The inputs of an entry point as columns of numbers: where its vectors and its values are.
#pragma once

#include "analyze/directions.h"
#include "analyze/scalar.h"
#include "ir/module.h"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::analyze {

class EntryInputs {
public:
    /// One number per column.
    using Values = std::vector<double>;

    /// An input that is no direction.
    struct Value {
        std::size_t first = 0;  ///< column of its first component
        std::size_t size = 0;
        std::string name;
        bool parameter = false;
        std::uint32_t which = 0;  ///< of a parameter
    };

    EntryInputs(const ir::Module& module, ir::FunctionId function, const Grid& grid);

    const ir::Function& entry() const { return entry_; }
    std::size_t columns() const { return names_.size(); }
    const std::vector<std::string>& names() const { return names_; }  ///< of the columns: `l.x`
    const std::vector<Scalar>& scalars() const { return scalars_; }   ///< of the columns
    const std::vector<Value>& values() const { return values_; }
    bool has_geometry() const { return geometry_; }
    bool has_tangents() const { return tangents_; }

    const Value* find(std::string_view name) const;
    /// The first column of a vector of the geometry; nothing if the function takes none.
    std::optional<std::size_t> find(ir::GeometryField vector) const;
    /// What the function reads of the geometry: `cos_i`, `h.x`.
    struct Field {
        std::string name;
        ir::ExprId value;  ///< an expression of the entry point
        std::size_t component = 0;
    };
    const std::vector<Field>& fields() const { return fields_; }

    /// Every value neutral; directions along the normal.
    Values neutral() const;
    /// Puts the vectors into their columns. Arguments that are directions of their own get l.
    void place(Values& values, const Directional& at) const;
    /// Sets every component of a value.
    static void set(Values& values, const Value& which, double to);

    /// `roughness = 0.5, l = (0, 0, 1)`; parameters at their defaults are left out.
    std::string describe(const Values& values) const;

private:
    ir::Function entry_;
    std::vector<std::string> names_;
    std::vector<Scalar> scalars_;
    std::vector<Value> values_;
    std::vector<Field> fields_;
    bool geometry_ = false;
    bool tangents_ = false;
};

}  // namespace lobe::analyze
