// Links, pipes and devices that somebody put where a verb reads or writes beside the user's own files.
// Nothing that they lead to is changed, and nothing of it is read. What the user names may be a link.
#include <sys/stat.h>
#include <unistd.h>

#include "framework/run/run_state.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kMark = "OF-ANOTHER-FOLDER";

enum class To { file, image, absent, folder, second_name, pipe, zero };

struct Planting {
    std::string place;
    To to;
    std::vector<std::string> words;
    Environment environment = {};
    bool says = true;  ///< a refusal with the link and the remedy
};

std::vector<std::string> run_words(std::vector<std::string> more = {}) {
    std::vector<std::string> words{"run",    "trail.json", "in_####.exr",  "-o", "out/out_####.exr",
                                   "--tap",  "trail.kept", "--checkpoint", "1",  "--effect-path",
                                   "effects"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

const std::vector<Planting>& plantings() {
    const RunState state = run_state("out/out_####.exr");
    const std::string lock = "out/" + state.lock(), history = "out/" + state.checkpoints();
    const std::vector<std::string> run = run_words(), jobs = run_words({"--jobs", "2", "--warmup", "1"});
    const std::vector<std::string> approve{"golden", "approve", "suite"};
    const std::vector<std::string> golden{"golden", "run", "suite", "--report", "report"};
    const std::vector<std::string> page{"golden", "report", "report"};
    const std::vector<std::string> submit{"submit",      "--to", "parallel",       "trail.json",
                                          "in_####.exr", "-o",   "out/f_####.exr", "--folder",
                                          "job",         "--",   "--effect-path",  "effects"};
    const std::vector<std::string> docs{"docs", "-o", "pages/effects"}, man{"docs", "--man", "pages/effects"};
    const std::vector<std::string> render{"render", "scene.json", "-o",    "rendered", "--frames",
                                          "1",      "--size",     "32x18", "--quiet"};
    const std::vector<std::string> one = run_words({"--frames", "1"});
    const Environment fresh{{"AFTERSHADE_CACHE", "fresh"}};
    const Environment home{{"AFTERSHADE_CACHE", ""}, {"XDG_CACHE_HOME", ""}, {"HOME", "home"}};
    static const std::vector<Planting> all{
        {"out/.aftershade", To::folder, run},
        {"out/.aftershade", To::absent, run},
        {"out/.aftershade", To::folder, jobs},
        {"out/.aftershade", To::folder, run_words({"--dry-run"})},
        {"out/.aftershade/journal.jsonl", To::file, run},
        {"out/.aftershade/journal.jsonl", To::absent, run},
        {"out/.aftershade/journal.jsonl", To::second_name, run},
        {"out/.aftershade/journal.jsonl", To::pipe, run},
        {"out/.aftershade/journal.jsonl", To::zero, run},
        {"out/.aftershade/journal.jsonl", To::file, jobs},
        {lock, To::file, run},
        {lock, To::absent, run},
        {lock, To::second_name, run},
        {lock, To::pipe, run},
        {lock, To::zero, run},
        {lock, To::file, jobs},
        {"out/.aftershade/history", To::folder, run},
        {history, To::folder, run},
        {history, To::absent, run},
        {history + "/0001.history", To::file, run},
        {history + "/0001.history", To::absent, run},
        {"out/out.trail.kept.0001.exr", To::file, run},
        {"out/out.trail.kept.0001.exr", To::absent, run},
        {"suite/goldens", To::folder, approve},
        {"suite/goldens/box.color.0001.exr", To::image, approve},
        {"suite/goldens/box.color.0001.exr", To::absent, approve},
        {"suite/goldens/box.color.0001.exr", To::image, golden},
        {"suite/goldens/box.color.0001.json", To::file, approve},
        {"suite/goldens/box.color.0001.json", To::absent, approve},
        {"suite/goldens/box.color.0001.json", To::file, golden},
        {"suite/goldens/box.color.0001.json", To::zero, golden},
        {"effects/trail/cases/extra.json", To::file, golden},
        {"effects/trail/main.frag", To::file, run},
        {"report/report.json", To::absent, page},
        {"report/report.json", To::file, page},
        {"report/index.html", To::file, page},
        {"report/images", To::folder, golden},
        {"report/images/.pictures", To::file, golden},
        {"report/images/.pictures", To::absent, golden},
        {"report/images/box.color.0001.test.exr", To::file, golden},
        {"report/images/box.color.0001.test.exr", To::absent, golden},
        {"report/images/box.color.0001.test.png", To::image, page, {}, false},  // the page says so
        {"shot.json", To::file, {"inspect", "matte.exr", "--cryptomatte"}},
        {"shot.json", To::zero, {"inspect", "matte.exr", "--cryptomatte"}},
        {"reports/0002.json", To::file, {"merge", "reports", "-o", "merged.json"}},
        // A job's folder must be empty.
        {"job/reports", To::folder, submit, {}, false},
        {"job/logs", To::absent, submit, {}, false},
        {"job/task.sh", To::file, submit, {}, false},
        {"pages/effects/bloom.md", To::file, docs},
        {"pages/effects/README.md", To::absent, docs},
        {"pages/effects/aftershade-run.1", To::file, man},
        {"rendered/capture.json", To::file, render},
        {"rendered/gbuffer_0001.exr", To::absent, render},
        {"cache",
         To::file,
         run_words({"--frames", "1"}),
         {{"AFTERSHADE_CACHE", "cache"}},
         false},  // compiles again
        {"fresh/mesa_shader_cache", To::folder, one, fresh, false},
        {"fresh/mesa_shader_cache", To::folder, {"doctor", "--json"}, fresh, false},
        {"fresh/mesa_shader_cache/index", To::file, one, fresh, false},
        {"fresh/mesa_shader_cache/index", To::absent, one, fresh, false},
        {"fresh/mesa_shader_cache/index", To::second_name, one, fresh, false},
        {"fresh/mesa_shader_cache/index", To::pipe, one, fresh, false},
        {"fresh/mesa_shader_cache/part0/mesa_cache.db", To::file, one, fresh, false},
        {"fresh/mesa_shader_cache/index", To::file, {"doctor", "--json"}, fresh, false},
        {"fresh/mesa_shader_cache/index",
         To::file,
         {"warm", "trail.json", "in_0001.exr", "--effect-path", "effects"},
         fresh,
         true},
        {"home/.cache/aftershade", To::folder, one, home, false},
    };
    return all;
}

class PlantedLinks : public BatchWork {
protected:
    PlantedLinks() {
        write_frames(1, 3, 16, 9);
        fs::create_directories(folder_ / "suite");
        write_text(folder_ / "suite/golden.json", R"({ "aftershade": 1, "effect_paths": ["../effects"],
            "cases_of_effects": true, "cases": [ { "name": "box", "look": "../trail.json",
            "capture": "../in_0001.exr", "tolerance": { "fail": 0.1 } } ] })");
        fs::create_directories(folder_ / "reports");
        write_text(
            folder_ / "reports/0001.json",
            R"({ "aftershade_report": 1, "seconds": 1, "frames": [ { "frame": 1, "outcome": "done" } ] })");
        fs::copy(fs::path(AFTERSHADE_SOURCE_DIR) / "scenes/wheel/scene.json", folder_ / "scene.json");
        fs::create_directories(folder_ / "effects/trail/cases");
        write_matte(folder_ / "matte.exr", "shot.json");
        expect_done({"golden", "approve", "suite"});
        expect_done({"golden", "run", "suite", "--report", "report"});
        fs::create_directory(folder_ / "cache");
        Command(aftershade_words(run_words({"--frames", "1", "--no-journal"})), folder_.path(),
                {{"AFTERSHADE_BACKEND", "software"}, {"AFTERSHADE_CACHE", "cache"}})
            .wait();
        fs::remove_all(folder_ / "out");
    }
    void expect_done(const std::vector<std::string>& words) const {
        const CommandResult result = run_aftershade(words, folder_.path());
        EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    /// Like one that Blender or Nuke write, whose names stand in a file beside it.
    static void write_matte(const fs::path& path, const std::string& manifest) {
        const Image image(1, 1, 4);
        std::vector<ExrOutputChannel> channels;
        for (int c = 0; c < 4; ++c) {
            channels.push_back({std::string(1, "RGBA"[c]), PixelType::half, &image, c});
            channels.push_back({std::string("CryptoObject00.") + "RGBA"[c], PixelType::float32, &image, c});
        }
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, 0, 0};
        options.attributes["cryptomatte/1234567/name"] = std::string("CryptoObject");
        options.attributes["cryptomatte/1234567/manif_file"] = manifest;
        write_exr(path, channels, options);
    }

    /// What belongs to somebody else: it passes for a report, a sidecar and a manifest.
    static void fill_other(const fs::path& other, const fs::path& picture) {
        fs::create_directories(other / "folder/0001.history");
        write_text(other / "folder/mine", kMark);
        write_text(other / "file", R"({ "aftershade_report": 1, "aftershade": 1, "seconds": 0, "look": ")" +
                                       kMark + R"(", "renderer": ")" + kMark + R"(", "frames": [], ")" +
                                       kMark + "\": \"01020304\" }\n");
        Image pixels = ExrFile(picture).read_floats(0, kRgba);
        std::vector<ExrOutputChannel> channels;
        for (int c = 0; c < 4; ++c) channels.push_back({kRgba[std::size_t(c)], PixelType::half, &pixels, c});
        ExrWriteOptions options;
        options.data_window = options.display_window = {0, 0, pixels.width() - 1, pixels.height() - 1};
        options.attributes["owner"] = kMark;
        write_exr(other / "image", channels, options);
    }
    static void plant(const fs::path& place, To to, const fs::path& other) {
        fs::create_directories(place.parent_path());
        fs::remove_all(place);
        switch (to) {
            case To::file: return fs::create_symlink(other / "file", place);
            case To::image: return fs::create_symlink(other / "image", place);
            case To::absent: return fs::create_symlink(other / "absent", place);
            case To::folder: return fs::create_directory_symlink(other / "folder", place);
            case To::second_name: return fs::create_hard_link(other / "file", place);
            case To::pipe: ASSERT_EQ(mkfifo(place.c_str(), 0666), 0); return;
            case To::zero: return fs::create_symlink("/dev/zero", place);
        }
    }
    static void open_to_all(const fs::path& folder) {
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (!entry.is_symlink())
                fs::permissions(entry.path(), entry.is_directory() ? fs::perms(0777) : fs::perms(0666));
        fs::permissions(folder, fs::perms(0777));
    }
    /// Names, bytes and times.
    static std::map<std::string, std::string> state_of(const fs::path& folder) {
        std::map<std::string, std::string> state = contents(folder);
        for (auto& [name, bytes] : state)
            bytes += " " + std::to_string(fs::last_write_time(folder / name).time_since_epoch().count());
        return state;
    }

    /// `runner` stands before the program's words.
    void expect_harmless(const Planting& planting, const std::vector<std::string>& runner) const {
        SCOPED_TRACE(planting.place + " of kind " + std::to_string(int(planting.to)) + ", " +
                     planting.words[0] + " " + planting.words[1]);
        const TemporaryFolder work, other;
        fs::copy(folder_.path(), work.path(), fs::copy_options::recursive);
        fill_other(other.path(), frame_path(1));
        std::vector<fs::path> places{work / planting.place};
        if (planting.place == "cache") {
            places.clear();
            for (const auto& entry : fs::directory_iterator(work / "cache"))
                if (entry.path().extension() == ".program") places.push_back(entry.path());
            ASSERT_FALSE(places.empty());
        }
        for (const fs::path& place : places) plant(place, planting.to, other.path());
        open_to_all(work.path());
        open_to_all(other.path());
        const auto before = state_of(other.path());
        std::vector<std::string> words = runner;
        for (const std::string& word : aftershade_words(planting.words)) words.push_back(word);
        Environment environment = planting.environment;
        environment.emplace("AFTERSHADE_BACKEND", "software");
        const CommandResult result = Command(words, work.path(), environment).wait();
        EXPECT_EQ(state_of(other.path()), before) << result.err;
        for (const auto& entry : fs::recursive_directory_iterator(work.path())) {
            const bool is_own =
                entry.symlink_status().type() == fs::file_type::regular && entry.hard_link_count() == 1;
            EXPECT_TRUE(!is_own || read_text(entry.path()).find(kMark) == std::string::npos)
                << entry.path() << "\n"
                << result.err;
        }
        EXPECT_EQ((result.out + result.err).find(kMark), std::string::npos) << result.err;
        if (!planting.says) return;
        EXPECT_NE(result.exit_code, 0);
        EXPECT_NE(result.err.find(planting.place), std::string::npos) << result.err;
        EXPECT_TRUE(result.err.find("(remove it") != std::string::npos ||
                    result.err.find("--allow-path") != std::string::npos)
            << result.err;
    }
};

