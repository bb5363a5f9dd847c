// Set-ups of driver and container that are broken in one way each, and what is said of them.
#include "framework/gpu/driver_faults.h"

#include <dlfcn.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "framework/base/text.h"
#include "framework/gpu/device.h"
#include "tests/gpu/gpu_test.h"
#include "tests/scoped_variable.h"
#include "tests/temporary_folder.h"

namespace aftershade::gpu {
namespace {

namespace fs = std::filesystem;
const std::string kDrivers = AFTERSHADE_TEST_DRIVERS;

/// A system of files below a folder, with the vendor files of a test.
class BrokenSetup : public testing::Test {
protected:
    void SetUp() override {
        list_devices();  // loads EGL, which must be libglvnd's
        if (dlopen("libGLdispatch.so.0", RTLD_NOW | RTLD_NOLOAD) == nullptr)
            GTEST_SKIP() << "EGL is not libglvnd's here";
    }

    void file(const std::string& path, const std::string& text = "") {
        fs::create_directories((folder_ / path).parent_path());
        test::write_text(folder_ / path, text);
    }
    std::string vendor(const std::string& name, const std::string& library) {
        const std::string path = "usr/share/glvnd/egl_vendor.d/" + name;
        file(path, R"({"file_format_version": "1.0.0", "ICD": {"library_path": ")" + library + "\"}}");
        return (folder_ / path).string();
    }
    /// The kernel's driver of NVIDIA and its device files.
    void nvidia() {
        file("proc/driver/nvidia/version",
             "NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.159.04  Tue Oct 28 20:36:58 UTC 2025\n");
        file("dev/nvidiactl");
        file("dev/nvidia0");
    }
    std::string hardware() { return joined(hardware_faults(folder_.path()), "; ", "; "); }
    std::string software() { return joined(software_faults(folder_.path()), "; ", "; "); }

