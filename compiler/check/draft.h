// A function while its body is lowered: inputs in the order of discovery, obligations open.
#pragma once

#include "check/obligations.h"
#include "check/program.h"

namespace lobe::check {

class Draft {
public:
    ir::Function function;  ///< inputs are final in content, not in order
    std::vector<Obligation> obligations;
    std::vector<NamedLimit> limits;

    /// Declared arguments come first, used or not; `position` is where in the list they stand.
    ir::ExprId add_argument(const Argument& argument, std::size_t position);
    /// Where the structures stand in the argument list: their fields take that place.
    void set_structure_position(Structure structure, std::size_t position);

    ir::ExprId geometry(ir::GeometryField field, const Span& span);
    ir::ExprId surface(ir::SurfaceField field, const Span& span);
    ir::ExprId emitter(ir::EmitterField field, const Span& span);
    ir::ExprId parameter(const ir::Parameter& parameter, std::uint32_t index, const Span& span);

    /// The function with its inputs in their final order and nothing that the result does not
    /// need: arguments as declared, a structure replaced by its used fields, then parameters.
    ir::Function finish() const;

private:
    struct Key {
        std::size_t position = 0;
        std::uint32_t which = 0;
        friend auto operator<=>(const Key&, const Key&) = default;
    };

    ir::ExprId input(ir::Input input, Key key, const Span& span);
    ir::ExprId field(ir::Origin origin, std::uint32_t which, Key key, const Span& span);

    std::vector<Key> keys_;  ///< per input
    bool takes_geometry_ = false;
    Key geometry_{};  ///< where fields stand whose `which` is 0
    Key surface_{};
    Key emitter_{};
};

}  // namespace lobe::check
