// All files of one check, and what they declare: the tables between trees and module.
//
// `modules.cpp` fills `files`, `names.cpp` the scopes and signatures, `order.cpp` decides what is
// lowered and when, `functions.cpp` lowers into `functions`.
#pragma once

#include "base/diagnostic.h"
#include "check/types.h"
#include "syntax/tree.h"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lobe::check {

/// A type as written in a declaration.
struct DeclaredType {
    ValueType type;
    ir::Range range{};     ///< of every component; infinite where nothing bounds it
    bool bounded = false;  ///< the clause itself says the range, by `in` or by a name like `unit`
    Span span;
};

struct Argument {
    std::string name;
    Span span;  ///< of the name
    DeclaredType type;
    bool broken = false;  ///< its type was reported; whatever uses it stays silent
};

/// What a caller of a term needs to know. Shared by the term and its forms.
struct Signature {
    std::vector<Argument> arguments;
    std::optional<DeclaredType> result;
    bool broken = false;  ///< something about it was reported; callers stay silent
};

/// Something with a body that can be called: a term, or a form of one.
struct Callable {
    std::string name;
    Span span;  ///< of its name
    std::size_t file = 0;
    const syntax::Item* item = nullptr;
    const syntax::TermItem* term = nullptr;
    const syntax::Form* form = nullptr;  ///< null for the term itself
    std::size_t term_index = 0;          ///< for a form: its term among the callables
    Signature signature;
    std::optional<ir::FunctionId> function;  ///< once lowered without errors
};

/// A `model` or `light` of a file.
struct ModelDeclaration {
    std::size_t file = 0;
    const syntax::Item* item = nullptr;
    const syntax::ModelItem* node = nullptr;
    std::optional<ir::Model> model;  ///< once lowered, with the outputs that had no errors
    bool broken = false;             ///< something about it was reported
};

/// A `gbuffer` of a file.
struct GbufferDeclaration {
    std::size_t file = 0;
    const syntax::Item* item = nullptr;
    const syntax::GbufferItem* node = nullptr;
    std::optional<ir::Gbuffer> gbuffer;  ///< once its conditions are decided, if it had no errors
};

/// A `code` of a file: two functions.
struct CodeDeclaration {
    std::size_t file = 0;
    const syntax::Item* item = nullptr;
    const syntax::CodeItem* node = nullptr;
    std::optional<ir::FunctionId> encode;  ///< once lowered without errors
    std::optional<ir::FunctionId> decode;
};

enum class NameKind {
    callable,
    parameter,
    model,
    light,
    output,
    gbuffer,
    code,
    lost
};

/// What a name stands for in one file. `lost` names come from an import that failed; whatever
/// uses them stays silent.
struct Declared {
    NameKind kind{};
    std::size_t index = 0;
    Span span;
    bool imported = false;
    bool used = false;
};

using Scope = std::map<std::string, Declared, std::less<>>;

struct File {
    std::string name;  ///< of the module
    std::uint32_t source = 0;
    syntax::Tree tree;
    bool broken = false;  ///< has syntax errors: names may be missing that were written
    std::vector<std::optional<std::size_t>> imports;  ///< per import item, in order
    Scope names;
    std::map<std::string, Span, std::less<>> tiers;
    std::map<std::string, const syntax::SourceItem*, std::less<>> sources;
};

struct Program {
    std::vector<std::unique_ptr<File>> files;  ///< imported ones first, the root last
    std::vector<Callable> callables;
    std::vector<ModelDeclaration> models;
    std::vector<GbufferDeclaration> gbuffers;
    std::vector<CodeDeclaration> codes;
    std::vector<ir::Parameter> parameters;  ///< of all files; pruned at the end
    std::vector<bool> parameter_broken;
    std::vector<ir::Function> functions;  ///< callees first
    std::vector<std::uint64_t> sizes;     ///< of each function, its calls taken in

    File& root() { return *files.back(); }
};

/// What the name of a model or light stands for.
inline NameKind kind_of(const ModelDeclaration& declared)
{
    return declared.node->is_light ? NameKind::light : NameKind::model;
}

/// With its article: "a term", "a model", "a gbuffer".
std::string_view describe(NameKind kind);
/// The names of one kind in a scope, for suggestions.
std::vector<std::string> names_of(const Scope& scope, NameKind kind);

/// `; did you mean `x`?` when something is near, else nothing.
std::string did_you_mean(std::string_view name, const std::vector<std::string>& candidates);
/// The edit that replaces a misspelt name by a near one.
std::optional<Fix> rename_fix(std::string_view name, const Span& span,
                              const std::vector<std::string>& candidates);

}  // namespace lobe::check
