// Groups of a manifest's entries, and `for`.
#include "framework/effect/manifest/manifest_groups.h"

#include "framework/document/units.h"
#include "tests/effect/broken_manifests.h"

namespace aftershade {
namespace {

namespace fs = std::filesystem;
using test::demo_manifest;
using test::EffectFolder;
using test::expect_faults;
using test::Lines;

const fs::path kTree = AFTERSHADE_SOURCE_DIR;

std::string conditions_of(const std::vector<WhenSpec>& conditions) {
    std::string text;
    for (const WhenSpec& condition : conditions) {
        text += " if " + condition.subject + " is";
        for (const ParamValue& value : condition.values) text += " " + format_value(value);
    }
    return text;
}

std::string text_of(const std::vector<double>& numbers) {
    std::string text;
    for (const double number : numbers) text += " " + format_number(number);
    return text;
}

std::string grid_of(const std::optional<GridSpec>& grid) {
    if (!grid) return " without a grid";
    return " grid" + text_of({double(grid->kind), grid->scale, grid->room[0], grid->room[1],
                              double(grid->tile.number), double(grid->size[0]), double(grid->size[1])});
}

std::string turn_text(TurnIndex index) {
    return text_of({double(index.number), double(index.is_of_pass)});
}

/// All that the manifests of these tests say of inputs, textures, buffers, tile lists and passes, in order.
Lines lines_of_manifest(const EffectManifest& manifest) {
    Lines lines;
    if (manifest.reach)
        for (const std::string& param : manifest.reach->params) lines.push_back("reach " + param);
    for (const InputSpec& i : manifest.inputs)
        lines.push_back(i.name + " " + i.role +
                        text_of({double(i.optional), double(i.frame), double(i.layer)}) +
                        conditions_of(i.when) + " " + i.doc);
    for (const TextureSpec& t : manifest.textures)
        lines.push_back(t.name +
                        text_of({double(t.format), double(t.layers), double(t.mips), double(t.partial)}) +
                        grid_of(t.grid) + (t.clear ? " clear" + text_of(*t.clear) : "") +
                        conditions_of(t.when) + " " + t.doc);
    for (const BufferSpec& b : manifest.buffers)
        lines.push_back(b.name + " " + b.element + grid_of(b.grid) +
                        text_of({double(b.count.number), double(b.indirect)}) + text_of(b.clear) + " " +
                        b.doc);
    for (const TileListSpec& t : manifest.tiles)
        lines.push_back(t.name + " " + (t.of ? t.of->text() : t.predicate + " " + t.on) +
                        text_of({double(t.tile.number)}) + conditions_of(t.when) + " " + t.doc);
    for (const PassSpec& p : manifest.passes) {
        std::string line = p.name + " " + list_of_names(p.shader_files()) +
                           text_of({double(p.work.index()), double(p.max_iterations)}) +
                           conditions_of(p.when);
        if (p.draw()) line += " over " + p.draw()->over.value_or("") + text_of({double(p.draw()->blend)});
        if (p.compute()) {
            const DispatchSpec& d = p.compute()->dispatch;
            line += " lists " + p.compute()->lists.value_or("") +
                    text_of({double(d.kind), double(d.tile.number), double(d.groups[0])}) + d.over;
        }
        for (const ReadSpec& r : p.reads)
            line += " reads " + r.glsl_name() + text_of({double(r.filter)}) +
                    (r.level ? turn_text(*r.level) : "") + conditions_of(r.when);
        for (const WriteSpec& w : p.writes)
            line += " writes " + w.name + turn_text(w.level) + conditions_of(w.when);
        for (const auto* accesses : {&p.images, &p.buffers})
            for (const AccessSpec& a : *accesses)
                line += " uses " + a.glsl_name() + text_of({double(a.kind)});
        for (const auto& [name, value] : p.defines) line += " " + name + "=" + value;
        lines.push_back(line);
    }
    return lines;
}

EffectManifest manifest_at(const fs::path& file, const std::string& id) {
    Diagnostics diagnostics;
    const auto node = read_document(file, diagnostics);
    const auto manifest = node ? parse_manifest(*node, kTree / "effects" / id, diagnostics) : std::nullopt;
    EXPECT_EQ(test::lines_of(diagnostics), Lines{});
    return manifest.value_or(EffectManifest{});
}

TEST(Groups, AreTheManifestThatIsWrittenOut) {
    int written_out = 0;
    for (const auto& file : fs::directory_iterator(kTree / "tests/effect/written_out")) {
        const std::string id = file.path().stem().string();
        const EffectManifest counted = manifest_at(kTree / "effects" / id / "effect.json", id);
        const Lines lines = lines_of_manifest(counted);
        EXPECT_GT(lines.size(), 30U);
        const Lines expected = lines_of_manifest(manifest_at(file.path(), id));
        ASSERT_EQ(lines.size(), expected.size()) << id;
        for (std::size_t i = 0; i < lines.size(); ++i) EXPECT_EQ(lines[i], expected[i]) << id;
        ++written_out;
    }
    EXPECT_GT(written_out, 0);
}

/// A manifest whose textures and passes are these, and "small".
std::string manifest_with(const std::string& textures, const std::string& passes) {
    return demo_manifest({{test::kTextures, R"("textures": {"small": {"format": "rgba16f", "doc": "."})" +
                                                (textures.empty() ? "" : ", " + textures) + "}"},
                          {test::kPasses, "\"passes\": [" + passes + R"(, {"name": "last", "shader": "b.frag",
            "reads": ["color", "depth"], "writes": ["color", "small"]}])"}});
}

Lines names_of(const auto& list) {
    Lines names;
    for (const auto& one : list) names.push_back(one.name);
    return names;
}

TEST(Groups, CountUpAndDownAndBesideEachOther) {
    const EffectFolder folder(manifest_with(
        R"("{side}_{n}": {"for": {"n": "0..2", "side": ["left", "right", "both"]}, "format": "rgba16f",
            "scale": "{0.5 ^ n}", "layers": "{ n + 1 }", "doc": "Half of {2*n}, {side}; {"})",
        R"({"for": {"n": "-1..-3", "side": ["both", "right", "left"]}, "name": "down_{side}", "shader": "a.frag",
            "reads": ["color"], "writes": [{"{side}_{n+3}": {"layer": "{n + 3}"}}],
            "defines": {"N_{n+3}": "{n}", "SIZE": "{n - 1} px"}})"));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(names_of(manifest.textures), (Lines{"small", "left_0", "right_1", "both_2"}));
    EXPECT_EQ(manifest.textures[3].grid.scale, 0.25);
    EXPECT_EQ(manifest.textures[3].layers, 3);
    EXPECT_EQ(manifest.textures[3].doc, "Half of 4, both; {");
    ASSERT_EQ(names_of(manifest.passes), (Lines{"down_both", "down_right", "down_left", "last"}));
    EXPECT_EQ(manifest.passes[1].writes[0].name, "right_1");
    EXPECT_EQ(manifest.passes[1].writes[0].layer, TurnIndex{1});
    EXPECT_EQ(manifest.passes[1].defines,
              (std::map<std::string, std::string>{{"N_1", "-2"}, {"SIZE", "-3 px"}}));
}

