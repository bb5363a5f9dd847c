#include "framework/golden/golden_suite.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "framework/golden/approved_image.h"
#include "framework/golden/bound_case.h"
#include "framework/golden/capture_hash.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Suite : public testing::Test {
protected:
    std::optional<GoldenSuite> read(const std::string& text) {
        write_text(folder_ / "golden.json", text);
        Diagnostics diagnostics;
        auto suite = read_golden_suite(folder_.path().string(), diagnostics);
        std::ostringstream out;
        diagnostics.print(out);
        faults_ = out.str();
        return suite;
    }
    TemporaryFolder folder_;
    std::string faults_;
};

const char* const kTwoCases = R"({ "aftershade": 1, "goldens": "approved", "cases": [
    { "name": "a", "steps": [], "capture": "in/capture.json", "frames": "1-2", "tags": ["fast", "hdr"] },
    { "name": "b_wide", "steps": [], "capture": "/abs/capture.json", "frames": "1", "taps": ["x.y"], "skip": "later" } ] })";

TEST_F(Suite, NamesPathsFromItsFolder) {
    const auto suite = read(kTwoCases);
    ASSERT_TRUE(suite) << faults_;
    EXPECT_EQ(suite->cases[0].capture, folder_ / "in/capture.json");
    EXPECT_EQ(suite->cases[1].capture, "/abs/capture.json");
    EXPECT_EQ(suite->cases[1].goldens, folder_ / "approved");
    EXPECT_EQ(suite->cases[1].skip, "later");
}

TEST_F(Suite, TellsAllFaultsAtOnce) {
    EXPECT_FALSE(read(R"({ "aftershade": 1, "golden": "x", "effect_paths": ["nowhere"], "cases": [
        { "name": "a.b", "look": "none.json", "capture": "c.json" },
        { "name": "b", "look": "golden.json", "steps": [], "capture": "c.json", "frames": "x", "skip": "" },
        { "name": "b", "steps": [ { "effect": "x", "preste": 1 } ], "capture": "c.json", "taps": ["y"] } ],
        "cases_of_effects": "yes" })"));
    for (const char* part :
         {"'golden'; did you mean 'goldens'", "no folder", "not 'a.b'", "none.json'", "one of both",
          "'x' is not a range", "'skip' says why", "a second case named 'b'",
          "golden.json:3:", "'preste'; did you mean 'preset'", "'y' is not 'step.texture'",
          "'cases_of_effects' must be true or false, not a string"})
        EXPECT_NE(faults_.find(part), std::string::npos) << part << " in\n" << faults_;
}

TEST_F(Suite, RefusesATagThatIsTheNameOfAnotherCase) {
    const auto text = [](const std::string& tag) {
        return R"({ "aftershade": 1, "cases": [ { "name": "a", "steps": [], "capture": "c", "tags": ["a", "fast"] },
            { "name": "b", "steps": [], "capture": "c", "tags": [")" +
               tag + R"("] } ] })";
    };
    EXPECT_FALSE(read(text("a")));
    EXPECT_NE(faults_.find("case 'b' has the tag 'a', which is the name of a case"), std::string::npos)
        << faults_;
    EXPECT_TRUE(read(text("fast"))) << faults_;
}

TEST_F(Suite, NeedsCases) {
    EXPECT_FALSE(read(R"({ "aftershade": 1 })"));
    EXPECT_NE(faults_.find("needs 'cases'"), std::string::npos);
}

TEST_F(Suite, FiltersByGlobAndByTag) {
    const auto suite = read(kTwoCases);
    ASSERT_TRUE(suite) << faults_;
    const auto fits = [&](const std::vector<std::string>& filters) {
        std::string names;
        for (const GoldenCase& test : suite->cases)
            if (fits_filter(test, filters)) names += test.name + " ";
        return names;
    };
    EXPECT_EQ(fits({}), "a b_wide ");
    EXPECT_EQ(fits({"b*"}), "b_wide ");
    EXPECT_EQ(fits({"hdr"}), "a ");
    EXPECT_EQ(fits({"hd"}), "") << "a tag is a word";
    EXPECT_EQ(fits({"hdr", "b?wide"}), "a b_wide ");
}

