// Codes that a source declares, and what a field's `code` says.
#include "check/checking_layouts.h"

#include <catch2/catch.hpp>

using namespace lobe;
using namespace lobe::tests;

namespace {

std::string code(const std::string& type, const std::string& encode, const std::string& decode)
{
    return "code c(x: " + type + ") {\n  encode = " + encode + "\n  decode(u) = " + decode +
           "\n}\n";
}

/// The only field of a packing of `p`.
struct Field {
    Checked checked;
    std::string errors;

    Field(const std::string& parameter, const std::string& storage, const std::string& more = "")
        : checked(check_layout(more + "/// p\nparam p : " + parameter +
                               "\n/// m\nmodel lit(g: geometry) { out = g.cos_i * " +
                               (parameter.starts_with("bool") ? "(if p then 1 else 0)" : "p") +
                               " }\npacking lit on console {\n  d.r" + storage +
                               "\n  supports lighting == live\n}\n")),
          errors(checked.errors())
    {
    }
    const ir::Code& code() const
    {
        REQUIRE(checked.module);
        return checked.module->packings.at(0).fields.at(0).code;
    }
};

}  // namespace

TEST_CASE("a code is two functions that nobody calls by themselves")
{
    const Checked checked =
        check_text("/// Of a gain.\n" +
                   code("float in [0, 256]", "log2(1 + x) / log2(257)", "2^(u * log2(257)) - 1"));
    const ir::Function& encode = checked.function("c_encode");
    const ir::Function& decode = checked.function("c_decode");
    CHECK(encode.kind == ir::Function::Kind::storage);
    CHECK(encode.doc == "Of a gain.");
    CHECK(encode.formula == "log2(1 + x) / log2(257)");
    CHECK(inputs_of(encode) == "x");
    CHECK(encode.inputs[0].range == ir::Range{0, 256});
    CHECK(encode.range.low >= 0);
    CHECK(encode.range.high <= 1);
    CHECK(inputs_of(decode) == "u");
    CHECK(decode.inputs[0].range == ir::Range{0, 1});
    CHECK(checked.module->roots().empty());
    CHECK(value_at(*checked.module, encode, {256}) == 1);
    CHECK(value_at(*checked.module, decode, {0}) == 0);
}

TEST_CASE("what undoes itself over the reals is accepted, however it is written")
{
    for (const auto& [type, encode, decode] : std::initializer_list<std::array<const char*, 3>>{
             {"unit", "x", "u"},
             {"float in [0, 256]", "x / 256", "256 * u"},
             {"float in [-3, 5]", "(x + 3) / 8", "8 * u - 3"},
             {"float in [0, 256]", "sqrt(x) / 16", "(16 * u)^2"},
             {"float in [0, 256]", "(x / 256)^(1/8)", "256 * u^8"},
             {"float in [0, 7]", "log2(1 + x) / 3", "2^(3 * u) - 1"},
             {"float in [0, 256]", "log(1 + x) / log(257)", "exp(u * log(257)) - 1"},
             {"unit", "1 - sqrt(1 - x)", "1 - (1 - u)^2"},
             {"unit", "if x < 0.5 then x / 2 else 1.5 * x - 0.5",
              "if u < 0.25 then 2 * u else (u + 0.5) / 1.5"},
         }) {
        CAPTURE(encode, decode);
        CHECK(check_text(code(type, encode, decode)).errors().empty());
    }
}

TEST_CASE("what does not undo itself is refused, however little is off")
{
    for (const auto& [type, encode, decode] : std::initializer_list<std::array<const char*, 3>>{
             {"unit", "x", "u^2"},
             {"unit", "0.5 * x", "u"},
             {"float in [0, 256]", "x / 256", "255 * u"},
             {"float in [0, 256]", "log2(1 + x) / 8.01", "2^(u * 8.0055) - 1"},
             {"unit", "max(x, 0.001)", "u"},
             {"unit", "if x > 0.9999 then 0.9999 else x", "u"},
         }) {
        CAPTURE(encode, decode);
        CHECK(check_text(code(type, encode, decode)).errors().find("E0608") != std::string::npos);
    }
    const Checked port = check_text(code("float in [0, 256]", "0.5 * (x / 256) + 0.5", "256 * u"));
    CHECK(only_error(port).find("1 is stored as 0.501953 and read as 128.5") != std::string::npos);
}

