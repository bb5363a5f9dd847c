// Documents and shaders that were made to do harm: each ends with a fault that names the limit, and in time.
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <functional>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/input_files.h"
#include "framework/base/text.h"
#include "framework/capture/capture_grammar.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/profile_grammar.h"
#include "framework/document/document.h"
#include "framework/document/grammar_form.h"
#include "framework/document/grammar_schema.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/shader_source.h"
#include "framework/file/exr_file.h"
#include "framework/golden/golden_grammar.h"
#include "framework/look/look.h"
#include "framework/look/look_grammar.h"
#include "framework/render/history_file.h"
#include "framework/run/output.h"
#include "framework/scene/fields.h"
#include "framework/scene/gltf_bytes.h"
#include "framework/scene/job.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Fails where the work takes longer than any honest input of its size.
class Within {
public:
    explicit Within(double seconds) : seconds_(seconds) {}
    ~Within() {
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin_;
        EXPECT_LT(taken.count(), seconds_);
    }
    Within(const Within&) = delete;
    Within& operator=(const Within&) = delete;

private:
    double seconds_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

bool has_error(const Diagnostics& faults, const std::string& part) {
    for (const Diagnostic& fault : faults.all())
        if (fault.severity == Severity::error && fault.message.find(part) != std::string::npos) return true;
    return false;
}

std::string text_of(const Diagnostics& faults) {
    std::string text;
    for (std::size_t i = 0; i < std::min<std::size_t>(faults.all().size(), 5); ++i)
        text += faults.all()[i].message.substr(0, 200) + "\n";
    return text;
}

void write_look(const TemporaryFolder& folder, int number, const ordered_json& steps,
                const ordered_json& vars = ordered_json::object()) {
    write_text(folder / (std::to_string(number) + ".json"),
               ordered_json{{"aftershade", 1}, {"vars", vars}, {"steps", steps}}.dump());
}

ordered_json use_of(int number, const std::string& name) {
    return {{"use", std::to_string(number) + ".json"}, {"name", name}};
}

const ordered_json kOneStep = ordered_json::array({{{"effect", "view_transform"}}});

TEST(HostileLooks, ThatUseOneAnotherInALongChainAreRefused) {
    const TemporaryFolder folder;
    constexpr int kLooks = 2000;
    for (int i = 0; i < kLooks; ++i) write_look(folder, i, ordered_json::array({use_of(i + 1, "a")}));
    write_look(folder, kLooks, kOneStep);
    Diagnostics faults;
    read_look(folder / "0.json", faults);
    EXPECT_TRUE(has_error(faults, "would be the look 33 in a chain of 'use', the limit is 32"))
        << text_of(faults);
    EXPECT_EQ(faults.error_count(), 1) << text_of(faults);
}

TEST(HostileLooks, ThatDoubleByUseAreRefused) {
    const Within limit(5);
    const TemporaryFolder folder;
    constexpr int kDoublings = 16;
    for (int i = 0; i < kDoublings; ++i)
        write_look(folder, i, ordered_json::array({use_of(i + 1, "a"), use_of(i + 1, "b")}));
    write_look(folder, kDoublings, ordered_json::array());
    Diagnostics faults;
    read_look(folder / "0.json", faults);
    EXPECT_TRUE(has_error(faults, "the look uses other looks more than 256 times")) << text_of(faults);
    EXPECT_EQ(faults.error_count(), 1) << text_of(faults);
}

TEST(HostileLooks, WhoseVariablesDoubleAreRefused) {
    const Within limit(5);
    const TemporaryFolder folder;
    constexpr int kDoublings = 28;
    const ordered_json var = {{"var", "x"}};
    for (int i = 0; i < kDoublings; ++i) {
        ordered_json use = use_of(i + 1, "a");
        use["vars"] = {{"x", ordered_json::array({var, var})}};
        write_look(folder, i, ordered_json::array({use}), {{"x", 1}});
    }
    write_look(folder, kDoublings, kOneStep, {{"x", 1}});
    Diagnostics faults;
    read_look(folder / "0.json", faults);
    EXPECT_TRUE(has_error(faults, "variables put more than 100000 values into the look")) << text_of(faults);
    EXPECT_EQ(faults.error_count(), 1) << text_of(faults);
}

TEST(HostileLooks, OfManyVariablesOrStepsAreRefused) {
    const Within limit(5);
    const TemporaryFolder folder;
    std::string vars;
    for (int i = 0; i < 80'000; ++i)
        vars += std::string(i == 0 ? "" : ", ") + "\"v" + std::to_string(i) + "\": 1";
    write_text(folder / "0.json",
               R"({"aftershade": 1, "vars": {)" + vars + R"(}, "steps": )" + kOneStep.dump() + "}");
    ordered_json steps;
    for (int i = 0; i < 20'000; ++i)
        steps.push_back({{"effect", "view_transform"}, {"name", "a" + std::to_string(i)}});
    write_look(folder, 1, steps);
    Diagnostics many_vars, many_steps;
    read_look(folder / "0.json", many_vars);
    read_look(folder / "1.json", many_steps);
    EXPECT_TRUE(has_error(many_vars, "the look has 80000 variables; the limit is 1000"))
        << text_of(many_vars);
    EXPECT_TRUE(has_error(many_steps, "the look has more than 1000 steps")) << text_of(many_steps);
}

TEST(HostileDocuments, ThatNestDeeplyOrRepeatAKeyHaveOneFault) {
    for (const std::string open : {"[", "{\"a\":"}) {
        std::string text;
        for (int i = 0; i < 100'000; ++i) text += open;
        Diagnostics faults;
        EXPECT_FALSE(parse_document(text, "deep.json", faults));
        EXPECT_TRUE(has_error(faults, "nested deeper than 64 levels")) << text_of(faults);
    }
    Diagnostics faults;
    EXPECT_FALSE(parse_document("{\"a\": 1,\n\"b\": 2, \"a\": 3}", "twice.json", faults));
    EXPECT_TRUE(has_error(faults, "the key 'a' occurs twice in one object; first at line 1"))
        << text_of(faults);
}

/// Where a document's form holds a text against a pattern.
struct PlacedPattern {
    std::string name, regex;
    grammar::Form form;
    std::function<Node(const std::string&)> place;  ///< the value with the text at kTextPlace
};

const Place kTextPlace{"text", 7, 1};

Node string_node(const std::string& text) {
    Node node;
    node.kind = Node::Kind::string;
    node.place = kTextPlace;
    node.string = text;
    return node;
}

Node list_node(const std::string& text) {
    Node node;
    node.kind = Node::Kind::array;
    node.items = {string_node(text)};
    return node;
}

Node object_node(const std::string& text) {
    Node node;
    node.kind = Node::Kind::object;
    node.members = {{text, kTextPlace, {}}};
    return node;
}

void add_patterns(const std::string& name, const grammar::Form& form, std::vector<PlacedPattern>& patterns) {
    grammar::SchemaScope scope;
    const auto schema = form.type().schema(scope);
    const auto add = [&](const auto& part, Node (*place)(const std::string&)) {
        if (part.contains("pattern"))
            patterns.push_back({name, part["pattern"].template get<std::string>(), form, place});
    };
    add(schema, string_node);
    if (schema.contains("items")) add(schema["items"], list_node);
    if (schema.contains("propertyNames")) add(schema["propertyNames"], object_node);
}

std::vector<PlacedPattern> all_patterns() {
    std::vector<PlacedPattern> patterns;
    for (const grammar::Block* document :
         {&look_block(), &look_step_block(), &capture_block(), &effect_block(), &profile_block(),
          &golden_suite_block(), &effect_case_block()})
        for (const grammar::Block* block : grammar::blocks_of(*document)) {
            for (const grammar::Key& key : block->keys)
                add_patterns(block->name + "." + key.name, key.form, patterns);
            for (const grammar::Block& kind : block->kinds)
                for (const grammar::Key& key : kind.keys)
                    add_patterns(kind.name + "." + key.name, key.form, patterns);
        }
    return patterns;
}

bool takes(const PlacedPattern& pattern, const std::string& text) {
    Diagnostics faults;
    pattern.form.type().check(pattern.place(text), {}, faults);
    return std::none_of(faults.all().begin(), faults.all().end(),
                        [](const Diagnostic& fault) { return fault.place.line == kTextPlace.line; });
}

const std::vector<std::string> kSamples = {"",
                                           " ",
                                           "a",
                                           "A",
                                           "_",
                                           "a1_b",
                                           "1a",
                                           "a-b",
                                           "-a",
                                           "a b",
                                           "aov:x",
                                           "aov:",
                                           "1.0.0",
                                           "01.0.0",
                                           "1.0",
                                           "1.0.0.0",
                                           "10.20.30",
                                           "pass.index",
                                           "pass.index + 1",
                                           "pass.index+12",
                                           "pass.index +  123",
                                           "pass.index -",
                                           "1-24",
                                           "1..24x2",
                                           "1-24:2,30",
                                           "1-24x0",
                                           ",",
                                           " 1 ",
                                           "-5--1",
                                           "> gain",
                                           "<=gain",
                                           "=> gain",
                                           "> Gain",
                                           "< ",
                                           "step.texture",
                                           "a.b.c",
                                           "a/b.c",
                                           "a=b.c",
                                           ".",
                                           "has.depth",
                                           "GL_X",
                                           "a__b",
                                           "X9",
                                           "object",
                                           "objects",
                                           "name",
                                           "has.",
                                           "Combined.RGBA",
                                           "\xc3\xa9"};

TEST(Patterns, OfEveryDocumentAreWhatTheProgramTakes) {
    int compared = 0;
    for (const PlacedPattern& pattern : all_patterns()) {
        const auto taken = std::count_if(kSamples.begin(), kSamples.end(),
                                         [&](const std::string& sample) { return takes(pattern, sample); });
        // A name of something declared elsewhere: whoever reads the value judges it.
        if (taken == std::ptrdiff_t(kSamples.size())) continue;
        ++compared;
        for (const std::string& sample : kSamples)
            EXPECT_EQ(takes(pattern, sample), std::regex_search(sample, std::regex(pattern.regex)))
                << pattern.name << ": '" << sample << "' and " << pattern.regex;
    }
    EXPECT_GT(compared, 8) << "the documents have lost their patterns";
}

TEST(Patterns, TakeLongTextsWithoutRecursion) {
    const Within limit(5);
    for (const PlacedPattern& pattern : all_patterns())
        for (const char c : {' ', 'a', '9', '.', ','}) {
            takes(pattern, std::string(100'000, c));
            takes(pattern, "1." + std::string(60'000, c) + ".0");
        }
    EXPECT_FALSE(parse_frame_range(std::string(100'000, ' ')));
}

TEST(FrameRanges, OfAMillionFramesAreHeldAgainstTheOutputsInTime) {
    const std::clock_t begin = std::clock();  // of the processor, since nothing here waits
    Sequence sequence;
    sequence.files = FramePattern("in_####.exr");
    sequence.frames = *parse_frame_range("1-1000000");
    OutputOptions outputs;
    outputs.patterns = {"out_####.exr"};
    Diagnostics faults;
    InputFiles inputs;
    for (const int frame : sequence.frames) inputs.add(sequence.path_of(frame));
    check_outputs(outputs, sequence, inputs, faults);
    EXPECT_FALSE(faults.has_errors()) << text_of(faults);
    outputs.patterns = {"./in_####.exr"};
    check_outputs(outputs, sequence, inputs, faults);
    EXPECT_TRUE(has_error(faults, "would replace the input in_0001.exr")) << text_of(faults);
    EXPECT_LT(double(std::clock() - begin) / CLOCKS_PER_SEC, 10);  // 4 s at rest
}

// ---- shaders ----

struct Shader {
    TemporaryFolder folder;
    EffectManifest manifest;
    PassSpec pass;

    explicit Shader(const std::string& text) {
        write_text(folder / "main.frag", text);
        pass.folder = folder.path();
        pass.shader = "main.frag";
    }
    Diagnostics faults() const {
        Diagnostics found;
        const ShaderSource source = author_text(manifest, pass, folder.path(), found, ShaderFile::main);
        check_shader_size(source, found);
        return found;
    }
};

TEST(HostileShaders, WhoseIncludesFormALongChainAreRefused) {
    const Shader shader("#include \"0.glsl\"\n");
    for (int i = 0; i < 3000; ++i)
        write_text(shader.folder / (std::to_string(i) + ".glsl"),
                   "#include \"" + std::to_string(i + 1) + ".glsl\"\n");
    const Diagnostics faults = shader.faults();
    EXPECT_TRUE(has_error(faults, "includes go deeper than 64 files")) << text_of(faults);
    EXPECT_EQ(faults.error_count(), 1);
}

TEST(HostileShaders, ThatIncludeWhatIsNoFileAreRefusedAtOnce) {
    const Within limit(5);
    const Shader shader("#include \"pipe.glsl\"\n#include \"zero.glsl\"\n#include \"large.glsl\"\n");
    ASSERT_EQ(mkfifo((shader.folder / "pipe.glsl").c_str(), 0600), 0);
    fs::create_symlink("/dev/zero", shader.folder / "zero.glsl");
    write_text(shader.folder / "large.glsl", std::string(kMaxShaderFileBytes + 1, ' '));
    const Diagnostics faults = shader.faults();
    EXPECT_TRUE(has_error(faults, "pipe.glsl: is not a regular file")) << text_of(faults);
    EXPECT_TRUE(has_error(faults, "zero.glsl leads out of the folder")) << text_of(faults);
    EXPECT_TRUE(has_error(faults, "large.glsl: the file has 1048577 bytes, the limit is 1048576"))
        << text_of(faults);
}

TEST(HostileShaders, OfManyLinesTermsOrElementsAreRefused) {
    std::string lines, terms;
    for (int i = 0; i < 20'001; ++i) lines += "a = a * 1.01;\n";
    for (int i = 0; i < 20'000; ++i) terms += "a + ";
    EXPECT_TRUE(has_error(Shader(lines).faults(), "more than 20000 lines"));
    EXPECT_TRUE(has_error(Shader("float b = " + terms + "a;\n").faults(), "more than 10000 operators"));
    EXPECT_TRUE(has_error(Shader("float v[1000000];\n").faults(),
                          "an array of 1000000 elements; the limit is 65536"));
}

TEST(HostileShaders, OfBlanksAndLongNamesAreReadInTime) {
    const Within limit(5);
    const std::string blanks(50'000, ' ');
    const Shader shader(blanks + "#" + blanks + "include" + blanks + "<pass>\n#include <" +
                        std::string(50'000, 'a') + ">\n");
    EXPECT_TRUE(has_error(shader.faults(), "cannot read"));
}

TEST(Shaders, WithTablesAndLongFormulasAreTaken) {
    std::string table = "const float kTable[4096] = float[](", sum = "float sum = 0.0";
    for (int i = 0; i < 4096; ++i) table += std::string(i ? ", " : "") + "1.0 + 2.0";
    for (int i = 0; i < 2000; ++i) sum += " + kTable[" + std::to_string(i) + "]";
    const Shader shader(table + ");\n" + sum + ";\nfloat last(Block b) { return b.values[100000]; }\n");
    EXPECT_FALSE(shader.faults().has_errors()) << text_of(shader.faults());
}

TEST(Pipes, AreRefusedWhereHistoriesAreReadAndDoNotWait) {
    const Within limit(5);
    const TemporaryFolder folder;
    ASSERT_EQ(mkfifo((folder / "history").c_str(), 0600), 0);
    try {
        read_history(folder / "history");
        ADD_FAILURE() << "a pipe was read";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_NE(std::string(error.what()).find("is not a regular file"), std::string::npos) << error.what();
    }
    std::string fault;
    EXPECT_EQ(read_regular_file(folder / "history", 10, fault), "");
    EXPECT_EQ(fault, "is not a regular file");
}

TEST(Messages, HoldNoCommandsForATerminal) {
    Diagnostics faults;
    faults.error({"a\x1b[2J.json", 1, 2}, "the key 'x\x1b]0;title\x07\n::error::' is not known\r");
    std::ostringstream out;
    faults.print(out);
    EXPECT_EQ(out.str(), "a?[2J.json:1:2: error: the key 'x?]0;title??::error::' is not known?\n");
    EXPECT_EQ(printable_lines("a\tb\nc\x1b[31md\r\n\xff"), "a\tb\nc?[31md?\n?");
}

TEST(Limits, OfThePageAreThoseOfTheCode) {
    const ReadLimits exr;
    const std::vector<std::pair<std::string, std::uint64_t>> limits = {
        {"document: bytes", kMaxDocumentBytes},
        {"document: levels of nesting", kMaxDocumentDepth},
        {"look: looks in a chain of `use`", kMaxLookDepth},
        {"look: uses of other looks in all", kMaxLookUses},
        {"look: steps, with those of looks that it uses", kMaxLookSteps},
        {"look: variables of each look", kMaxLookVariables},
        {"look: values that variables put in", kMaxVariableValues},
        {"look: objects of a mask", kMaxMaskObjects},
        {"range of frames: frames", kMaxRangeFrames},
        {"shader: bytes of a file", kMaxShaderFileBytes},
        {"shader with its includes: bytes", kMaxShaderBytes},
        {"shader with its includes: lines", kMaxShaderLines},
        {"shader: files in a chain of includes", kMaxIncludeDepth},
        {"shader: operators of an expression", kMaxShaderTerms},
        {"shader: elements of an array, where a number says them", kMaxShaderArrayElements},
        {"OpenEXR, PNG, JPEG, Radiance: px of a side", std::uint64_t(exr.max_side_px)},
        {"OpenEXR, PNG, JPEG, Radiance: bytes of a picture in memory", exr.max_image_bytes},
        {"glTF: bytes of a file", scene::kMaxGltfBytes},
        {"scene: objects", scene::kMaxObjects},
        {"scene: lights", scene::kMaxLights},
        {"`render`: bytes of memory for pictures", scene::kMaxJobBytes}};
    const std::string page = read_text(fs::path(AFTERSHADE_SOURCE_DIR) / "docs/reliability.md");
    for (const auto& [input, limit] : limits)
        EXPECT_NE(page.find("| " + input + " | " + std::to_string(limit) + " |\n"), std::string::npos)
            << input << ": " << limit;
}

}  // namespace
}  // namespace aftershade::test