TEST_F(Suite, FindsGoldensThatNoCaseGives) {
    const auto suite = read(kTwoCases);
    ASSERT_TRUE(suite) << faults_;
    fs::create_directory(folder_ / "approved");
    for (const char* name : {"a.color.0001.exr", "a.color.0001@llvmpipe-1.exr", "a.color.0001.json",
                             "b_wide.x.y.0001.exr", ".a.color.0001.exr.12-0.tmp", "notes.txt"})
        write_text(folder_ / "approved" / name, "");
    EXPECT_EQ(orphaned_goldens(*suite, {}), std::vector<fs::path>{});
    const std::vector<std::string> orphans = {"a.color.0003.exr", "a.depth.0001.exr", "a.depth.0001@x.json",
                                              "gone.color.0001.exr"};
    std::vector<fs::path> expected, of_a;
    for (const std::string& name : orphans) {
        write_text(folder_ / "approved" / name, "");
        expected.push_back(folder_ / "approved" / name);
        if (name.starts_with("a.")) of_a.push_back(expected.back());
    }
    EXPECT_EQ(orphaned_goldens(*suite, {}), expected);
    EXPECT_EQ(orphaned_goldens(*suite, {"a"}), of_a) << "with a filter those of its cases";
}

// ---- environments and approved images ----

const GoldenEnvironment kHere = {
    "osmesa",         "llvmpipe (LLVM 15.0.6, 256 bits)", "4.5 (Core Profile) Mesa 22.3.6", "AMD EPYC", true,
    "x86-64 with FMA"};

TEST(GoldenEnvironment, IsOneByRendererMesaAndInstructions) {
    EXPECT_EQ(kHere.mesa(), "22.3.6");
    EXPECT_EQ(kHere.llvm(), "15.0.6");
    EXPECT_EQ(kHere.key(), "llvmpipe-22.3.6-x86-64-with-fma");
    GoldenEnvironment other = kHere;
    other.backend = "egl-software";
    EXPECT_TRUE(kHere.equals(other)) << "both draw by the same code";
    other.cpu = "Intel Xeon";
    other.renderer = "llvmpipe (LLVM 15.0.6, 128 bits)";
    EXPECT_TRUE(kHere.equals(other)) << "neither the maker nor the width of the vectors decides a bit";
    EXPECT_EQ(kHere.key(), other.key());
    const auto changed = [](std::string GoldenEnvironment::*field, const std::string& value) {
        GoldenEnvironment environment = kHere;
        environment.*field = value;
        EXPECT_NE(environment.key(), kHere.key());
        return environment.difference(kHere);
    };
    EXPECT_EQ(changed(&GoldenEnvironment::version, "4.5 (Core Profile) Mesa 25.0.7-2"),
              "Mesa 25.0.7-2 instead of 22.3.6");
    EXPECT_EQ(changed(&GoldenEnvironment::renderer, "softpipe"), "the renderer softpipe instead of llvmpipe");
    EXPECT_EQ(changed(&GoldenEnvironment::instructions, "x86-64 without FMA"),
              "the processor is x86-64 without FMA instead of x86-64 with FMA");
    other = kHere;
    other.renderer = "llvmpipe (LLVM 19.1.7, 256 bits)";
    EXPECT_EQ(other.difference(kHere), "LLVM 19.1.7 instead of 15.0.6");
}

TEST(GoldenEnvironment, OfOldFormIsOneByItsProcessor) {
    GoldenEnvironment old = kHere;
    old.instructions.clear();
    EXPECT_TRUE(kHere.equals(old));
    old.cpu = "Intel Xeon";
    EXPECT_EQ(kHere.difference(old), "the processor AMD EPYC instead of Intel Xeon");
    GoldenEnvironment limited = kHere;
    limited.instructions = "x86-64 without FMA";
    EXPECT_EQ(limited.difference(old), "one processor is without FMA");
    old.cpu = limited.cpu;
    EXPECT_FALSE(limited.equals(old)) << "a virtual machine's name says little";
}

