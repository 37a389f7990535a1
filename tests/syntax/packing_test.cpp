// The blocks of lines: gbuffers, codes, packings and engines. What each line means, where names end
// and the words of the grammar begin, and the one way to write them.
#include "syntax/format.h"
#include "syntax/meaning.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace lobe;
using namespace lobe::syntax;
using lobe::tests::codes;
using lobe::tests::comments;
using lobe::tests::meaning;
using lobe::tests::parsed;

namespace {

constexpr std::string_view head = "module m\n";

/// The meaning of items, or the codes of what was wrong with them.
std::string read(std::string_view items)
{
    const auto result = parsed(fmt::format("{}{}\n", head, items));
    if (result.diagnostics.has_errors()) return codes(result.diagnostics);
    const std::string text = meaning(result.tree);
    return text.substr(head.size(), text.size() - head.size() - 1);
}

std::string read_fact(std::string_view fact)
{
    const std::string text = read(fmt::format("gbuffer g {{ target t \"T\" {{\n{}\n}} }}", fact));
    constexpr std::string_view front = "gbuffer g target t \"T\" {";
    if (!text.starts_with(front)) return text;
    return text.substr(front.size(), text.size() - front.size() - 3);  // `; }`
}

std::string read_line(std::string_view line)
{
    const std::string text = read(fmt::format("packing m on g {{\n{}\n}}", line));
    constexpr std::string_view front = "packing m on g ";
    return text.starts_with(front) ? text.substr(front.size()) : text;
}

std::string formatted(std::string_view items)
{
    const auto result = parsed(fmt::format("{}{}\n", head, items));
    if (result.diagnostics.has_errors()) return codes(result.diagnostics);
    const std::string text = format(result.tree);
    const auto again = parsed(text);
    CHECK(meaning(again.tree) == meaning(result.tree));
    CHECK(comments(again.tree) == comments(result.tree));
    CHECK(format(again.tree) == text);
    return text.substr(head.size());
}

}  // namespace

TEST_CASE("a gbuffer has settings, targets and pins")
{
    CHECK(read(R"(
/// What is there.
gbuffer ue4 {
  /// Docs.
  setting version "engine version" : v4_25, v4_26 = v4_26
  setting on "r.On" : off, on = on
  target d "GBufferD" {
    format unorm 8
    /// Red.
    channel r "CustomData.x" { field "GBuffer.CustomData.x" also "fog" }
    channel g "CustomData.y"
    channel b "CustomData.z" { }
  }
  target e "GBufferE" { }
  pin opacity "Opacity" in [0, 2^2] = 1
  pin raw "Raw \"x\"" = -1
})") == R"(What is there.gbuffer ue4 Docs.setting version "engine version" v4_25,v4_26,= v4_26; )"
        R"(setting on "r.On" off,on,= on; )"
        R"(target d "GBufferD" {format unorm:8; )"
        R"(Red.channel r "CustomData.x" {field "GBuffer.CustomData.x"; also "fog"; })"
        R"(channel g "CustomData.y" {}channel b "CustomData.z" {}})"
        R"(target e "GBufferE" {})"
        R"(pin opacity "Opacity" [0 (^ 2 2)]= 1; pin raw "Raw \"x\"" = (neg 1); )");
    CHECK(read("gbuffer g { }") == "gbuffer g ");
}

TEST_CASE("facts start with their word")
{
    CHECK(read_fact("format float 16") == "format float:16");
    CHECK(read_fact("format unorm 8 when a == b and not c") ==
          "format unorm:8 when (and (== a b) (not c))");
    CHECK(read_fact("exists when a == b") == "exists when (== a b)");
    CHECK(read_fact("exists when a == on else 0") == "exists when (== a on) else 0");
    CHECK(read_fact("exists when on else -1 / 2") == "exists when on else (/ (neg 1) 2)");
    CHECK(read_fact("field \"a.b\"") == "field \"a.b\"");
    CHECK(read_fact("holds x \"t\"") == "holds x \"t\"");
    CHECK(read_fact("holds x \"t\" lent") == "holds x \"t\" lent");
    CHECK(read_fact("holds x \"t\" lent when c") == "holds x \"t\" lent when c");
    CHECK(read_fact("holds lent \"t\" when lent") == "holds lent \"t\" when lent");
    CHECK(read_fact("also \"t\" when a < b") == "also \"t\" when (< a b)");
    CHECK(read_fact("changes \"t\"") == "changes \"t\"");
}

