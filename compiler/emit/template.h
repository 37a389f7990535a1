// Templates: the shape of a generated file, apart from what fills it.
//
//   ${name}                    a value; alone on its line it indents every line of its value,
//                              and a value without text leaves no line behind
//   //% for x in xs … //% end  once per record of a list; ${x.field}, //% for y in x.ys
//   //% # remark               nothing
//
// A directive is a comment line, so editors show the template as the language it writes, and it
// leaves no line behind. There are no conditions (an empty list is one), expressions or escapes.
// Strict both ways: a name the template does not get and a value it does not use are errors (the
// second one unless asked otherwise).
#pragma once

#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lobe::emit {

/// A handful of values by name, in the order in which they were added.
template <class Value>
class Fields {
public:
    struct Field {
        std::string name;
        Value value;
    };

    Fields() = default;
    Fields(std::initializer_list<Field> fields) : fields_(fields) {}

    const Value* find(std::string_view name) const
    {
        for (const Field& field : fields_)
            if (field.name == name) return &field.value;
        return nullptr;
    }
    /// The value of a name that is there.
    const Value& at(std::string_view name) const { return *find(name); }
    /// The value of this name, added empty if it was not there.
    Value& operator[](std::string_view name)
    {
        for (Field& field : fields_)
            if (field.name == name) return field.value;
        return fields_.emplace_back(Field{std::string{name}, {}}).value;
    }

    auto begin() const { return fields_.begin(); }
    auto end() const { return fields_.end(); }

private:
    std::vector<Field> fields_;
};

/// Values by name. As the element of a list, `tag` names the lines it fills (see `Mark`).
struct Record {
    Fields<std::string> texts;
    Fields<std::vector<Record>> lists;
    int tag = -1;
};

/// Lines first .. last (from 1) came from the record with this tag. Inner records come first.
struct Mark {
    int tag = -1;
    int first = 0;
    int last = 0;
};

struct Rendered {
    std::string text;
    std::vector<Mark> marks;
    std::string error;  ///< `file:line: what is wrong`; empty on success
};

/// What a value that the text does not ask for is.
enum class Unused {
    an_error,
    fine  ///< many texts share the values
};

/// `name` is only for messages.
Rendered render(std::string_view name, std::string_view text, const Record& values,
                Unused unused = Unused::an_error);

/// The text of templates/`path`, as it was when the compiler was built; nothing if there is none.
std::optional<std::string_view> embedded_template(std::string_view path);

/// An embedded template, rendered. One that does not fit its values is a bug: aborts with the
/// error.
Rendered render_embedded(std::string_view path, const Record& values);

}  // namespace lobe::emit