TEST(GoldenEnvironment, OfHardwareIsOneByItsDriver) {
    const GoldenEnvironment card = {"egl", "NVIDIA H100", "4.6.0 NVIDIA 580.159", "AMD EPYC", false, ""};
    GoldenEnvironment other = card;
    other.cpu = "Intel Xeon";
    EXPECT_TRUE(card.equals(other));
    other.version = "4.6.0 NVIDIA 570.1";
    EXPECT_EQ(card.difference(other), "the driver 4.6.0 NVIDIA 580.159 instead of 4.6.0 NVIDIA 570.1");
}

TEST(ApprovedImages, ComeWithTheOwnRenderersFirst) {
    TemporaryFolder folder;
    GoldenEnvironment intel = kHere;
    intel.cpu = "Intel Xeon";
    intel.instructions = "x86-64 without FMA";
    const auto approve = [&](const std::string& name, const GoldenEnvironment& environment) {
        write_text(folder / (name + ".exr"), name);
        GoldenSidecar sidecar{environment,
                              "aftershade golden approve x",
                              {"hash", "files", "0.1.0"},
                              file_hash(folder / (name + ".exr"))};
        write_text(folder / (name + ".json"), sidecar_text(sidecar));
    };
    approve("a.color.0001", intel);
    approve("a.color.0001@zzz", kHere);
    approve("a.color.0001@aaa", intel);
    approve("a.color.0002", kHere);
    const auto images = approved_images(folder.path(), "a.color.0001", kHere);
    ASSERT_EQ(images.size(), 3u);
    EXPECT_EQ(images[0].key, "zzz");
    EXPECT_EQ(images[1].key, "");
    EXPECT_EQ(images[2].key, "aaa");
    ASSERT_TRUE(images[0].sidecar);
    EXPECT_EQ(images[0].sidecar->sources.look, "hash");
    EXPECT_EQ(images[0].sidecar->sources.capture, "files");
    EXPECT_EQ(images[0].sidecar->environment.cpu, "AMD EPYC");
    EXPECT_TRUE(images[0].sidecar->environment.software);

    write_text(folder / "a.color.0001@zzz.exr", "other");
    const auto changed = approved_images(folder.path(), "a.color.0001", kHere);
    EXPECT_EQ(changed[0].key, "") << "a sidecar of another image says nothing";
    EXPECT_FALSE(changed[2].sidecar);
}

TEST(ApprovedImages, KnowSidecarsOfOldForm) {
    TemporaryFolder folder;
    write_text(folder / "a.color.0001.exr", "x");
    write_text(folder / "a.color.0001.json", R"json({ "backend": "egl-software",
        "renderer": "llvmpipe (LLVM 15.0.6, 256 bits)", "version": "4.5 (Core Profile) Mesa 22.3.6",
        "cpu": "AMD EPYC" })json");
    const auto images = approved_images(folder.path(), "a.color.0001", kHere);
    ASSERT_TRUE(images.at(0).sidecar);
    EXPECT_TRUE(images[0].sidecar->environment.equals(kHere));
    EXPECT_TRUE(images[0].sidecar->environment.software);
    EXPECT_EQ(images[0].sidecar->sources.look, "");
}

