// --device with cards that a double of EGL simulates.
#include <dlfcn.h>
#include <link.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "tests/backends.h"
#include "tests/cli/batch_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

const std::string kSoftware = "software,,,,;";

class SimulatedCards : public BatchWork {
protected:
    void SetUp() override {
        SKIP_WITHOUT(gpu::Backend::egl_software);
        link_map* library = nullptr;
        void* const egl = dlopen("libEGL.so.1", RTLD_NOW);
        ASSERT_TRUE(egl && dlinfo(egl, RTLD_DI_LINKMAP, &library) == 0);
        environment_ = {{"LD_LIBRARY_PATH", AFTERSHADE_TEST_DRIVERS "/double"},
                        {"EGL_DOUBLE_REAL", library->l_name},
                        {"EGL_DOUBLE_LOG", (folder_ / "opened").string()},
                        {"AFTERSHADE_DRAW_WITH", "fragment"},
                        {"AFTERSHADE_CACHE", "off"}};
    }

    /// CUDA numbers them from the last one on.
    void give_cards(int count, const std::string& kind = "gpu") {
        std::string& list = environment_["EGL_DOUBLE_DEVICES"];
        list.clear();
        for (int i = 0; i < count; ++i)
            list += fmt::format("{},/dev/dri/card{},/dev/dri/renderD{},a000000{}000011112222333333333333,{};",
                                kind, i, 128 + i, i, count - 1 - i);
    }
    CommandResult call(std::vector<std::string> words) {
        fs::remove(folder_ / "opened");
        words.insert(words.begin(), AFTERSHADE_EXECUTABLE);
        return Command(words, folder_.path(), environment_).wait();
    }
    CommandResult render(const std::vector<std::string>& more, int code = 0) {
        std::vector<std::string> words{"run",         "nothing.json", "in_####.exr",
                                       "-o",          "out_####.exr", "--no-journal",
                                       "--overwrite", "--report",     "report.json"};
        words.insert(words.end(), more.begin(), more.end());
        CommandResult result = call(words);
        EXPECT_EQ(result.exit_code, code) << result.err;
        return result;
    }
    nlohmann::json report() { return nlohmann::json::parse(read_text(folder_ / "report.json")); }
    /// How many contexts each device got.
    std::map<std::string, int> opened() {
        std::map<std::string, int> count;
        for (const std::string& line : lines_of_text(read_text(folder_ / "opened"))) ++count[line];
        return count;
    }

    Environment environment_;
};

TEST_F(SimulatedCards, DoctorListsNoneOneTwoOrEightWithEachName) {
    for (const int count : {0, 1, 2, 8}) {
        give_cards(count);
        const auto devices = nlohmann::json::parse(call({"doctor", "--json"}).out)["devices"];
        const std::string text = call({"doctor"}).out;
        ASSERT_EQ(int(devices.size()), count);
        for (int i = 0; i < count; ++i) {
            const std::vector<std::string> names{std::to_string(i), fmt::format("/dev/dri/card{}", i),
                                                 fmt::format("/dev/dri/renderD{}", 128 + i),
                                                 fmt::format("GPU-a000000{}-0000-1111-2222-333333333333", i),
                                                 fmt::format("cuda:{}", count - 1 - i)};
            EXPECT_EQ(devices[std::size_t(i)]["names"], names);
            EXPECT_EQ(devices[std::size_t(i)]["software"], false);
            for (const std::string& name : names) EXPECT_NE(text.find(name), std::string::npos) << text;
        }
    }
}

TEST_F(SimulatedCards, EveryNameDrawsOnTheCardThatHasIt) {
    give_cards(2);
    write_frames(1, 1);
    for (const char* name : {"1", "card1", "/dev/dri/card1", "renderD129", "GPU-a0000001", "cuda:0"}) {
        SCOPED_TRACE(name);
        const auto check = [&] {
            EXPECT_EQ(opened(), (std::map<std::string, int>{{"1", 1}}));
            EXPECT_EQ(report()["device"], "/dev/dri/card1");
            EXPECT_EQ(report()["hardware_not_usable"], false);
        };
        render({"--device", name});
        check();
        environment_["AFTERSHADE_DEVICE"] = name;
        render({});
        check();
        environment_.erase("AFTERSHADE_DEVICE");
    }
}

