// The functions of a module in one language, as records for a template: what every generated
// file and every harness has in common.
#pragma once

#include "emit/template.h"
#include "emit/write.h"

namespace lobe::emit {

class Listing {
public:
    /// Names everything in `functions` (callees first) and reserves `taken`. `prefix` goes before
    /// every function but the outputs of models.
    Listing(const ir::Module& module, const Sources& sources, const Dialect& dialect,
            std::vector<ir::FunctionId> functions, std::string prefix,
            const std::vector<std::string>& taken = {});

    /// One per function: comment (lines of `text`), signature, statements (lines of `text`).
    std::vector<Record> functions();
    /// One per helper that anything written so far calls: `text`. Ask last.
    std::vector<Record> helpers();

    /// A scope for text of one's own among these functions.
    Scope scope() const;
    /// Statements as records, and helpers noted.
    std::vector<Record> statements(const std::vector<Statement>& statements);
    Body write(Scope& scope, const ir::Graph& graph, const std::vector<ir::ExprId>& roots);

    /// A file-level name, taken from now on.
    std::string unique(std::string_view name) { return file_.unique(name); }
    const std::string& name_of(ir::FunctionId id) const { return names_[id.index]; }
    /// `models/callisto.lobe:61`, never an absolute path.
    std::string cite(const Span& span) const;
    /// Documentation as comment lines: prose, then citations, each with its source's text.
    std::vector<std::string> documentation(const std::string& doc,
                                           const std::vector<ir::Citation>& citations,
                                           const Span& place) const;
    /// A tag for lines written for this place.
    int tag(const Span& span);
    /// Rendered marks as places: without overlaps, innermost first served, in order of lines.
    std::vector<LineOrigin> origins(const std::vector<Mark>& marks) const;

private:
    Record function(const ir::Function& function, const std::string& name);
    std::vector<Record> comment(const ir::Function& function,
                                const std::vector<std::string>& inputs) const;
    std::string citation(const ir::Citation& citation, const Span& place) const;

    const ir::Module& module_;
    const Sources& sources_;
    const Dialect& dialect_;
    std::vector<ir::FunctionId> functions_;
    std::string prefix_;
    Namer file_;
    std::vector<std::string> names_;  ///< per Module::functions
    Helpers helpers_;
    std::vector<Span> tags_;
};

/// Lines of text as records of `text`.
std::vector<Record> lines(const std::vector<std::string>& texts);

/// `[0, 1]`, `[0, inf)`; empty when nothing is known.
std::string range_text(const ir::Range& range);

/// What the names of a model's types and functions start with, given its own and its module's:
/// `callisto`, or `ue4_default_lit` where one file's names must not meet another's.
std::string model_stem(std::string_view module, const std::string& name, const Dialect& dialect);
inline std::string model_stem(const ir::Module& module, const std::string& name,
                              const Dialect& dialect)
{
    return model_stem(module.name, name, dialect);
}

/// A path that is the same everywhere: as given, but only the file name of an absolute one.
std::string shown_path(std::string_view path);

}  // namespace lobe::emit