TEST(CaptureHash, ChangesWithFramesNeighboursAndDocumentAndIsNoneOfAPipe) {
    TemporaryFolder folder;
    for (const char* frame : {"f_0001.exr", "f_0004.exr", "f_0005.exr"}) write_text(folder / frame, frame);
    GoldenCase test;
    test.capture = (folder / "f_####.exr").string();
    test.frames = "1";
    const auto hash = [&] { return CaptureHasher().hash(test); };
    const std::string before = hash();
    EXPECT_EQ(before.size(), 32u);
    write_text(folder / "f_0005.exr", "four frames away");
    EXPECT_EQ(hash(), before);
    write_text(folder / "f_0004.exr", "three frames away");
    EXPECT_NE(hash(), before) << "effects may read it";
    fs::remove(folder / "f_0004.exr");
    const std::string alone = hash();
    EXPECT_NE(alone, before) << "absent is not empty";
    write_text(folder / "f_0001.exr", "another picture");
    EXPECT_NE(hash(), alone);
    write_text(folder / "capture.json",
               R"({ "aftershade": 1, "frames": "f_####.exr", "range": "1-5", "profile": "blender" })");
    test.capture = folder / "capture.json";
    const std::string documented = hash();
    EXPECT_NE(documented, alone);
    write_text(folder / "capture.json",
               R"({ "aftershade": 1, "frames": "f_####.exr", "range": "1-5", "profile": "native" })");
    EXPECT_NE(hash(), documented);
    fs::remove(folder / "f_0001.exr");
    ASSERT_EQ(mkfifo((folder / "f_0001.exr").c_str(), 0600), 0);
    EXPECT_EQ(hash(), "") << "and does not wait for its writer";
}

TEST(CaptureHash, ChangesWithTheFirstFrameWhichDecidesHowAllAreRead) {
    TemporaryFolder folder;
    for (const char* frame : {"f_0001.exr", "f_0002.exr", "f_0090.exr"}) write_text(folder / frame, frame);
    GoldenCase test;
    test.capture = (folder / "f_####.exr").string();
    test.frames = "90";
    const std::string before = CaptureHasher().hash(test);
    write_text(folder / "f_0002.exr", "another picture");
    EXPECT_EQ(CaptureHasher().hash(test), before);
    write_text(folder / "f_0001.exr", "another picture");
    EXPECT_NE(CaptureHasher().hash(test), before);
}

TEST(LookHash, ChangesWithTheLookItsManifestAndEveryShaderAndWithNothingElse) {
    TemporaryFolder folder;
    fs::create_directories(folder / "effects/tint/cases");
    fs::create_directories(folder / "glsl");
    write_text(folder / "glsl/shared.glsl", "float one() { return 1; }\n");
    write_text(folder / "effects/tint/own.glsl", "float two() { return 2; }\n");
    write_text(folder / "effects/tint/tint.frag",
               "#version 450 core\n#include <pass>\n#include <shared.glsl>\n#include \"own.glsl\"\nvoid "
               "main() {}\n");
    const std::string manifest = R"({"aftershade": 1, "id": "tint", "version": "1.0.0", "summary": "A tint.",
        "inputs": {"color": {"role": "color"}}, "outputs": {"color": {"role": "color"}},
        "passes": [{"name": "main", "shader": "tint.frag", "reads": ["color"], "writes": ["color"]}]})";
    write_text(folder / "effects/tint/effect.json", manifest);
    GoldenCase test;
    test.file = folder / "golden.json";
    test.steps = R"({"aftershade": 1, "steps": [ {"effect": "tint"} ]})";
    const auto hash = [&] { return LookHasher({folder / "effects"}, folder / "glsl").hash(test); };
    const std::string before = hash();
    EXPECT_EQ(before.size(), 16u);
    for (const char* file : {"effects/tint/effect.json", "effects/tint/tint.frag", "effects/tint/own.glsl",
                             "glsl/shared.glsl"}) {
        const std::string text = read_text(folder / file);
        write_text(folder / file, text + "\n");
        EXPECT_NE(hash(), before) << file;
        write_text(folder / file, text);
        EXPECT_EQ(hash(), before) << file;
    }
    test.sets = {"tint.mix=0.5"};
    EXPECT_NE(hash(), before);
    test.sets.clear();
    test.tags = {"fast"};
    write_text(folder / "glsl/unused.glsl", "");
    write_text(folder / "effects/tint/cases/x.json", "");
    EXPECT_EQ(hash(), before);
    test.steps = R"({"aftershade": 1, "steps": [ {"effect": "none"} ]})";
    EXPECT_EQ(hash(), "");
    test.steps = R"({"aftershade": 1, "steps": [ {"effect": "tint", "params": {"no": 1}} ]})";
    EXPECT_EQ(hash(), "");
}

