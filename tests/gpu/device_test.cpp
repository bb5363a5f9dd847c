#include "framework/gpu/device.h"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scoped_variable.h"
#include "tests/temporary_folder.h"

namespace aftershade::gpu {
namespace {

namespace fs = std::filesystem;
using test::ScopedVariable;

/// Cards of NVIDIA as EGL may list them: CUDA's order is another one. Files below `root` have the addresses.
std::vector<Device> cards(int count, const fs::path& root) {
    std::vector<Device> devices;
    for (int i = 0; i < count; ++i) {
        Device device{.index = i};
        device.card = fmt::format("/dev/dri/card{}", i + 1);
        device.render_node = fmt::format("/dev/dri/renderD{}", 128 + i);
        device.uuid = fmt::format("GPU-{:08x}-0000-1111-2222-333333333333", 0xa0000000U + unsigned(i));
        device.cuda = count - 1 - i;
        device.has_cuda = true;
        const std::string pci = fmt::format("0000:{:02x}:00.0", 0x10 + i);
        fs::create_directories(root / "sys/devices" / pci);
        fs::create_directories(root / "sys/class/drm" / fs::path(device.card).filename());
        fs::create_directory_symlink("../../../devices/" + pci,
                                     root / "sys/class/drm" / fs::path(device.card).filename() / "device");
        devices.push_back(device);
    }
    return devices;
}

class Devices : public testing::Test {
protected:
    std::vector<Device> completed(int count) {
        std::vector<Device> devices = cards(count, folder_.path());
        complete_devices(devices, folder_.path());
        return devices;
    }
    std::vector<int> indices(const std::vector<Device>& devices) {
        std::vector<int> result;
        for (const Device& device : devices) result.push_back(device.index);
        return result;
    }