TEST_CASE("behind exists, else belongs to exists")
{
    CHECK(read_fact("exists when a / b else 0") == "exists when (/ a b) else 0");
    CHECK(read_fact("exists when (a / b else c) else 0") == "exists when (/ a b else c) else 0");
    CHECK(read_fact("exists when f(a / b else c) else 0") ==
          "exists when (call f (/ a b else c)) else 0");
    CHECK(read_fact("exists when (if a then b else c) else d") == "exists when (if a b c) else d");
    CHECK(read_fact("exists when a else b / c else d") == "exists when a else (/ b c else d)");
    CHECK(read_fact("format unorm 8 when a / b else c == d") ==
          "format unorm:8 when (== (/ a b else c) d)");
}

TEST_CASE("a condition ends where the next line begins")
{
    CHECK(read_fact("holds x \"t\" lent when c\nfield \"f\"\nexists when a == on\n"
                    "changes \"x\"\nexists when d else e\nformat unorm 8 when f\nformat snorm 4") ==
          "holds x \"t\" lent when c; field \"f\"; exists when (== a on); changes \"x\"; "
          "exists when d else e; format unorm:8 when f; format snorm:4");
    // As everywhere, an operator continues the line before it.
    CHECK(read_fact("exists when a\n  and b\n  or c\nalso \"x\"") ==
          "exists when (or (and a b) c); also \"x\"");
    CHECK(read_fact("exists\n  when a\n  else 1\nalso \"x\"\n  when b") ==
          "exists when a else 1; also \"x\" when b");
}

TEST_CASE("a code has two directions")
{
    CHECK(read("/// Gains.\ncode gain(x: float in [0, 256]) {\n"
               "  encode = log2(1 + x) / log2(257)\n  decode(u) = 2^(u * log2(257)) - 1\n}") ==
          "Gains.code gain x:float[0 256] encode (/ (call log2 (+ 1 x)) (call log2 257)) "
          "decode u (- (^ 2 (* u (call log2 257))) 1)");
    CHECK(read("code code(code: unit) { encode = encode decode(decode) = decode }") ==
          "code code code:unit encode encode decode decode decode");
}

TEST_CASE("a field says where, what and how")
{
    CHECK(read_line("d.r = gain : unorm 8") == "d.r, = gain unorm:8; ");
    CHECK(read_line("d.b[4..7] = a : unorm 4") == "d.b[4 7], = a unorm:4; ");
    CHECK(read_line("d.b[4] = a : unorm 1") == "d.b[4 4], = a unorm:1; ");
    CHECK(read_line("d.b [ 0 .. 63 ] = a : unorm 63") == "d.b[0 63], = a unorm:63; ");
    CHECK(read_line("d.r, d.g[0..3] = name.r : unorm 12 in [0, 128] code power(8, 127/255)") ==
          "d.r,d.g[0 3], = name.r unorm:12 [0 128] code power 8 (/ 127 255); ");
    CHECK(read_line("d.rgb = tint : unorm 8 code sqrt") == "d.rgb, = tint unorm:8 code sqrt; ");
    CHECK(read_line("d.r = a : snorm 5 code linear(12/15)") ==
          "d.r, = a snorm:5 code linear (/ 12 15); ");
    CHECK(read_line("d.r = a : unorm 8\n  in [0, 1]\n  code power(8)\nd.g = b : unorm 8") ==
          "d.r, = a unorm:8 [0 1] code power 8; d.g, = b unorm:8; ");
}

TEST_CASE("clauses of a packing")
{
    CHECK(read_line("require exact a == 1, b == -1 / 2") == "exact a 1, b (/ (neg 1) 2),  ; ");
    CHECK(read_line("require exact a == (b == c)") == "exact a (== b c),  ; ");
    CHECK(read_line("require exact exact == 1 + 2\nrequire radiance error < 0.5%") ==
          "exact exact (+ 1 2),  ; radiance 0.5  ; ");
    CHECK(read_line("require radiance error < 20 %") == "radiance 20  ; ");
    CHECK(read_line("supports version == v4_26, v4_27") == "supports version v4_26,v4_27,; ");
    CHECK(read_line("over f0 in [0.02, 1]") == "over f0  [0.02 1]; ");
    CHECK(read_line("without anisotropy, tangent") == "without  anisotropy,tangent,; ");
    CHECK(read("packing m on g { }") == "packing m on g ");
}