    test::TemporaryFolder folder_;
    test::ScopedVariable names_{"__EGL_VENDOR_LIBRARY_FILENAMES"}, folders_{"__EGL_VENDOR_LIBRARY_DIRS"},
        capabilities_{"NVIDIA_DRIVER_CAPABILITIES"}, drivers_{"LIBGL_DRIVERS_PATH"},
        software_{"LIBGL_ALWAYS_SOFTWARE"}, kubernetes_{"KUBERNETES_SERVICE_HOST"};
};

TEST_F(BrokenSetup, WithoutAGpuNothingIsWrong) {
    vendor("50_mesa.json", kDrivers + "/libegl_stub.so");
    EXPECT_EQ(hardware(), "");
    EXPECT_FALSE(has_gpu_file(folder_.path()));
    nvidia();
    vendor("10_nvidia.json", kDrivers + "/libegl_stub.so");
    EXPECT_EQ(hardware(), "");
    EXPECT_TRUE(has_gpu_file(folder_.path()));
}

TEST_F(BrokenSetup, ADriverThatLacksALibraryIsQuotedWithTheLoadersWords) {
    const std::string library = kDrivers + "/liblacking_stub.so", path = vendor("10_nvidia.json", library);
    EXPECT_EQ(
        hardware(),
        path + " names " + library +
            ", which the loader refuses: libnvidia-absent-stub.so: cannot open "
            "shared object file: No such file or directory; libnvidia-absent-stub.so comes with NVIDIA's "
            "driver: install all its libraries of one version, or start the container with "
            "NVIDIA_DRIVER_CAPABILITIES=all");
}

TEST_F(BrokenSetup, AnOldLibraryThatIsLoadedFirstIsNamed) {
    const std::string library = kDrivers + "/liboutdated_stub.so";
    vendor("50_mesa.json", library);
    for (const std::string& said : {hardware(), software()}) {
        EXPECT_NE(said.find("which the loader refuses: " + kDrivers +
                            "/old/libstubpart.so: version `PART_2.0' not found (required by " + library +
                            "); an older libstubpart.so is loaded first: leave " + kDrivers +
                            "/old out of LD_LIBRARY_PATH and LD_PRELOAD"),
                  std::string::npos)
            << said;
        EXPECT_EQ(said.find("libgl1-mesa-dri"), std::string::npos) << said;
    }
}

/// Messages of glibc 2.36, the first as a program in an environment of conda had it.
TEST(LoaderRemedy, FitsWhatTheLoaderSays) {
    EXPECT_EQ(loader_remedy("/opt/conda/lib/libstdc++.so.6: version `GLIBCXX_3.4.30' not found (required by "
                            "/lib/x86_64-linux-gnu/libLLVM-15.so.1)"),
              "; an older libstdc++.so.6 is loaded first: leave /opt/conda/lib out of LD_LIBRARY_PATH and "
              "LD_PRELOAD, or start outside the environment that it is of");
    EXPECT_EQ(loader_remedy("/lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.38' not found (required by "
                            "/usr/lib/x86_64-linux-gnu/libEGL_mesa.so.0)"),
              "; /lib/x86_64-linux-gnu/libc.so.6 is older than the driver needs: update its package");
    EXPECT_EQ(loader_remedy("libLLVM-15.so.1: cannot open shared object file: No such file or directory"),
              "; install the package that has libLLVM-15.so.1 (apt-file search libLLVM-15.so.1)");
    EXPECT_EQ(loader_remedy("libEGL_mesa.so.0: wrong ELF class: ELFCLASS32"),
              "; it is for another kind of processor");
    EXPECT_EQ(loader_remedy("libEGL_mesa.so.0: undefined symbol: _glapi_tls_Dispatch"),
              "; libraries of different versions are mixed: install its package again");
    EXPECT_EQ(loader_remedy("libEGL_mesa.so.0: cannot enable executable stack as shared object requires"),
              "");
}

TEST_F(BrokenSetup, NvidiasLibraryThatIsAbsentAsksForTheKernelsVersion) {
    const std::string path = vendor("10_nvidia.json", "libEGL_nvidia_of_no_machine.so.0");
    nvidia();
    EXPECT_EQ(
        hardware(),
        path +
            " names libEGL_nvidia_of_no_machine.so.0, which the loader refuses: "
            "libEGL_nvidia_of_no_machine.so.0: cannot open shared object file: No such file or directory; "
            "install the EGL libraries of NVIDIA's driver 580.159.04");
}

TEST_F(BrokenSetup, AContainerWithoutGraphicsNamesTheCapability) {
    nvidia();
    vendor("50_mesa.json", kDrivers + "/libegl_stub.so");
    capabilities_.set("compute,utility");
    EXPECT_EQ(hardware(),
              "NVIDIA's kernel driver is here, but no vendor file names its EGL; "
              "NVIDIA_DRIVER_CAPABILITIES=compute,utility leaves the driver's graphics libraries out "
              "of this container; start the container with NVIDIA_DRIVER_CAPABILITIES=all");
    capabilities_.set("compute,graphics,utility");
    EXPECT_EQ(hardware(),
              "NVIDIA's kernel driver is here, but no vendor file names its EGL; install the EGL "
              "libraries of NVIDIA's driver 580.159.04");
}

/// The container runtime of NVIDIA gives compute and utility where nothing is said.
TEST_F(BrokenSetup, AContainerThatSaysNothingOfCapabilitiesHasNoGraphics) {
    nvidia();
    file(".dockerenv");
    vendor("10_nvidia.json", "libEGL_nvidia_of_no_machine.so.0");
    EXPECT_NE(
        hardware().find("; this container was started without the capability 'graphics' of NVIDIA's driver; "
                        "start the container with NVIDIA_DRIVER_CAPABILITIES=all"),
        std::string::npos)
        << hardware();
}

TEST_F(BrokenSetup, AVariableThatLeavesTheDriverOutIsToBeUnset) {
    nvidia();
    vendor("10_nvidia.json", kDrivers + "/libegl_stub.so");
    names_.set(vendor("50_other.json", kDrivers + "/libegl_stub.so"));
    const std::string chosen =
        "__EGL_VENDOR_LIBRARY_FILENAMES=" + (folder_ / "usr/share/glvnd/egl_vendor.d/50_other.json").string();
    EXPECT_EQ(hardware(), chosen + " leaves NVIDIA's driver out; unset it");
    EXPECT_EQ(software(), chosen + " leaves Mesa out; unset it");
}

TEST_F(BrokenSetup, AVendorFileThatIsNotThereOrNamesNoLibraryIsNamed) {
    names_.set((folder_ / "gone.json").string());
    EXPECT_EQ(hardware(), (folder_ / "gone.json").string() + ": No such file or directory");
    for (const char* text : {"", "{", "[]", R"({"ICD": 3})", R"({"ICD": {"library_path": 3}})"}) {
        file("bad.json", text);
        names_.set((folder_ / "bad.json").string());
        EXPECT_EQ(hardware(), (folder_ / "bad.json").string() +
                                  " names no library (its ICD.library_path); install its package again");
    }
}

TEST_F(BrokenSetup, AFileThatIsNoDriverIsNamed) {
    file("libcut.so.0");
    const std::string cut = vendor("50_mesa.json", (folder_ / "libcut.so.0").string());
    EXPECT_NE(hardware().find(cut + " names " + (folder_ / "libcut.so.0").string() +
                              ", which the loader refuses: " + (folder_ / "libcut.so.0").string() +
                              ": file too short; the file is damaged: put it back from its package"),
              std::string::npos)
        << hardware();
    vendor("50_mesa.json", kDrivers + "/libno_driver_stub.so");
    EXPECT_EQ(hardware(), cut + " names " + kDrivers +
                              "/libno_driver_stub.so, which is not a driver for EGL (it has no __egl_Main)");
}

TEST_F(BrokenSetup, LibrariesOfAnotherVersionThanTheKernelsDriverAreNamed) {
    nvidia();
    const fs::path library = folder_ / "lib/libEGL_nvidia.so.535.183.01";
    fs::create_directories(library.parent_path());
    fs::copy_file(kDrivers + "/libegl_stub.so", library);
    fs::create_symlink(library, folder_ / "lib/libEGL_nvidia.so.0");
    vendor("10_nvidia.json", (folder_ / "lib/libEGL_nvidia.so.0").string());
    EXPECT_EQ(hardware(),
              "libEGL_nvidia.so.535.183.01 is of version 535.183.01, and the kernel's driver of "
              "580.159.04; install one version of both, or reboot after an update");
}

/// As another user where the test is root, who may open every file.
TEST_F(BrokenSetup, ANodeThatMayNotBeOpenedIsNamedWithItsGroup) {
    file("dev/dri/renderD128");
    nvidia();
    vendor("10_nvidia.json", kDrivers + "/libegl_stub.so");
    ASSERT_EQ(chmod((folder_ / "dev/dri/renderD128").c_str(), 0060), 0);
    ASSERT_EQ(chmod((folder_ / "dev/nvidiactl").c_str(), 0000), 0);
    ASSERT_EQ(chmod((folder_ / "dev/nvidia0").c_str(), 0666), 0);
    fs::permissions(folder_.path(), fs::perms(0755));
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
        if (entry.is_directory()) fs::permissions(entry, fs::perms(0755));
    constexpr uid_t kNobody = 65534;
    constexpr gid_t kGroup = 12345;  // of no name
    const bool is_root = geteuid() == 0;
    if (is_root) {
        ASSERT_EQ(chown((folder_ / "dev/dri/renderD128").c_str(), 0, kGroup), 0);
        ASSERT_EQ(seteuid(kNobody), 0);
    }
    const std::string said = hardware();
    if (is_root) {
        ASSERT_EQ(seteuid(0), 0);
    }
    const std::string group = is_root ? std::to_string(kGroup) : "";
    EXPECT_NE(
        said.find((folder_ / "dev/dri/renderD128").string() + ": Permission denied; its group " + group),
        std::string::npos)
        << said;
    EXPECT_NE(said.find(" may open it: add this user to that group; " + (folder_ / "dev/nvidiactl").string() +
                        ": Permission denied; its mode is 0000: let its users read and write it"),
              std::string::npos)
        << said;
    EXPECT_EQ(said.find("nvidia0:"), std::string::npos) << said;
}

TEST_F(BrokenSetup, AGpuWithoutDeviceFilesIsFoundOnPci) {
    const auto pci = [&](const std::string& address, const char* maker, const char* kind) {
        file("sys/bus/pci/devices/" + address + "/vendor", maker);
        file("sys/bus/pci/devices/" + address + "/class", kind);
    };
    pci("0000:00:02.0", "0x1234\n", "0x030000\n");  // a virtual machine's console
    pci("0000:00:03.0", "0x10de\n", "0x020000\n");  // a network card
    EXPECT_EQ(hardware(), "");
    pci("0000:65:00.0", "0x10de\n", "0x030200\n");
    EXPECT_EQ(hardware(), "0000:65:00.0 is a GPU of NVIDIA, but no kernel driver has it: load its driver");
    file("sys/bus/pci/devices/0000:65:00.0/driver/module");
    EXPECT_EQ(hardware(),
              "0000:65:00.0 is a GPU of NVIDIA, but its device files are not here: start the container "
              "with --gpus all, or map /dev/dri into it");
}

TEST_F(BrokenSetup, MesaKeptInSoftwareByAVariableSaysSo) {
    file("dev/dri/renderD128");
    software_.set("1");
    EXPECT_EQ(hardware(), "LIBGL_ALWAYS_SOFTWARE=1 keeps Mesa in software; unset it");
}

TEST_F(BrokenSetup, MesasDriverIsAskedForOnlyWhereItIsAbsent) {
    for (const char* name : {"one", "two"}) fs::create_directories(folder_ / name);
    fs::copy_file(kDrivers + "/libegl_stub.so", folder_ / "one/libEGL_mesa.so.0");
    vendor("50_mesa.json", (folder_ / "one/libEGL_mesa.so.0").string());
    EXPECT_EQ(software(), "Mesa has no swrast_dri.so in " + (folder_ / "one/dri").string() +
                              "; install the Debian package libgl1-mesa-dri");
    drivers_.set((folder_ / "two").string());
    EXPECT_EQ(software(),
              "LIBGL_DRIVERS_PATH=" + (folder_ / "two").string() + " has no swrast_dri.so; unset it");
    file("two/swrast_dri.so", "no library at all, though of some length: " + std::string(100, ' '));
    EXPECT_EQ(software(),
              "Mesa's driver " + (folder_ / "two/swrast_dri.so").string() +
                  " is there, but the loader refuses it: " + (folder_ / "two/swrast_dri.so").string() +
                  ": invalid ELF header; the file is damaged: put it back from its package");
}

TEST_F(BrokenSetup, WithoutMesasVendorFileItsPackageIsNamed) {
    EXPECT_EQ(software(), "no vendor file names Mesa's EGL; install the Debian package libegl-mesa0");
}

}  // namespace
}  // namespace aftershade::gpu