TEST_F(PlantedLinks, ChangeAndShowNothingOfWhatTheyLeadTo) {
    for (const Planting& planting : plantings()) expect_harmless(planting, {});
}

TEST_F(PlantedLinks, ChangeAndShowNothingToAnotherUserEither) {
    if (geteuid() != 0) GTEST_SKIP() << "only root can become nobody; the test before this one ran as a user";
    if (!fs::exists("/usr/bin/setpriv")) GTEST_SKIP() << "no setpriv (Debian package util-linux)";
    const std::vector<std::string> as_nobody = {"/usr/bin/setpriv", "--reuid=65534", "--regid=65534",
                                                "--clear-groups"};
    std::vector<std::string> version = as_nobody;
    for (const std::string& word : aftershade_words({"--version"})) version.push_back(word);
    if (Command(version, folder_.path(), {}).wait().exit_code != 0)
        GTEST_SKIP() << "nobody may not run the program in this checkout's folder";
    for (const Planting& planting : plantings()) expect_harmless(planting, as_nobody);
}

TEST_F(PlantedLinks, AreOthersThanThoseThatTheUserNames) {
    fs::create_directories(folder_ / "store/cuts");
    fs::create_directories(folder_ / "farm");
    for (int frame = 1; frame <= 3; ++frame) {
        const std::string name = frame_path(frame).filename().string();
        fs::copy(frame_path(frame), folder_ / ("store/" + name));
        fs::create_symlink("../store/" + name, folder_ / ("farm/" + name));
    }
    write_text(folder_ / "store/cuts/capture.json",
               R"({ "aftershade": 1, "frames": "../in_####.exr", "range": "1-3", "cuts": [2] })");
    fs::create_symlink("../store/cuts/capture.json", folder_ / "farm/capture.json");
    fs::create_symlink("trail.json", folder_ / "look.json");
    fs::create_directory(folder_ / "disk");
    fs::create_directory_symlink("disk", folder_ / "out");
    fs::create_symlink("../store/old.exr", folder_ / "disk/out_0002.exr");
    fs::create_symlink("../store/history", folder_ / "disk/history");
    const std::vector<std::string> words{"run",     "look.json",        "farm/in_####.exr",
                                         "-o",      "out/out_####.exr", "--effect-path",
                                         "effects", "--history-out",    "out/history"};
    expect_done(words);
    expect_done({"run", "look.json", "farm", "-o", "out/cut_####.exr", "--effect-path", "effects", "--frames",
                 "2-3"});
    EXPECT_TRUE(fs::is_symlink(folder_ / "disk/out_0002.exr"));
    EXPECT_TRUE(fs::exists(folder_ / "store/old.exr"));
    EXPECT_TRUE(fs::exists(folder_ / "store/history"));
    EXPECT_TRUE(fs::exists(folder_ / "disk/.aftershade/journal.jsonl"));
    const CommandResult again = run_aftershade(words, folder_.path());
    EXPECT_NE(again.err.find("3 frames: 3 current, 0 to render"), std::string::npos) << again.err;
}

TEST_F(PlantedLinks, AreNotTheManifestBesideWhatAnExrFilesLinkLeadsTo) {
    fs::create_directory(folder_ / "farm");
    write_text(folder_ / "shot.json", R"({ "hero": "01020304" })");
    for (const char* name : {"matte.exr", "shot.json"})
        fs::create_symlink(std::string("../") + name, folder_ / (std::string("farm/") + name));
    const CommandResult result =
        run_aftershade({"inspect", "farm/matte.exr", "--cryptomatte"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(result.out.find("hero"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace aftershade::test