TEST_CASE("targets and parameters may have the names of words")
{
    CHECK(read_line("d.r = code : unorm 8\ncode.r = in : unorm 8\nin.r = when : unorm 8\n"
                    "require.r = on : unorm 8 code code\nover.x, without.y[0] = a : in 2") ==
          "d.r, = code unorm:8; code.r, = in unorm:8; in.r, = when unorm:8; "
          "require.r, = on unorm:8 code code; over.x,without.y[0 0], = a in:2; ");
    CHECK(read("packing on on on {\n}\nengine for for for {\n}") ==
          "packing on on on \nengine for for for ");
    CHECK(read("param gbuffer : unit = 1 code \"x\"\nterm code(engine: unit) =\n  engine\n"
               "term packing() = code(1)") ==
          "param gbuffer unit = 1 tier code label \"x\"\n"
          "term code (engine:unit ) -> ? = engine\nterm packing () -> ? = (call code 1)");
}

TEST_CASE("a code on a line of its own is a field's or an item")
{
    CHECK(read("packing m on g {\n d.r = a : unorm 8\n code half\n}\n"
               "code half(x: unit) { encode = x decode(u) = u }") ==
          "packing m on g d.r, = a unorm:8 code half; \n"
          "code half x:unit encode x decode u u");
    CHECK(read("packing m on g {\n d.r = a : unorm 8\n"
               "code half(x: unit) { encode = x decode(u) = u }") == "E0202");
}

TEST_CASE("an engine names what its editor shows")
{
    CHECK(read("engine ue4 for callisto {\n shading_model \"Callisto\"\n"
               " pin custom_data0 = gain \"Gain\"\n pin opacity = pin\n"
               " node \"Advanced\" { a, b }\n color (0.1, 1/2, f(a, b))\n}") ==
          "engine ue4 for callisto shading_model   \"Callisto\"; pin custom_data0 gain \"Gain\"; "
          "pin opacity pin; node   \"Advanced\"a,b,; color   0.1 (/ 1 2) (call f a b); ");
}

TEST_CASE("spans of lines and slots")
{
    const auto result = parsed("module m\npacking m on g {\n  // note\n  d.r, d.g[0..3] = a : "
                               "unorm 12 code power(8)  // behind\n}\n");
    const auto& packing = std::get<PackingItem>(result.tree.items.at(0).node);
    const auto& field = std::get<FieldClause>(packing.lines.at(0));
    const auto text = [&](const Span& span) { return result.sources.text(span); };
    CHECK(text(field.span) == "d.r, d.g[0..3] = a : unorm 12 code power(8)");
    CHECK(text(field.slots[1].span) == "d.g[0..3]");
    CHECK(text(field.storage.span) == "unorm 12");
    CHECK(text(field.code->span) == "code power(8)");
    CHECK(text(result.tree.items[0].span).ends_with("// behind\n}"));
}

