// Words and documents that are wrong. Every row runs without a usable GL, so that exit code 2 also says that
// no context was asked for.
#include "framework/batch/process_codes.h"
#include "tests/cli/fault_table.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

Fault look(const std::string& what, const std::string& text, std::vector<std::string> messages) {
    return {what,
            {"look.json", "frame.exr", "-o", "out.exr"},
            ExitCode::usage,
            std::move(messages),
            [text](const Workplace& work) { write_text(work / "look.json", text); },
            true};
}

/// A look of these steps, which begin on line 2.
Fault steps(const std::string& what, const std::string& text, std::vector<std::string> messages) {
    return look(what, "{ \"aftershade\": 1, \"steps\": [\n" + text + "\n] }", std::move(messages));
}

std::vector<Fault> look_faults() {
    return {
        {"AMissingLook",
         {"none.json", "frame.exr", "-o", "out.exr"},
         ExitCode::usage,
         {"none\\.json: error: no such file"},
         {},
         true},
        {"AFolderAsLook",
         {".", "frame.exr", "-o", "out.exr"},
         ExitCode::usage,
         {"\\.: error: is not a regular file"},
         {},
         true},
        look("AnEmptyLook", "", {"look\\.json:1:1: error: .*unexpected end of input.*"}),
        look("ASyntaxFault", "{ \"aftershade\": 1,\n  \"steps\": [ { \"effect\": \"bokeh\" }\n}\n",
             {"look\\.json:3:1: error: syntax error while parsing array.*"}),
        look("NestingWithoutEnd", std::string(100'000, '['),
             {"look\\.json:1:65: error: nested deeper than 64 levels"}),
        look("AMissingVersion", R"({ "steps": [ { "effect": "bokeh" } ] })",
             {"look\\.json:1:1: error: the look has no 'aftershade'"}),
        look("AVersionFromTheFuture", R"({ "aftershade": 2, "steps": [ { "effect": "bokeh" } ] })",
             {"look\\.json:1:17: error: document version 2 is not known; this program reads version 1"}),
        look("AListInsteadOfALook", "[]",
             {"look\\.json:1:1: error: the look must be an object, not an array"}),
        look("NoSteps", R"({ "aftershade": 1 })", {"look\\.json:1:1: error: the look has no 'steps'"}),
        look("AnUnknownKeyOfTheLook",
             R"({ "aftershade": 1, "stepps": [], "steps": [ { "effect": "bokeh" } ] })",
             {"look\\.json:1:20: error: the look has no key 'stepps'; did you mean 'steps'\\?"}),
        steps("AnUnknownEffect", R"({ "effect": "boken" })",
              {"look\\.json:2:13: error: no effect 'boken'; did you mean 'bokeh'\\?"}),
        steps(
            "AnEffectOfAnotherFolder", R"({ "effect": "zzyzx" })",
            {"look\\.json:2:13: error: no effect 'zzyzx'; --effect-path names a folder of further effects"}),
        steps("AStepWithoutEffect", R"({ "params": {} })",
              {"look\\.json:2:1: error: the step has no 'effect'"}),
        steps("AnUnknownParameter", R"({ "effect": "bokeh", "params": { "focus_dist": 2 } })",
              {"look\\.json:2:34: error: bokeh has no parameter 'focus_dist'; did you mean "
               "'focus_distance'\\?"}),
        steps("AValueBelowItsMinimum", R"({ "effect": "bokeh", "params": { "f_number": 0.02 } })",
              {"look\\.json:2:46: error: bokeh\\.f_number: 0\\.02 is below the minimum 0\\.05"}),
        steps("AValueAboveItsMaximum", R"({ "effect": "bokeh", "params": { "focal_length": "6 m" } })",
              {"look\\.json:2:50: error: bokeh\\.focal_length: 6000 mm is above the maximum 5000 mm"}),
        steps("AUnitOfAnotherKind", R"({ "effect": "bokeh", "params": { "focus_distance": "3 deg" } })",
              {"look\\.json:2:52: error: bokeh\\.focus_distance: '3 deg' cannot be converted to m; write "
               ".*'m'.*"}),
        steps("AUnitForAPureNumber", R"({ "effect": "bokeh", "params": { "f_number": "2 mm" } })",
              {"look\\.json:2:46: error: bokeh\\.f_number: '2 mm' has a unit, but this is a pure number"}),
        steps("AnUnknownChoice", R"({ "effect": "bokeh", "params": { "shape": "hexagom" } })",
              {"look\\.json:2:43: error: bokeh\\.shape: 'hexagom' is not one of .*; did you mean "
               "'hexagon'\\?"}),
        steps("ANumberTooLargeForADouble", R"({ "effect": "bokeh", "params": { "f_number": 1e999 } })",
              {"look\\.json:2:[0-9]+: error: .*1e999.*"}),
        steps("AnUnknownKeyOfAStep", R"({ "effect": "bokeh", "parms": {} })",
              {"look\\.json:2:22: error: the step has no key 'parms'; did you mean 'params'\\?"}),
        steps("ADuplicateKey", R"({ "effect": "bokeh", "effect": "bokeh" })",
              {"look\\.json:2:22: error: the key 'effect' occurs twice in one object; first at line 2"}),
        steps("TwoStepsOfOneName", R"({ "effect": "bokeh" }, { "effect": "bokeh" })",
              {"look\\.json:2:24: error: a second step named 'bokeh'; give it a 'name' of its own \\(the "
               "first is at look\\.json:.*\\)"}),
        steps("AStepNamedAsAPath", R"({ "effect": "bokeh", "name": "../bokeh" })",
              {"look\\.json:2:30: error: the name '\\.\\./bokeh' must be snake_case.*"}),
        steps("AnUnknownPreset", R"({ "effect": "bokeh", "preset": "fats" })",
              {"look\\.json:2:32: error: bokeh has no preset 'fats'; did you mean 'fast'\\?"}),
        steps("ColorReadAfterDisplay", R"({ "effect": "view_transform" }, { "effect": "bokeh" })",
              {"look\\.json:2:33: error: step 'bokeh' reads color after a step has made display; put it "
               "before"}),
        steps("ColorOfTheCaptureReadAfterDisplay",
              R"({ "effect": "view_transform" }, { "effect": "bokeh", "in": { "color": "capture.color" } })",
              {"look\\.json:2:33: error: step 'bokeh' reads color after a step has made display; put it "
               "before"}),
        steps("WiringFromALaterStep",
              R"({ "effect": "bokeh", "in": { "color": "lens.color" } },
                  { "effect": "bokeh", "name": "lens" })",
              {"look\\.json:2:39: error: no step 'lens' before 'bokeh'; a step reads outputs of earlier "
               "steps only"}),
        steps("WiringFromItself", R"({ "effect": "bokeh", "in": { "color": "bokeh.color" } })",
              {"look\\.json:2:39: error: no step 'bokeh' before 'bokeh'; a step reads outputs of earlier "
               "steps only"}),
        steps("WiringOfAnUnknownInput", R"({ "effect": "bokeh", "in": { "colour": "capture.color" } })",
              {"look\\.json:2:40: error: bokeh has no input 'colour'; did you mean 'color'\\?"}),
        steps("WiringOfAnotherRole", R"({ "effect": "bokeh", "in": { "depth": "capture.color" } })",
              {"look\\.json:2:39: error: input 'depth' of bokeh takes the role 'depth' "
               "\\(.*effect\\.json:\\d+:\\d+\\), not 'color'.*"}),
        steps("WiringWithoutADot", R"({ "effect": "bokeh", "in": { "depth": "capture" } })",
              {"look\\.json:2:39: error: 'depth' comes from \"capture\\.<role>\", \"<step>\\.<output>\" or "
               "\"<step>\\.<texture>\""}),
        steps(
            "SeveralFaultsAtOnce",
            "{ \"effect\": \"bokeh\", \"params\": { \"f_number\": 0, \"taps\": 2.5, \"shap\": \"disk\" } },\n"
            "{ \"effect\": \"blom\", \"name\": \"glow\" },\n"
            "{ \"effect\": \"bokeh\", \"colour\": 1, \"in\": { \"color\": \"glow.color\" } }",
            {"look\\.json:4:22: error: the step has no key 'colour'.*",
             "look\\.json:4:1: error: a second step named 'bokeh'.*",
             "look\\.json:2:46: error: bokeh\\.f_number: 0 is below the minimum 0\\.05",
             "look\\.json:2:57: error: bokeh\\.taps: 2\\.5 is not a whole number",
             "look\\.json:2:62: error: bokeh has no parameter 'shap'; did you mean 'shape'\\?",
             "look\\.json:3:13: error: no effect 'blom'.*"}),
    };
}

Fault words(const std::string& what, std::vector<std::string> more, const std::string& message,
            std::function<void(const Workplace&)> prepare = {}) {
    std::vector<std::string> arguments{"bokeh.json", "frame.exr"};
    if (std::find(more.begin(), more.end(), "-o") == more.end()) more.insert(more.begin(), {"-o", "out.exr"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {what, arguments, ExitCode::usage, {message}, std::move(prepare), true};
}

std::vector<Fault> word_faults() {
    return {
        words("ASetWithoutValue", {"--set", "bokeh.taps"},
              "--set bokeh\\.taps: error: expected step\\.param=value.*"),
        words("ASetWithoutDot", {"--set", "taps=3"}, "--set taps=3: error: expected step\\.param=value.*"),
        words("ASetOfAnUnknownStep", {"--set", "boken.taps=3"},
              "--set boken\\.taps=3: error: the look has no step 'boken'; did you mean 'bokeh'\\?"),
        words("ASetOfAnUnknownParameter", {"--set", "bokeh.tap=3"},
              "--set bokeh\\.tap=3: error: bokeh has no parameter 'tap'; did you mean 'taps'\\?"),
        words("ASetBelowTheMinimum", {"--set", "bokeh.f_number=0.01"},
              "--set bokeh\\.f_number=0\\.01: error: bokeh\\.f_number: 0\\.01 is below the minimum 0\\.05"),
        words("ASetOfTheWrongType", {"--set", "bokeh.taps=many"},
              "--set bokeh\\.taps=many: error: bokeh\\.taps: .*"),
        words("ASetOfNotANumber", {"--set", "bokeh.focus_distance=nan m"},
              "--set bokeh\\.focus_distance=nan m: error: bokeh\\.focus_distance: 'nan m' is not a number in "
              "m.*"),
        words("ATapWithoutDot", {"--tap", "bokeh"}, "--tap bokeh: error: expected step\\.texture.*"),
        words("ATapOfAnUnknownStep", {"--tap", "blur.coc"},
              "--tap blur\\.coc: error: the look has no step 'blur'.*"),
        words("ATapOfAnUnknownTexture", {"--tap", "bokeh.coe"},
              "--tap bokeh\\.coe: error: bokeh has no texture 'coe'; did you mean 'coc'\\? \\(known: .*\\)"),
        words(
            "ATapIntoAnUnknownFormat", {"--tap", "bokeh.coc=coc.tif"},
            "--tap bokeh\\.coc=coc\\.tif: error: the format '\\.tif' is not known; outputs end in \\.exr or "
            "\\.png"),
        words("ATapIntoTheOutput", {"--tap", "bokeh.coc=out.exr"},
              "--tap bokeh\\.coc=out\\.exr: error: another output has this name"),
        words("TelemetryThatIsNoJson", {"--telemetry", "told.csv"},
              "--telemetry told\\.csv: error: the format '\\.csv' is not known; telemetry ends in \\.json"),
        words("ATelemetryPlotThatIsNoSvg", {"--telemetry-plot", "told.png"},
              "--telemetry-plot told\\.png: error: must end in \\.svg"),
        words("AnUnknownProfile", {"--profile", "blendr"},
              "--profile blendr: error: no profile 'blendr'; did you mean 'blender'\\? \\(known: "
              ".*'native'.*\\)"),
        words("AnUnknownExtension", {"-o", "out.tif"},
              "-o out\\.tif: error: the format '\\.tif' is not known; outputs end in \\.exr or \\.png"),
        words("AnOutputWithoutExtension", {"-o", "out"}, "-o out: error: the format '' is not known.*"),
        words("AnOutputThatIsTheInput", {"-o", "frame.exr"},
              "-o frame\\.exr: error: would replace the input frame\\.exr"),
        words("AnOutputThatIsTheInputThroughALink", {"-o", "link/frame.exr"},
              "-o link/frame\\.exr: error: would replace the input frame\\.exr",
              [](const Workplace& work) { fs::create_directory_symlink(".", work / "link"); }),
        words("AnOutputNamedTwice", {"-o", "out.exr", "-o", "out.exr"},
              "-o out\\.exr: error: another output has this name"),
        words("AnUnknownOutputRole", {"--output-roles", "color,dept"},
              "--output-roles dept: error: not a role; did you mean 'depth'\\?"),
        words("ARoleNamedTwice", {"--output-roles", "color,color"},
              "--output-roles color: error: this role is named twice"),
        words("ABadFrameRange", {"--frames", "1..x"},
              "--frames 1\\.\\.x: error: not a frame range such as .*"),
        words("AFrameRangeThatIsTooLong", {"--frames", "1-1000000000"},
              "--frames 1-1000000000: error: too long: a range names at most 1000000 frames.*"),
        words("AFrameThatTheCaptureLacks", {"--frames", "7"},
              "--frames 7: error: the capture has no frame 7"),
        words("AMissingEffectFolder", {"--effect-path", "none"}, "--effect-path none: error: no such folder"),
        words(
            "AnUnknownBackend", {"--backend", "vulkan"},
            "aftershade: error: --backend: 'vulkan' is not one of auto, egl, software, egl-software, osmesa"),
        words("AnUnknownOption", {"--fast"}, ".*--fast.*"),
        words("AnUnknownPixelType", {"--pixel-type", "double"}, "--pixel-type: .*double.*"),
        words("AMaxSizeOfZero", {"--max-size", "0"}, "--max-size: .*"),
        {"SeveralFramesForOneFile",
         {"bokeh.json", "seq_####.exr", "-o", "out.png"},
         ExitCode::usage,
         {"-o out\\.png: error: 3 frames cannot share one file; write the number as #### or %04d"},
         {},
         true},
        {"AnOutputPatternThatIsTheInputs",
         {"bokeh.json", "seq_####.exr", "-o", "seq_%04d.exr"},
         ExitCode::usage,
         {"-o seq_%04d\\.exr: error: would replace the input seq_0001\\.exr"},
         {},
         true},
        {"NoOutput", {"bokeh.json", "frame.exr"}, ExitCode::usage, {".*--output is required"}, {}, true},
        {"AnUnknownProfileOfACaptureDocument",
         {"bokeh.json", "capture.json", "-o", "out_####.exr"},
         ExitCode::usage,
         {"capture\\.json: error: no profile 'maya' \\(known: .*"},
         [](const Workplace& work) {
             write_text(work / "capture.json",
                        R"({ "aftershade": 1, "frames": "seq_####.exr", "profile": "maya" })");
         },
         true},
        {"ACaptureDocumentWithFaults",
         {"bokeh.json", "capture.json", "-o", "out_####.exr"},
         ExitCode::usage,
         {"capture\\.json:1:55: error: '1-' is not a frame range such as .*",
          "capture\\.json:1:89: error: camera\\.focal_length: .*",
          "capture\\.json:1:99: error: the capture has no key 'fsp'.*"},
         [](const Workplace& work) {
             write_text(work / "capture.json",
                        R"({ "aftershade": 1, "frames": "seq_####.exr", "range": "1-", "camera": )"
                        R"({ "focal_length": "50 s" }, "fsp": 24 })");
         },
         true},
        {"AWrongLookForAMissingCapture",
         {"look.json", "nowhere_####.exr", "-o", "out.tif"},
         ExitCode::usage,
         {"look\\.json:1:43: error: no effect 'boken'.*",
          "CAPTURE: error: nowhere_####\\.exr: no file fits .*", "-o out\\.tif: error: the format .*"},
         [](const Workplace& work) {
             write_text(work / "look.json", R"({ "aftershade": 1, "steps": [ { "effect": "boken" } ] })");
         },
         true},
    };
}

class LookFault : public FaultTest {};
TEST_P(LookFault, IsReportedBeforeAnyWorkStarts) {
    check();
}
INSTANTIATE_TEST_SUITE_P(Of, LookFault, testing::ValuesIn(look_faults()), fault_name);

class WordFault : public FaultTest {};
TEST_P(WordFault, IsReportedBeforeAnyWorkStarts) {
    check();
}
INSTANTIATE_TEST_SUITE_P(Of, WordFault, testing::ValuesIn(word_faults()), fault_name);

TEST(WordFaults, ABackendOfTheEnvironmentIsToldOfByItsName) {
    const Workplace work;
    const CommandResult result = run_aftershade({"run", "view.json", "frame.exr", "-o", "out.exr"},
                                                work.path(), {{"AFTERSHADE_BACKEND", "glx"}});
    EXPECT_EQ(result.exit_code, int(ExitCode::usage));
    EXPECT_NE(result.err.find("AFTERSHADE_BACKEND: 'glx' is not one of"), std::string::npos) << result.err;
}

TEST(WordFaults, ADisabledStepIsNamedAsSuch) {
    const Workplace work;
    write_text(work / "look.json",
               R"({ "aftershade": 1, "steps": [ { "effect": "bokeh", "enabled": false } ] })");
    const CommandResult result = run_aftershade(
        {"run", "look.json", "frame.exr", "-o", "out.exr", "--set", "bokeh.taps=9", "--tap", "bokeh.coc"},
        work.path());
    EXPECT_EQ(result.exit_code, int(ExitCode::usage));
    EXPECT_EQ(told(result),
              (std::vector<std::string>{
                  "--set bokeh.taps=9: error: the step 'bokeh' is disabled; remove its \"enabled\": false",
                  "--tap bokeh.coc: error: the step 'bokeh' is disabled; remove its \"enabled\": false"}));
}

TEST(WordFaults, NoVerbAndAnUnknownVerbAreUsage) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_aftershade({}, folder.path()).exit_code, int(ExitCode::usage));
    EXPECT_EQ(run_aftershade({"rum"}, folder.path()).exit_code, int(ExitCode::usage));
    EXPECT_EQ(run_aftershade({"--version"}, folder.path()).exit_code, 0);
    EXPECT_EQ(run_aftershade({"run", "--help"}, folder.path()).exit_code, 0);
}

}  // namespace
}  // namespace aftershade::test