/// An effect with files of its own, and a look that names others in every way there is.
class LookWithFiles : public testing::Test {
protected:
    LookWithFiles() {
        fs::create_directories(folder_ / "effects/graded");
        fs::create_directories(folder_ / "glsl");
        fs::create_directories(folder_ / "profiles/scattering");
        setenv("AFTERSHADE_DATA", folder_.path().c_str(), 1);
        write_text(folder_ / "effects/graded/graded.frag",
                   "#version 450 core\n#include <pass>\nvoid main() {}\n");
        write_text(folder_ / "effects/graded/effect.json",
                   R"({"aftershade": 1, "id": "graded", "version": "1.0.0", "summary": "A grade.",
            "inputs": {"color": {"role": "color"}}, "outputs": {"color": {"role": "color"}},
            "params": {
                "first": {"type": "file", "kind": "lut", "default": "default.cube", "doc": "."},
                "second": {"type": "file", "kind": "lut", "default": "", "doc": "."},
                "third": {"type": "file", "kind": "lut", "default": "", "doc": "."},
                "fourth": {"type": "file", "kind": "image", "default": "", "doc": "."},
                "unused": {"type": "file", "kind": "lut", "default": "unused.cube", "doc": "."},
                "scattering": {"type": "scattering_profile", "default": "wax", "doc": "."}},
            "presets": {"own": {"second": "preset.cube"}},
            "passes": [{"name": "main", "shader": "graded.frag", "reads": ["color"],
                        "writes": ["color"]}]})");
        for (const char* file :
             {"effects/graded/default.cube", "effects/graded/preset.cube", "effects/graded/unused.cube",
              "key_1.cube", "key_2.cube", "set.exr", "replaced.cube", "mask.png", "note.txt"})
            write_text(folder_ / file, file);
        for (const char* file : kProfiles) write_text(folder_ / file, profile("0.5", "A wax."));
        write_text(folder_ / "look.json",
                   R"({"aftershade": 1, "steps": [ {"effect": "graded", "preset": "own",
            "mask": {"file": "mask.png"}, "params": {
                "third": {"keys": {"1": "key_1.cube", "2": "key_2.cube"}}, "fourth": "replaced.cube",
                "unused": "",
                "scattering": {"default": "usual.json", "rows": [
                    {"object": 3, "profile": "row.json"}, {"object": 4, "profile": "wax"}]}}} ]})");
        test_.look = folder_ / "look.json";
        test_.sets = {"graded.fourth=" + (folder_ / "set.exr").string()};
    }
    ~LookWithFiles() override { unsetenv("AFTERSHADE_DATA"); }
    static constexpr const char* kProfiles[] = {"usual.json", "row.json", "profiles/scattering/wax.json"};
    static std::string profile(const std::string& d_mm, const std::string& summary) {
        return R"({"aftershade": 1, "type": "burley", "d_mm": [1, 1, )" + d_mm + R"(], "summary": ")" +
               summary + "\"}";
    }
    std::string hash() const { return LookHasher({folder_ / "effects"}, folder_ / "glsl").hash(test_); }

    TemporaryFolder folder_;
    GoldenCase test_;
};

TEST_F(LookWithFiles, HasAnotherHashWithEachOfThemAndWithNoOther) {
    const std::string before = hash();
    ASSERT_EQ(before.size(), 16u);
    for (const char* file : {"effects/graded/default.cube", "effects/graded/preset.cube", "key_1.cube",
                             "key_2.cube", "set.exr", "mask.png"}) {
        write_text(folder_ / file, std::string(file) + " ");
        EXPECT_NE(hash(), before) << file;
        write_text(folder_ / file, file);
        EXPECT_EQ(hash(), before) << file;
    }
    for (const char* file : {"effects/graded/unused.cube", "replaced.cube", "note.txt"}) {
        write_text(folder_ / file, "another");
        EXPECT_EQ(hash(), before) << file;
    }
}

TEST_F(LookWithFiles, HasAnotherHashWithWhatItsScatteringProfilesSay) {
    const std::string before = hash();
    ASSERT_EQ(before.size(), 16u);
    for (const char* file : kProfiles) {
        write_text(folder_ / file, profile("0.5000001", "A wax."));
        EXPECT_NE(hash(), before) << file;
        write_text(folder_ / file, profile("0.5", "A wax, or a cheese."));
        EXPECT_EQ(hash(), before) << "what it says of itself draws nothing";
    }
}

TEST_F(LookWithFiles, HasNoHashWithoutThem) {
    fs::remove(folder_ / "effects/graded/default.cube");
    EXPECT_EQ(hash(), "");
}

}  // namespace
}  // namespace aftershade::test