TEST_CASE("a code is a rising function of one bounded number into [0, 1]")
{
    CHECK(check_text(code("unit", "1 - x", "1 - u")).errors() == "E0609");
    CHECK(check_text(code("float in [0, 2]", "x", "2 * u")).errors() == "E0607");
    CHECK(check_text(code("float in [0, 2]", "x / 2", "4 * u")).errors() == "E0507");
    CHECK(check_text(code("float", "0.5", "u")).errors() == "E0610");
    CHECK(check_text(code("int in [0, 3]", "x / 3", "3 * u")).errors() == "E0610");
    CHECK(check_text(code("color", "0.5", "u")).errors() == "E0610");
    CHECK(check_text(code("geometry", "0.5", "u")).errors() == "E0610");
    CHECK(check_text("/// p\nparam p : float in [1, 2] = 1\n" + code("unit", "x / p", "u"))
              .errors() == "E0610");
    CHECK(check_text(code("unit", "y", "u")).errors() == "E0301");
    // The divisor is proved like any other.
    CHECK(check_text(code("unit", "0.5 / x", "u")).errors().find("E0501") != std::string::npos);
    // Terms may be called; those that read parameters carry them along.
    CHECK(check_text("/// t\nterm t(x: unit) -> unit = x * x\n" + code("unit", "sqrt(x)", "t(u)"))
              .errors()
              .empty());
    CHECK(check_text("/// p\nparam p : unit = 1\n/// t\nterm t(x: unit) -> unit = p * x\n" +
                     code("unit", "x", "t(u)"))
              .errors() == "E0610");
}

TEST_CASE("the functions of a code have names like any other")
{
    CHECK(check_text("/// t\nterm c_encode(x: unit) = x\n" + code("unit", "x", "u")).errors() ==
          "E0302");
    CHECK(check_text("code power(x: unit) {\n  encode = x\n  decode(u) = u\n}\n").errors() ==
          "E0310");
    // One that an import brings along.
    const std::map<std::string, std::string> other{
        {"other", "module other\n/// t\nterm c_decode(x: unit) = x\n/// u\nterm user(x: unit) = "
                  "c_decode(x)\n"}};
    CHECK(check_text("import other { user }\n/// v\nterm v(x: unit) = user(x)\n" +
                         code("unit", "x", "u"),
                     other)
              .errors() == "E0302");
}

TEST_CASE("a field's code is read as it is written")
{
    const auto described = [](const std::string& parameter, const std::string& storage) {
        const Field field{parameter, storage};
        CAPTURE(parameter, storage, field.errors);
        return ir::describe(field.code(), field.checked.module->packings[0].fields[0].bits);
    };
    const std::string gain = "float in [0, 256] = 1";
    CHECK(described("unit = 0", " = p : unorm 8") == "linear");
    CHECK(described("unit = 0", " = p : unorm 8 code linear") == "linear");
    CHECK(described("unit = 0", " = p : unorm 8 code linear(1)") == "linear");
    CHECK(described("unit = 0", " = p : unorm 8 code linear(255/255)") == "linear");
    CHECK(described("unit = 0.75", "[4..7] = p : unorm 4 code linear(12/15)") == "linear(12/15)");
    CHECK(described("unit = 0", " = p : unorm 8 code sqrt") == "sqrt");
    CHECK(described(gain, " = p : unorm 8 code power(8, 127/255)") == "power(8, 127/255)");
    CHECK(described(gain, " = p : unorm 8 code power(4 * 2, 127/255)") == "power(8, 127/255)");
    CHECK(described("float in [0, 256] = 0", " = p : unorm 8 code log2") == "log2");
    CHECK(described(gain, " = p : unorm 8 code log2(31/255)") == "log2(31/255)");
    CHECK(described("unit = 0.75", " = p : unorm 8 in [0, 0.9] code halving(120/255)") ==
          "halving(120/255)");
    // What is whole is stored as it is.
    CHECK(described("int in [0, 3] = 1", "[0..3] = p : unorm 4") == "linear(3/15)");
    CHECK(described("bool = true", "[0..1] = p : unorm 2") == "linear(1/3)");
    CHECK(described("bool = true", "[0] = p : unorm 1") == "linear");
}