TEST(Groups, GiveTheirEntriesKeysThatTheseMayReplace) {
    const EffectFolder folder(manifest_with(
        R"("fine": {"format": "r32f", "when": {"mode": "good"}, "clear": 0, "textures": {
            "a": {"doc": "A."}, "b": {"format": "rg32f", "when": {"flag": true}, "doc": "B."},
            "inner": {"clear": 1, "textures": {"c": {"doc": "C."}}}}})",
        R"({"shader": "a.frag", "reads": ["color"], "passes": [
            {"writes": ["a", "c"], "passes": [{"name": "one"}, {"name": "two", "shader": "b.frag", "writes": ["b"]}]}]})"));
    const EffectManifest manifest = folder.sound_manifest();
    ASSERT_EQ(names_of(manifest.textures), (Lines{"small", "a", "b", "c"}));
    const TextureSpec &a = manifest.textures[1], &b = manifest.textures[2], &c = manifest.textures[3];
    EXPECT_EQ(a.format, gpu::TextureFormat::r32f);
    EXPECT_EQ(b.format, gpu::TextureFormat::rg32f);
    EXPECT_EQ(conditions_of(a.when), " if mode is \"good\"");
    EXPECT_EQ(conditions_of(b.when), " if mode is \"good\" if flag is true") << "conditions add up";
    EXPECT_EQ(a.clear, std::vector<double>{0});
    EXPECT_EQ(c.clear, std::vector<double>{1});
    ASSERT_EQ(names_of(manifest.passes), (Lines{"one", "two", "last"}));
    EXPECT_EQ(manifest.passes[0].shader, "a.frag");
    EXPECT_EQ(manifest.passes[1].shader, "b.frag");
    EXPECT_EQ(manifest.passes[1].writes[0].name, "b");
}