TEST_F(SimulatedCards, ANameThatNoCardHasEndsTheCommandAndSaysWhereItCameFrom) {
    give_cards(2);
    write_frames(1, 1);
    EXPECT_EQ(render({"--device", "cuda:2"}, 2)
                  .err.find("aftershade: error: --device: device 'cuda:2' is not there; "
                            "EGL lists 0 (/dev/dri/card0, "),
              0U);
    EXPECT_NE(render({"--device", "a\nb"}, 2).err.find("device 'a?b' is not there"), std::string::npos);
    EXPECT_EQ(call({"check", "vignette", "--device", "7"}).exit_code, 2);
    EXPECT_EQ(
        call({"golden", "run", AFTERSHADE_SOURCE_DIR "/tests/golden", "--backend", "auto", "--device", "7"})
            .exit_code,
        64);
    environment_["AFTERSHADE_DEVICE"] = "card7";
    EXPECT_EQ(render({}, 2).err.find("aftershade: error: AFTERSHADE_DEVICE: device 'card7' is not there"),
              0U);
    environment_["EGL_DOUBLE_DEVICES"] += kSoftware;
    render({"--backend", "egl-software"});  // the variable is of cards
    environment_.erase("AFTERSHADE_DEVICE");
    EXPECT_EQ(render({"--device", "all"}, 2).err.find("aftershade: error: --device all: spreads the workers"),
              0U);
    give_cards(0);
    EXPECT_NE(render({"--device", "0"}, 4).err.find("  egl: EGL lists no hardware device"),
              std::string::npos);
}

TEST_F(SimulatedCards, WorkersSpreadEvenlyOverAllCards) {
    write_frames(1, 8);
    for (const auto& [count, jobs] : {std::pair{1, 3}, std::pair{2, 5}, std::pair{8, 8}}) {
        give_cards(count);
        render({"--jobs", std::to_string(jobs), "--device", "all"});
        const auto uses = opened();
        EXPECT_EQ(int(uses.size()), std::min(count, jobs));
        for (const auto& [device, times] : uses) {
            EXPECT_GE(times, jobs / count) << device;
            EXPECT_LE(times, (jobs + count - 1) / count) << device;
        }
        EXPECT_EQ(report()["done"], 8);
        EXPECT_NE(report()["renderer"].get<std::string>().find("Simulated card"), std::string::npos);
    }
}

TEST_F(SimulatedCards, ChunksOfAFarmSpreadOverAllCards) {
    write_frames(1, 6);
    give_cards(2);
    environment_["AFTERSHADE_DEVICE"] = "all";
    for (const int chunk : {1, 2, 3}) {
        render({"--chunk", fmt::format("{}/3", chunk)});
        EXPECT_EQ(opened(), (std::map<std::string, int>{{std::to_string((chunk - 1) % 2), 1}}));
    }
    render({});
    EXPECT_EQ(opened(), (std::map<std::string, int>{{"0", 1}})) << "a lone process takes one";
}

TEST_F(SimulatedCards, CudaVisibleDevicesChoosesAndHidesCards) {
    write_frames(1, 4);
    give_cards(4);
    environment_["CUDA_VISIBLE_DEVICES"] = "1,3";
    render({});
    EXPECT_EQ(opened(), (std::map<std::string, int>{{"2", 1}}));
    render({"--device", "cuda:1"});
    EXPECT_EQ(opened(), (std::map<std::string, int>{{"0", 1}}));
    render({"--device", "all", "--jobs", "4"});
    EXPECT_EQ(opened(), (std::map<std::string, int>{{"0", 2}, {"2", 2}}));
    EXPECT_NE(render({"--device", "card1"}, 2)
                  .err.find("--device: device 'card1': CUDA_VISIBLE_DEVICES=1,3 hides 1 ("),
              std::string::npos);
    environment_["CUDA_VISIBLE_DEVICES"] = "";
    EXPECT_NE(render({"--backend", "egl"}, 4).err.find("egl: CUDA_VISIBLE_DEVICES= hides 0 ("),
              std::string::npos);
}

TEST_F(SimulatedCards, AFallBackToSoftwareIsSaidByWorkersAndEveryVerb) {
    write_frames(1, 2);
    give_cards(1, "broken");
    environment_["EGL_DOUBLE_DEVICES"] += kSoftware;
    const std::string why = "egl: /dev/dri/card0: eglInitialize failed (";
    for (const char* jobs : {"1", "2"}) {
        const std::string said = render({"--jobs", jobs}).err;
        EXPECT_NE(said.find("; backend auto found no usable hardware GL (" + why), std::string::npos) << said;
        EXPECT_EQ(report()["hardware_not_usable"], true);
        EXPECT_EQ(report()["hardware_fault"].get<std::string>().find(why), 0U);
    }
    const CommandResult checked = call({"check", "vignette"});
    EXPECT_EQ(checked.exit_code, 0) << checked.err;
    EXPECT_EQ(checked.err.find("aftershade: warning: backend auto draws in software: " + why), 0U)
        << checked.err;
    // A card that is named is not replaced.
    EXPECT_NE(render({"--device", "card0"}, 4).err.find("  " + why), std::string::npos);
}

}  // namespace
}  // namespace aftershade::test