TEST_CASE("powers and halvings have the default at their pivot")
{
    const Field low{"float in [0, 4] = 0", " = p : unorm 8 code power(2, 127/255)"};
    CHECK(low.code().unit == 1);
    const Field inside{"float in [0, 4] = 1.5", " = p : unorm 8 code power(2, 127/255)"};
    CHECK(inside.code().unit == 1.5);
    const Field above{"float in [0.5, 4] = 1.5", " = p : unorm 8 code power(2, 96/255)"};
    CHECK(above.code().unit == 1);
    const Field halved{"float in [-1, 1] = 0",
                       " = p : unorm 8 in [-1, 0.875] code halving(63/255)"};
    CHECK(halved.code().top == 1);
    CHECK(halved.code().at_pivot == 0);
}

TEST_CASE("each component of a color has its own pivot")
{
    const auto check = [](const std::string& fields) {
        return check_layout("/// p\nparam p : color = (0.25, 0.5, 0.75)\n"
                            "/// m\nmodel lit(g: geometry) { out = g.cos_i * p }\n"
                            "packing lit on console {\n" +
                            fields + "  supports lighting == live\n}\n");
    };
    const auto units = [](const Checked& checked) {
        CHECK(checked.errors().empty());
        REQUIRE(checked.module);
        std::vector<double> found;
        for (const ir::Field& field : checked.module->packings.at(0).fields)
            found.push_back(field.code.kind == ir::Code::Kind::halving ? field.code.at_pivot
                                                                       : field.code.unit);
        return found;
    };
    CHECK(units(check("  d.rgb = p : unorm 8 code power(3, 120/255)\n")) ==
          std::vector<double>{0.25, 0.5, 0.75});
    CHECK(units(check("  d.r = p.b : unorm 8 code power(3, 120/255)\n"
                      "  d.g = p.g : unorm 8 in [0, 0.875] code halving(80/255)\n"
                      "  d.b = p.r : unorm 8 code power(3, 120/255)\n")) ==
          std::vector<double>{0.75, 0.5, 0.25});
    // One of them is not carried.
    CHECK(check("  d.rgb = p : unorm 8 in [0, 0.7] code halving(30/255)\n").errors() == "E0610");
}

TEST_CASE("a halving needs an end that it does not reach, and a default on the way")
{
    const auto said = [](const std::string& parameter, const std::string& storage) {
        return only_error(Field{parameter, storage}.checked);
    };
    const auto contains = [](const std::string& text, std::string_view part) {
        CAPTURE(text);
        CHECK(text.find(part) != std::string::npos);
    };
    contains(said("unit = 0.75", " = p : unorm 8 code halving(120/255)"),
             "let the field carry less: `in [0, 0.9375]`");
    contains(said("unit = 0.96", " = p : unorm 8 code halving(120/255)"),
             "let the field carry less: `in [0, 0.96875]`");
    contains(said("unit = 1", " = p : unorm 8 code halving(120/255)"),
             "take another code: the default is that end");
    contains(said("unit = 0", " = p : unorm 8 in [0, 0.9] code halving(120/255)"),
             "the default of `p` is the low end");
    contains(said("unit = 0.95", " = p : unorm 8 in [0, 0.9] code halving(120/255)"),
             "let the field carry it: `in [0, 0.95]`");
    contains(said("float = 1", " = p : unorm 8 in [0, 2] code halving(120/255)"),
             "`p` has no high end that `halving` could go towards");
    contains(said("unit = 0.75", " = p : unorm 8 in [0, 0.9] code halving"),
             "it is written `halving(120/255)`");
    contains(said("float in [-1, 1] = 0", " = p : snorm 8 code halving(63/255)"),
             "a snorm field has linear codes");
    contains(said("int in [0, 7] = 1", " = p : unorm 8 in [0, 6] code halving(63/255)"),
             "its codes are linear");
    // What is proposed can be had.
    for (const char* storage : {" = p : unorm 8 in [0, 0.9375] code halving(60/255)",
                                " = p : unorm 8 in [0, 0.96875] code halving(60/255)"})
        CHECK(Field{"unit = 0.75", storage}.errors.empty());
}