TEST(Groups, NestAndCombineTheirVariables) {
    const EffectFolder folder(
        manifest_with("", R"({"for": {"row": "1..2"}, "defines": {"AT": "{row}, {column}"}, "passes": [
            {"for": {"column": ["a", "b"]}, "name": "{column}_{row}", "shader": "a.frag", "reads": ["color"], "writes": ["small"]}]})"));
    const EffectManifest manifest = folder.sound_manifest();
    EXPECT_EQ(names_of(manifest.passes), (Lines{"a_1", "b_1", "a_2", "b_2", "last"}));
    EXPECT_EQ(manifest.passes[2].defines.at("AT"), "2, a") << "a group's keys may name variables inside it";
}

TEST(Groups, NeedNoMoreThanTheNameOfAPassWithAShaderOfThatName) {
    const EffectFolder folder(manifest_with("", R"("one", {"over": "tiles", "passes": ["two"]})"));
    for (const char* shader : {"one.frag", "two.frag"})
        folder.write(shader, "#version 450 core\nvoid main() {}\n");
    Diagnostics diagnostics;
    const auto node = read_document(folder.path() / "effect.json", diagnostics);
    const Node document = without_groups(*node, diagnostics);
    const Node& two = document.find("passes")->items[1];
    EXPECT_EQ(two.find("name")->string, "two");
    EXPECT_EQ(two.find("over")->string, "tiles");
    const Lines faults = test::faults_of_manifest(manifest_with(
        "", R"({"name": "three"}, {"kind": "compute", "name": "four", "dispatch": {"tile": 8}})"));
    const auto lacks = [&](const std::string& begin) {
        return std::ranges::any_of(faults,
                                   [&](const std::string& fault) { return fault.starts_with(begin); });
    };
    EXPECT_TRUE(lacks("6: pass 'three': no file 'three.frag' in "));
    EXPECT_TRUE(lacks("6: pass 'four': no file 'four.comp' in "));
}

TEST(Groups, NameTheTurnOfAFaultAndReportItOnce) {
    const auto textures = [](const std::string& entry) {
        return test::Sections{
            {test::kTextures,
             "\"textures\": {\"small\": {\"format\": \"rgba16f\", \"doc\": \".\"}, " + entry + "}"}};
    };
    expect_faults(textures(R"("t_{n}": {"for": {"n": "1..5"}, "frmat": "r32f", "doc": "."})"),
                  {"5: no pass writes the texture 't_1' (n = 1)", "5: texture 't_1' has no 'format' (n = 1)",
                   "5: texture 't_1' has no key 'frmat'; did you mean 'format'? (n = 1)"});
    expect_faults(
        textures(R"("t_{n}": {"for": {"n": "3..6"}, "format": "r32f", "scale": "{n}", "doc": "."})"),
        {"5: 'scale' must be above 0 and at most 4, not 5 (n = 5)",
         "5: no pass writes the texture 't_3' (n = 3)"});
    expect_faults(textures(R"("t": {"for": {"n": "1..2"}, "format": "r32f", "doc": "."})"),
                  {"5: texture 't' occurs twice; first at line 5 (n = 2)"});
}

TEST(Groups, TellWhatIsWrongWithAFor) {
    const auto with = [](const std::string& range, const std::string& name = "t_{n}") {
        return test::Sections{
            {test::kTextures, "\"textures\": {\"small\": {\"format\": \"rgba16f\", \"doc\": \".\"}, \"" +
                                  name + "\": {\"for\": " + range + R"(, "format": "r32f", "doc": "."}})"}};
    };
    const std::string values =
        R"(5: the variable 'n' has a range, such as "1..8" or "7..1", or a list of words and numbers)";
    for (const char* range : {R"({"n": 3})", R"({"n": "1.."})", R"({"n": "+1..2"})", R"({"n": "1..2.5"})",
                              R"({"n": "1..1e9"})", R"({"n": []})", R"({"n": [1, null]})"})
        expect_faults(with(range), {values});
    for (const char* declared : {R"("1..8")", "{}", "[1, 8]"})
        expect_faults(with(declared), {R"(5: 'for' is an object of variables: {"level": "1..8"})"});
    expect_faults(
        with(R"({"n": "1..257"})"),
        {"5: the variable 'n' has 257 values, more than the limit of 256 (shorten it, or use 'repeat')"});
    expect_faults(with(R"({"N": "1..2"})"),
                  {"5: the variable 'N' must be snake_case: a-z, 0-9 and _, beginning with a letter"});
    expect_faults(
        with(R"({"n": "1..3", "m": ["a", "b"]})"),
        {"5: the variable 'm' has 2 values, but 'n' has 3: variables of one 'for' change together"});
    expect_faults(
        with(R"({"level": "1..3"})", "t_{levle}"),
        {"5: '{levle}' names no variable of a 'for' around it (level); did you mean 'level'? (level = 1)"});
    const std::string sum =
        R"( is not "level + 1", "level - 1", "2 * level" or "0.5 ^ level" of a number (n = )";
    expect_faults(with(R"({"n": ["a", "b"]})", "t_{n+1}"), {"5: '{n+1}'" + sum + "a)"});
    expect_faults(with(R"({"n": "-1..1"})", "t_{0^n}"), {"5: '{0^n}'" + sum + "-1)"});
    expect_faults({{test::kTextures, R"("textures": {"g": {"for": {"n": "1..2"}, "textures": {
            "t_{n}": {"for": {"n": "1..2"}, "format": "r32f", "doc": "."}}}})"}},
                  {"5: the variable 'n' is one of a group around it, at line 5"});
}

