// A checked module: what a .lobe file means, with everything it imported.
//
// The checker produces it, passes map it to another one, and emit, evaluate and verify read it.
// There is no typed tree in between.
//
// Functions are ordered callees first, so a loop over them never meets an unknown callee, and
// recursion cannot be expressed.
#pragma once

#include "ir/declarations.h"
#include "ir/geometry.h"
#include "ir/graph.h"
#include "ir/packing.h"

#include <optional>
#include <string>
#include <vector>

namespace lobe::ir {

/// Where the value of an input comes from.
enum class Origin : std::uint8_t {
    argument,   ///< declared in the term's own parameter list
    geometry,   ///< a field of the term's `geometry` argument; `which` is a GeometryField
    surface,    ///< a field of the term's `surface` argument; `which` is a SurfaceField
    emitter,    ///< a field of the term's `emitter` argument; `which` is an EmitterField. Its v
                ///< and n are those of a geometry
    parameter,  ///< a `param` of the module; `which` indexes Module::parameters
};

/// One input of a function. A call passes one operand per input of the callee, in order; for
/// every origin but `argument` the operand is the caller's own input of the same origin and
/// `which` (a term has at most one structure of each kind, and cannot make another). Only what
/// lights a model makes a geometry: see shade.h.
struct Input {
    std::string name;  ///< as written, or the field's or parameter's name
    Type type{};
    Quantity quantity{};
    Range range{};
    Origin origin{};
    std::uint32_t which = 0;
    Span span;
    bool complement = false;  ///< one minus the argument that was declared: a pass asked for it
};

/// The input for a field of a structure: its name, type and range as the structure has them.
Input field_input(Origin origin, std::uint32_t which, Span span = {});

/// `/// slides 85`
struct Citation {
    std::string source;   ///< the name it was declared under
    std::string locator;  ///< "85", "eq 33"
};

/// A term, a form of one, one output of a model or light, or what the compiler makes: how something
/// is stored, which is half of a `code` or from `build_functions` (see packing.h), and a model
/// under a light (see shade.h). The last two kinds are no roots of a module.
struct Function {
    enum class Kind : std::uint8_t {
        term,
        form,
        output,
        storage,
        shade
    };

    std::string name;  ///< unique in the module: `D_GGX`, `F_Schlick_spherical_gaussian`,
                       ///< `callisto_diffuse`
    Kind kind{};
    std::string module;  ///< the module that declared it
    std::string doc;     ///< without the citations; may be empty
    std::vector<Citation> citations;
    Span span;  ///< of its name
    std::vector<Input> inputs;
    Graph graph;
    ExprId result;
    Quantity quantity{};                  ///< of the result
    std::optional<Range> declared_range;  ///< `-> float in [0, 2]`, proved by the checker
    Range range{};                        ///< proved: declared, or inferred
    FunctionId form_of;                   ///< for a form: its term
    std::string form_name;                ///< for a form: `spherical_gaussian`
    std::string formula;                  ///< the body as written, on one line, for doc comments

    Type type() const { return graph[result].type; }

    /// The index of the input with this origin, if the function has it.
    std::optional<std::uint32_t> find_input(Origin origin, std::uint32_t which) const;
};

/// `effect "Name" off when condition`: the condition is a function over parameters alone.
struct Effect {
    std::string name;
    FunctionId off_when;    ///< boolean result; kind `term`, not emitted
    std::string condition;  ///< as written
    Span span;
};

/// A model that this module lights: it has or imports both. They may be another module's; their
/// functions are here.
struct Shading {
    Model model;
    Model light;
    FunctionId function;  ///< `shade_callisto_point`, once there is one: see shade.h
};

struct Module {
    std::string name;
    std::string path;  ///< of the file, as the user gave it
    std::string doc;   ///< the comments before `module`
    std::vector<Source> sources;
    std::vector<std::string> tiers;
    std::vector<Parameter> parameters;
    std::vector<Function> functions;  ///< callees first; imported ones included
    std::vector<Effect> effects;
    std::vector<Model> models;      ///< this module's own
    std::vector<Model> lights;      ///< this module's own
    std::vector<Shading> shadings;  ///< every model that it has or imports under every such light
    std::vector<Gbuffer> gbuffers;  ///< its own, and those that its packings and engines name
    std::vector<Packing> packings;  ///< its own
    std::vector<Engine> engines;    ///< its own
    std::vector<std::string> remarks;  ///< how it is compiled, for the banner of what is emitted
    bool bare_geometry = false;        ///< entry points compute fields unguarded (see Frame::bare)

    const Function& operator[](FunctionId id) const { return functions[id.index]; }
    std::optional<FunctionId> find(std::string_view function_name) const;
    /// Declared here rather than imported.
    bool owns(const Function& function) const { return function.module == name; }
    /// What callers of a library may call: the outputs of its models and lights, or, when there is
    /// none, its own terms and forms. Nothing else is emitted unless one of these calls it.
    std::vector<FunctionId> roots() const;
    /// The functions that shade, in order of shadings; before there are any, what they will call.
    /// Emitted in a file of their own.
    std::vector<FunctionId> shading_roots() const;
    /// The functions that pack and unpack (see packing.h), in order of packings. Emitted in a file
    /// of their own; like roots they keep the inputs that they were made with.
    std::vector<FunctionId> packing_roots() const;
    const Gbuffer* find_gbuffer(std::string_view gbuffer_name) const;
    /// `roots` and everything they call, callees first.
    std::vector<FunctionId> reachable(const std::vector<FunctionId>& from) const;
};

/// Everything but the functions, and everything but inputs, graph and result: what a pass starts
/// from that builds them anew.
Module without_functions(const Module& module);
Function without_body(const Function& function);

/// An entry point: takes vectors, calls one function. Its inputs are the callee's, but with l, v
/// and n (and x, y where the tangent frame is needed) in place of the geometry fields; its graph
/// computes the fields from the vectors and ends in the call. It is part of no module and keeps
/// the callee's name, documentation and ranges. `function` may have no geometry; then the entry
/// only forwards.
Function entry_point(const Module& module, FunctionId function);

/// What was promised about a module; asserted after every pass in debug builds. Returns the
/// first broken promise in words, or nothing.
std::optional<std::string> verify(const Module& module);

}  // namespace lobe::ir