TEST_CASE("a code that its field cannot have is refused")
{
    const auto errors = [](const std::string& parameter, const std::string& storage) {
        return Field{parameter, storage}.errors;
    };
    const std::string gain = "float in [0, 256] = 1";
    for (const char* storage :
         {" = p : unorm 8 code power", " = p : unorm 8 code power(8)",
          " = p : unorm 8 code power(8, 127/255, 1)", " = p : unorm 8 code power(0, 127/255)",
          " = p : unorm 8 code power(33, 127/255)", " = p : unorm 8 code power(1.5, 127/255)",
          " = p : unorm 8 code power(8, 127/256)", " = p : unorm 8 code power(8, 0/255)",
          " = p : unorm 8 code power(8, 256/255)", " = p : unorm 8 code power(8, 12.5/255)",
          " = p : unorm 8 code power(8, 0.5)", " = p : unorm 8 code linear(0)",
          " = p : unorm 8 code sqrt(1)", " = p : unorm 8 code log2(1/2, 1)",
          " = p : unorm 8 code cubed", " = p : unorm 8 code p", " = p : snorm 8"}) {
        CAPTURE(storage);
        CHECK(errors(gain, storage) == "E0610");
    }
    CHECK(errors("float in [-1, 1] = 0", " = p : snorm 8 code linear(127/255)") == "E0610");
    CHECK(errors("int in [0, 3] = 1", " = p : unorm 8 code sqrt") == "E0610");
    CHECK(errors(gain, " = p : unorm 8 code power(8, q/255)") == "E0508");
    CHECK(only_error(Field{gain, " = p : unorm 8 code pwoer(8, 127/255)"}.checked)
              .find("did you mean `power`?") != std::string::npos);
}

TEST_CASE("a field may have a declared code, also another module's")
{
    const std::string square = code("float in [0, 4]", "sqrt(x) / 2", "(2 * u)^2");
    const Field field{"float in [0, 4] = 4", " = p : unorm 8 code c", square};
    CHECK(field.errors.empty());
    CHECK(field.code().kind == ir::Code::Kind::declared);
    CHECK(field.code().name == "c");
    CHECK(Field{"float in [0, 4] = 0", " = p : unorm 8 code c(1)", square}.errors == "E0610");
    CHECK(Field{"float in [0, 5] = 0", " = p : unorm 8 code c", square}.errors == "E0607");
    CHECK(Field{"float in [0, 5] = 0", " = p : unorm 8 in [0, 4] code c", square}.errors.empty());

    const std::map<std::string, std::string> others{
        {"console", file_text("diagnostics/console.lobe")}, {"codes", "module codes\n" + square}};
    const Checked imported = check_text("import codes { c }\nimport console { console }\n"
                                        "/// p\nparam p : float in [0, 4] = 4\n"
                                        "/// m\nmodel lit(g: geometry) { out = g.cos_i * p }\n"
                                        "packing lit on console {\n  d.r = p : unorm 8 code c\n"
                                        "  supports lighting == live\n}\n",
                                        others);
    CHECK(imported.errors().empty());
    REQUIRE(imported.module);
    CHECK((*imported.module)[imported.module->packings[0].fields[0].code.decode].module == "codes");
}