    test::TemporaryFolder folder_;
    ScopedVariable visible_{"CUDA_VISIBLE_DEVICES"};
};

TEST_F(Devices, EveryNameMeansTheOneCardThatHasItOfOneTwoOrEight) {
    for (const int count : {1, 2, 8}) {
        const test::TemporaryFolder folder;
        std::vector<Device> devices = cards(count, folder.path());
        complete_devices(devices, folder.path());
        for (int i = 0; i < count; ++i) {
            const std::string bus = fmt::format("{:02x}:00.0", 0x10 + i);
            EXPECT_EQ(devices[std::size_t(i)].names(),
                      (std::vector<std::string>{std::to_string(i), fmt::format("/dev/dri/card{}", i + 1),
                                                fmt::format("/dev/dri/renderD{}", 128 + i), "0000:" + bus,
                                                fmt::format("GPU-a000000{}-0000-1111-2222-333333333333", i),
                                                fmt::format("cuda:{}", count - 1 - i)}));
            std::vector<std::string> names = devices[std::size_t(i)].names();
            names.insert(names.end(), {fmt::format("card{}", i + 1), fmt::format("renderD{}", 128 + i), bus,
                                       "00000000:" + bus, fmt::format("GPU-A000000{}", i),
                                       fmt::format("a000000{}-0000-1111-2222-333333333333", i)});
            for (const std::string& name : names) {
                SCOPED_TRACE(name);
                EXPECT_EQ(indices(devices_named(devices, name)), std::vector<int>{i});
            }
        }
    }
}

TEST_F(Devices, AnUnknownNameListsWhatThereIs) {
    const std::vector<Device> devices = completed(2);
    for (const char* name : {"2", "cuda:2", "cuda:", "card7", "0000:99:00.0", "GPU-ffff", "-1", "/dev/null"})
        EXPECT_EQ(error_of([&] { devices_named(devices, name); }),
                  fmt::format("device '{}' is not there; EGL lists 0 (/dev/dri/card1, /dev/dri/renderD128, "
                              "0000:10:00.0, GPU-a0000000-0000-1111-2222-333333333333, cuda:1), 1 "
                              "(/dev/dri/card2, /dev/dri/renderD129, 0000:11:00.0, "
                              "GPU-a0000001-0000-1111-2222-333333333333, cuda:0)",
                              name));
    EXPECT_EQ(error_of([] { devices_named({}, "0"); }), "device '0' is not there; EGL lists no device");
    EXPECT_NE(error_of([&] { devices_named(devices, "GPU-a000"); }).find("may be each of 0 ("),
              std::string::npos);
}

TEST_F(Devices, NvidiasFilesGiveWhatEglDoesNotSay) {
    std::vector<Device> devices = cards(2, folder_.path());
    devices[0].uuid.clear();
    devices[1].card.clear();
    devices[1].render_node.clear();
    for (const int i : {0, 1}) {
        const fs::path gpu = folder_ / "proc/driver/nvidia/gpus" / fmt::format("0000:1{}:00.0", i);
        fs::create_directories(gpu);
        test::write_text(
            gpu / "information",
            fmt::format("Model: \t\t NVIDIA H100\nIRQ:   \t\t 16\nGPU UUID: \t GPU-a000000{}-0000-1111-2222-"
                        "333333333333\nVideo BIOS: \t 96.00\n",
                        i));
    }
    complete_devices(devices, folder_.path());
    EXPECT_EQ(devices[0].uuid, "GPU-a0000000-0000-1111-2222-333333333333");
    EXPECT_EQ(devices[1].pci, "0000:11:00.0");
}

/// CUDA's numbers in the process as its manual gives them, from the number of every card in the machine.
TEST_F(Devices, CudaVisibleDevicesHidesAndNumbersCardsAsCudaDoes) {
    struct Case {
        const char* value;
        std::vector<int> visible;  // indices, by CUDA's number
    };
    for (const auto& [value, visible] :
         {Case{"0", {3}}, Case{"2,0", {1, 3}}, Case{" 1 , 3 ", {2, 0}}, Case{"GPU-a0000002", {2}},
          Case{"GPU-a0000002-0000-1111-2222-333333333333,GPU-a0000000", {2, 0}}, Case{"1,-1,0", {2}},
          Case{"1,7,0", {2}}, Case{"1,1", {2}}, Case{"", {}}, Case{"-1", {}}, Case{"NoDevFiles", {}},
          Case{"MIG-a0000002-0000-1111-2222-333333333333", {}}}) {
        SCOPED_TRACE(value);
        const test::TemporaryFolder folder;
        visible_.set(value);
        std::vector<Device> devices = cards(4, folder.path());
        devices.push_back({.index = 4, .card = "/dev/dri/card0"});  // of another maker
        complete_devices(devices, folder.path());
        std::vector<int> all = visible;
        all.push_back(4);
        EXPECT_EQ(indices(devices_named(devices, "all")), all);
        EXPECT_EQ(indices(devices_named(devices, "")), all);
        for (std::size_t i = 0; i < visible.size(); ++i)
            EXPECT_EQ(devices_named(devices, fmt::format("cuda:{}", i)).front().index, visible[i]);
        EXPECT_THROW(devices_named(devices, fmt::format("cuda:{}", visible.size())), Error);
        for (int i = 0; i < 4; ++i) {
            if (std::ranges::find(visible, i) != visible.end()) continue;
            EXPECT_EQ(error_of([&] {
                          devices_named(devices, std::to_string(i));
                      }).find(fmt::format("device '{}': CUDA_VISIBLE_DEVICES={} hides {} (", i, value, i)),
                      0U);
        }
    }
}

TEST_F(Devices, ADriverMayNumberOnlyTheVisibleCardsItself) {
    visible_.set("3,1");
    std::vector<Device> devices = cards(4, folder_.path());
    for (Device& device : devices) device.cuda.reset();
    devices[2].cuda = 0;
    devices[0].cuda = 1;
    complete_devices(devices, folder_.path());
    EXPECT_EQ(indices(devices_named(devices, "all")), (std::vector<int>{2, 0}));
    // Without CUDA no card has a number, and a container has those cards only that it may use.
    devices = cards(2, test::TemporaryFolder().path());
    for (Device& device : devices) device.cuda.reset();
    complete_devices(devices, folder_.path());
    EXPECT_EQ(indices(devices_named(devices, "all")), (std::vector<int>{0, 1}));
}

TEST_F(Devices, PartsGoToAllCardsEvenly) {
    for (const int count : {1, 2, 8}) {
        const test::TemporaryFolder folder;
        std::vector<Device> devices = cards(count, folder.path());
        devices.push_back({.index = count, .is_software = true});
        for (const int parts : {1, 3, 8, 20}) {
            std::map<std::string, int> uses;
            for (int i = 0; i < parts; ++i) ++uses[device_of_part(devices, Backend::automatic, i)];
            EXPECT_EQ(int(uses.size()), std::min(count, parts));
            for (const auto& [device, times] : uses) {
                EXPECT_LE(times, (parts + count - 1) / count) << device;
                EXPECT_GE(times, parts / count) << device;
                EXPECT_NE(device, std::to_string(count)) << "software";
            }
        }
        for (const Backend backend : {Backend::software, Backend::egl_software, Backend::osmesa})
            EXPECT_EQ(device_of_part(devices, backend, 5), "");
    }
    EXPECT_EQ(device_of_part({}, Backend::automatic, 3), "");
    EXPECT_EQ(device_of_part({{.index = 0, .is_software = true}}, Backend::automatic, 3), "");
    EXPECT_EQ(device_of_part({{.index = 0, .is_software = true}}, Backend::egl, 3), "");
}

TEST_F(Devices, OfThisMachineTheSoftwareOneDrawsByItsName) {
    SKIP_WITHOUT(Backend::egl_software);
    std::string name;
    for (const Device& device : list_devices())
        if (device.is_software) name = std::to_string(device.index);
    if (name.empty()) GTEST_SKIP() << "EGL opens its software renderer without a device";
    EXPECT_EQ(Context({Backend::egl_software, name}).info().device, "EGL device " + name);
    const Context chosen({Backend::automatic, name});
    EXPECT_EQ(chosen.info().backend, Backend::egl_software);
    EXPECT_EQ(chosen.info().hardware_fault, "") << "software was asked for";
    EXPECT_NE(error_of([&] {
                  Context({Backend::egl, name});
              }).find("draws in software; egl-software takes it"),
              std::string::npos);
    EXPECT_NE(error_of([&] {
                  Context({Backend::osmesa, name});
              }).find("OSMesa draws on no device"),
              std::string::npos);
    try {
        const Context none({Backend::automatic, "card77"});
        FAIL() << "a card that is not there";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
    }
}

}  // namespace
}  // namespace aftershade::gpu