TEST_CASE("lines of a block have one way to be written")
{
    CHECK(formatted(R"(gbuffer   ue4{
setting a "A":off,on=on
  setting   longer "Label":x=x   // behind
  target d "D" {format unorm 8

  channel r "R" {   field "F.r" }
  channel gg "GG"   {}
  channel b "B" { field "F.b"   // why
  }
  channel a "A" { format srgb 8 when (a==on) field "F.a" }
  }
  pin p "P" in[0,1]=1
  pin longer "Longer"=0.5
}
code c(x:unit){encode=x
decode(u)=(u)}
packing m on ue4{
 d.r=a:unorm 8 code power(8,127/255)
 // between
 d.b[4..7],d.a[3..3]=longer:unorm 5 in[0,15/16]

 d.g = b:unorm 8
 without x,y
 d.a[0..0] = c : unorm 1
 require exact a==1,b==(0),c==(d<e)
 require radiance error<2%
 supports v==v4_26
 over f0 in[0,1]
}
engine ue4 for m {
 shading_model "M"
 pin p=a "A"
 pin longer=b
 node "N"{a,b}
 color(0,0.5,1)
})") == R"(gbuffer ue4 {
  setting a      "A"     : off, on = on
  setting longer "Label" : x = x  // behind
  target d "D" {
    format unorm 8

    channel r  "R"  { field "F.r" }
    channel gg "GG"
    channel b "B" {
      field "F.b"  // why
    }
    channel a "A" {
      format srgb 8 when a == on
      field "F.a"
    }
  }
  pin p      "P"      in [0, 1] = 1
  pin longer "Longer" = 0.5
}
code c(x: unit) {
  encode = x
  decode(u) = u
}
packing m on ue4 {
  d.r               = a      : unorm 8 code power(8, 127/255)
  // between
  d.b[4..7], d.a[3] = longer : unorm 5 in [0, 15/16]

  d.g = b : unorm 8
  without x, y
  d.a[0] = c : unorm 1
  require exact a == 1, b == 0, c == (d < e)
  require radiance error < 2%
  supports v == v4_26
  over f0 in [0, 1]
}
engine ue4 for m {
  shading_model "M"
  pin p      = a "A"
  pin longer = b
  node "N" { a, b }
  color (0, 0.5, 1)
}
)");
}

TEST_CASE("long lines of a block break between their parts")
{
    const std::string a(30, 'a');
    const std::string b(30, 'b');
    const std::string c(30, 'c');
    CHECK(formatted(fmt::format("packing m on g {{\n d.r = {} : unorm 8 in [{}, 1] code {}(1)\n"
                                " d.g = x : unorm 8\n without {}, {}, {}\n}}",
                                a, b, c, a, b, c)) ==
          fmt::format("packing m on g {{\n  d.r = {} : unorm 8 in [{}, 1]\n    code {}(1)\n"
                      "  d.g = x : unorm 8\n  without {}, {},\n    {}\n}}\n",
                      a, b, c, a, b, c));
    CHECK(
        formatted(fmt::format("gbuffer g {{ target t \"T\" {{\n exists when {} == {} and {} == {} "
                              "else 1 }} }}",
                              a, b, c, a)) ==
        fmt::format("gbuffer g {{\n  target t \"T\" {{\n    exists when {} == {}\n"
                    "      and {} == {} else 1\n  }}\n}}\n",
                    a, b, c, a));
    CHECK(formatted(fmt::format(
              "gbuffer g {{ target t \"T\" {{\n holds {} \"{}\" when {} == x }} }}", a, b, c)) ==
          fmt::format("gbuffer g {{\n  target t \"T\" {{\n    holds {} \"{}\"\n"
                      "      when {} == x\n  }}\n}}\n",
                      a, b, c));
    // Columns that would make a line too long are not shared.
    CHECK(formatted(fmt::format("packing m on g {{\n {}.r = x : unorm 8\n d.r = {}{} : unorm 8\n}}",
                                a, b, c)) ==
          fmt::format("packing m on g {{\n  {}.r = x : unorm 8\n  d.r = {}{} : unorm 8\n}}\n", a, b,
                      c));
}