TEST(Groups, TellWhatIsWrongWithThem) {
    const auto with = [](const std::string& group) {
        return test::Sections{{test::kTextures, "\"textures\": {\"g\": " + group + "}"}};
    };
    expect_faults(with(R"({"textures": {}})"), {"5: the group has no textures"});
    expect_faults(with(R"({"textures": [1]})"), {"5: 'textures' must be an object, not an array"});
    const Lines faults = test::faults_of_manifest(
        demo_manifest(with(R"({"frmat": "r32f", "textures": {"a": {"doc": "."}, "b": {"doc": "."}}})")));
    EXPECT_EQ(std::ranges::count(faults, "5: texture 'a' has no key 'frmat'; did you mean 'format'?"), 1);
    EXPECT_EQ(std::ranges::count(faults, "5: texture 'b' has no key 'frmat'; did you mean 'format'?"), 0);
}

TEST(Groups, WriteOutNoMoreThanTheLimit) {
    const std::string limit =
        "5: groups write out at most 1024 entries and 4 MiB, and this is more (shorten a 'for') (";
    const auto with = [](const std::string& inner) {
        return test::Sections{
            {test::kTextures, R"("textures": {"g": {"for": {"a": "1..256"}, "textures": {)" + inner + "}}}"}};
    };
    expect_faults(with(R"("t_{a}_{b}": {"for": {"b": "1..256"}, "format": "r32f", "doc": "."})"),
                  {limit + "a = 4, b = 253)"});
    std::string nested = R"("t": {"doc": "."})";
    for (const char* name : {"b", "c", "d", "e", "f", "g"})
        nested =
            "\"g\": {\"for\": {\"" + std::string(name) + R"(": "1..256"}, "textures": {)" + nested + "}}";
    EXPECT_EQ(test::faults_of_manifest(demo_manifest(with(nested))).size(), 1U) << "256^7 groups";
    expect_faults(with(R"("t_{a}": {"doc": ")" + std::string(100000, 'x') + "\"}"), {limit + "a = 21)"});
    expect_faults(with(R"("t_{a}": {"for": {"x": [")" + std::string(1000, 'x') + R"("]}, "doc": ")" +
                       [] {
                           std::string text;
                           for (int i = 0; i < 5000; ++i) text += "{x}";
                           return text;
                       }() +
                       "\"}"),
                  {limit + "a = 1, x = " + std::string(40, 'x') + ")"});
}

TEST(Reach, CountsAParameterSeveralTimes) {
    const std::string params =
        R"("params": {"size": {"type": "float", "unit": "px", "default": 1, "min": 0, "max": 9, "doc": "."}},
        "reach": )";
    const auto with = [&](const std::string& reach) {
        return test::Sections{{test::kParams, params + reach}, {test::kPresets, R"("presets": {})"}};
    };
    const EffectFolder folder(demo_manifest(with(R"(["3 * size", 2, "size"])")));
    EXPECT_EQ(folder.sound_manifest().reach->params, (Lines{"size", "size", "size", "size"}));
    expect_faults(with(R"(["3 * siz"])"),
                  {"4: 'reach' names 'siz', which is not a parameter; did you mean 'size'?"});
    expect_faults(with(R"(["100 * size"])"), {"4: 'reach' names '100 * size', which is not a parameter"});
}

}  // namespace
}  // namespace aftershade