TEST_CASE("comments of a block belong to their lines")
{
    constexpr std::string_view text = R"(gbuffer g {  // opening
  // before the setting
  setting s "S" : a = a  // behind the setting
  /// documents
  target t "T" {
    // first
    format unorm 8  // behind the format
    // before the channel

    // apart
    channel r "R" {
      // inside
      field "f"  // behind
    }  // behind the channel
    // at the end of the target
  }
  // before the pin
  pin p "P" in [0, // inside the range
    1] = 1  // behind the pin
  // at the end
}  // behind the gbuffer
code c(x: unit) {
  // before
  encode = x  // behind
  // before the other
  decode(u) = u  // behind the other
  // last
}
packing m on g {
  // before the field
  d.r = a : unorm 8  // behind the field
  // before the clause
  without a, // inside
    b
  // at the end
}
engine g for m {
  // nothing here
}
)";
    const auto result = parsed(std::string{head} + std::string{text});
    REQUIRE(codes(result.diagnostics) == "");
    const auto texts = [](const std::vector<Comment>& comments) {
        std::string all;
        for (const Comment& comment : comments) all += comment.text + "; ";
        return all;
    };
    const auto& gbuffer = std::get<GbufferItem>(result.tree.items.at(0).node);
    CHECK(texts(gbuffer.settings[0].comments) == "opening; before the setting; ");
    CHECK(texts(gbuffer.settings[0].trailing) == "behind the setting; ");
    const TargetClause& target = gbuffer.targets.at(0);
    CHECK(doc_text(target.comments) == "documents");
    CHECK(texts(target.facts[0].comments) == "first; ");
    CHECK(texts(target.facts[0].trailing) == "behind the format; ");
    const ChannelClause& channel = target.channels.at(0);
    CHECK(texts(channel.comments) == "before the channel; apart; at the end of the target; ");
    CHECK(channel.comments.at(1).blank_before);
    CHECK(texts(channel.facts[0].comments) == "inside; ");
    CHECK(texts(channel.facts[0].trailing) == "behind; ");
    CHECK(texts(channel.trailing) == "behind the channel; ");
    CHECK(texts(gbuffer.pins[0].comments) == "before the pin; inside the range; at the end; ");
    CHECK(texts(gbuffer.pins[0].trailing) == "behind the pin; ");
    CHECK(texts(result.tree.items[0].trailing) == "behind the gbuffer; ");
    const auto& code = std::get<CodeItem>(result.tree.items.at(1).node);
    CHECK(texts(code.encode_comments) == "before; ");
    CHECK(texts(code.encode_trailing) == "behind; ");
    CHECK(texts(code.decode_comments) == "before the other; last; ");
    CHECK(texts(code.decode_trailing) == "behind the other; ");
    const auto& packing = std::get<PackingItem>(result.tree.items.at(2).node);
    CHECK(texts(std::get<FieldClause>(packing.lines[0]).trailing) == "behind the field; ");
    CHECK(texts(std::get<PackingClause>(packing.lines[1]).comments) ==
          "before the clause; inside; at the end; ");
    CHECK(texts(result.tree.items[3].comments) == "nothing here; ");

    const std::size_t slashes = comments(result.tree).size();
    CHECK(slashes == 28);
    formatted(text);
}

TEST_CASE("a comment may stand before and behind every token of a block")
{
    const std::vector<std::string> texts{
        "gbuffer g { setting s \"S\" : a , b = a target t \"T\" { format unorm 8 when s == a "
        "exists when s == b else 1 channel r \"R\" { field \"f\" holds x \"X\" lent when s == a "
        "also \"y\" changes \"z\" } } pin p \"P\" in [ 0 , 1 ] = 1 }",
        "code c ( x : unit in [ 0 , 1 ] ) { encode = x decode ( u ) = u }",
        "packing m on g { d . r , d . g [ 4 .. 7 ] = a . r : unorm 12 in [ 0 , 1 ] code power "
        "( 8 , 1 ) require exact a == 1 , b == 2 require radiance error < 2 % supports s == a , b "
        "over f0 in [ 0 , 1 ] without x , y }",
        "engine g for m { shading_model \"M\" pin p = a \"A\" node \"N\" { a , b } "
        "color ( 0 , 1 , 0 ) }"};
    for (const std::string& text : texts) {
        const std::string meant = read(text);
        REQUIRE(!meant.starts_with("E0"));
        // Behind the first two words, whose line says that an item begins.
        std::size_t space = text.find(' ', text.find(' ') + 1);
        for (; space != std::string::npos; space = text.find(' ', space + 1)) {
            const std::string before = text.substr(0, space);
            const std::string behind = text.substr(space);
            for (const char* comment : {"  // note\n", "\n// note\n"}) {
                CAPTURE(before, comment);
                const auto result =
                    parsed(fmt::format("{}{}{}{}\n", head, before, comment, behind));
                REQUIRE(codes(result.diagnostics) == "");
                CHECK(comments(result.tree) == std::vector<std::string>{"note"});
                const std::string canonical = format(result.tree);
                const auto again = parsed(canonical);
                CHECK(meaning(again.tree) == std::string{head} + meant + "\n");
                CHECK(comments(again.tree) == std::vector<std::string>{"note"});
                CHECK(format(again.tree) == canonical);
            }
        }
    }
}
