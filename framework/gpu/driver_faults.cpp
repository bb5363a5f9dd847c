#include "framework/gpu/driver_faults.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <system_error>

#include <dlfcn.h>
#include <fcntl.h>
#include <grp.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/gpu/device.h"

namespace aftershade::gpu {
namespace {

namespace fs = std::filesystem;
using Texts = std::vector<std::string>;

constexpr const char* kFilenames = "__EGL_VENDOR_LIBRARY_FILENAMES";
constexpr const char* kFolders = "__EGL_VENDOR_LIBRARY_DIRS";
constexpr const char* kCapabilities = "NVIDIA_DRIVER_CAPABILITIES";
constexpr const char* kAskGraphics = "start the container with NVIDIA_DRIVER_CAPABILITIES=all";
constexpr const char* kNoFile = "cannot open shared object file: No such file";

std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

bool contains(std::string_view text, std::string_view part) {
    return text.find(part) != text.npos;
}

bool is_there(const fs::path& path) {
    std::error_code failure;
    return fs::exists(path, failure);
}

std::vector<fs::path> files_in(const fs::path& folder, std::string_view beginning,
                               std::string_view end = "") {
    std::vector<fs::path> files;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with(beginning) && name.ends_with(end)) files.push_back(entry.path());
    }
    std::ranges::sort(files);
    return files;
}

std::string file_text(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Whether a library whose name has this in it is loaded.
bool is_loaded(std::string_view part) {
    return contains(file_text("/proc/self/maps"), part);
}

/// Whether EGL finds its drivers by vendor files: it is libglvnd's, not a driver's own.
bool has_glvnd() {
    return is_loaded("libGLdispatch");
}

/// A file by which libglvnd finds a driver, and what is wrong with it.
struct Vendor {
    fs::path file;
    std::string library;  ///< as the file names it
    std::string fault;
    void* entry = nullptr;  ///< its __egl_Main, where it loads

    bool is_of(std::string_view maker) const {
        return contains(lower_case(fs::path(library).filename().string()), maker) ||
               contains(lower_case(file.filename().string()), maker);
    }
};

Vendor read_vendor(const fs::path& file) {
    Vendor vendor{file, "", ""};
    if (access(file.c_str(), R_OK) != 0) {
        vendor.fault = fmt::format("{}: {}", file.string(), std::generic_category().message(errno));
        return vendor;
    }
    const nlohmann::json none, json = nlohmann::json::parse(file_text(file), nullptr, false);
    const nlohmann::json icd = json.is_object() ? json.value("ICD", none) : none;
    const nlohmann::json path = icd.is_object() ? icd.value("library_path", none) : none;
    if (path.is_string()) vendor.library = path.get<std::string>();
    if (vendor.library.empty()) {
        vendor.fault = file.string() + " names no library (its ICD.library_path); install its package again";
        return vendor;
    }
    // As libglvnd does; drivers do not expect to be closed.
    void* const library = dlopen(vendor.library.c_str(), RTLD_LAZY | RTLD_LOCAL);
    const char* said = library ? nullptr : dlerror();
    if (library) vendor.entry = dlsym(library, "__egl_Main");
    if (said) {
        const std::string message = said;
        // Its own absence has a remedy that depends on the system.
        const bool is_absent = contains(message, kNoFile) && message.starts_with(vendor.library + ":");
        vendor.fault = fmt::format("{} names {}, which the loader refuses: {}{}", file.string(),
                                   vendor.library, message, is_absent ? "" : loader_remedy(message));
    } else if (!vendor.entry) {
        vendor.fault = fmt::format("{} names {}, which is not a driver for EGL (it has no __egl_Main)",
                                   file.string(), vendor.library);
    }
    return vendor;
}

/// As libglvnd searches: https://github.com/NVIDIA/libglvnd/blob/master/src/EGL/icd_enumeration.md
std::vector<Vendor> read_vendors(const fs::path& root) {
    if (!has_glvnd()) return {};
    std::vector<fs::path> files;
    if (const std::string names = variable(kFilenames); !names.empty()) {
        for (const std::string_view name : split(names, ':')) files.emplace_back(name);
    } else {
        std::vector<fs::path> folders = {root / "etc/glvnd/egl_vendor.d",
                                         root / "usr/share/glvnd/egl_vendor.d"};
        if (const std::string given = variable(kFolders); !given.empty()) {
            folders.clear();
            for (const std::string_view folder : split(given, ':')) folders.emplace_back(folder);
        }
        for (const fs::path& folder : folders)
            std::ranges::copy(files_in(folder, "", ".json"), std::back_inserter(files));
    }
    std::vector<Vendor> vendors;
    for (const fs::path& file : files) vendors.push_back(read_vendor(file));
    return vendors;
}

/// "__EGL_VENDOR_LIBRARY_DIRS=/x" where such a variable chooses the vendor files; "" without one.
std::string chosen_vendors() {
    for (const char* name : {kFilenames, kFolders})
        if (const std::string value = variable(name); !value.empty())
            return fmt::format("{}={}", name, value);
    return "";
}

/// "580.159.04", of the kernel's module; "" without one.
std::string nvidia_version(const fs::path& root) {
    const std::string text = file_text(root / "proc/driver/nvidia/version");
    for (const std::string_view word : split(text, ' '))
        if (!word.empty() && std::isdigit(static_cast<unsigned char>(word.front())) && contains(word, "."))
            return std::string(word);
    return "";
}

/// What makes NVIDIA's libraries be there.
std::string nvidia_remedy(const fs::path& root) {
    const std::string given = variable(kCapabilities);
    if (!given.empty() && !contains(given, "graphics") && !contains(given, "all"))
        return fmt::format("{}={} leaves the driver's graphics libraries out of this container; {}",
                           kCapabilities, given, kAskGraphics);
    const bool is_container = is_there(root / ".dockerenv") || is_there(root / "run/.containerenv") ||
                              std::getenv("KUBERNETES_SERVICE_HOST");
    if (is_container && given.empty())
        return std::string(
                   "this container was started without the capability 'graphics' of NVIDIA's driver; ") +
               kAskGraphics;
    const std::string version = nvidia_version(root);
    return "install the EGL libraries of NVIDIA's driver" + (version.empty() ? "" : " " + version);
}

void add_nvidia_faults(const fs::path& root, const std::vector<Vendor>& vendors, Texts& faults) {
    if (!is_there(root / "proc/driver/nvidia/version") && !is_there(root / "dev/nvidiactl")) return;
    const auto found =
        std::ranges::find_if(vendors, [](const Vendor& vendor) { return vendor.is_of("nvidia"); });
    if (found == vendors.end()) {
        if (!has_glvnd()) return;
        const std::string chosen = chosen_vendors();
        faults.push_back(chosen.empty()
                             ? "NVIDIA's kernel driver is here, but no vendor file names its EGL; " +
                                   nvidia_remedy(root)
                             : chosen + " leaves NVIDIA's driver out; unset it");
        return;
    }
    if (!found->entry) {
        if (contains(found->fault, kNoFile)) faults.push_back(nvidia_remedy(root));
        return;
    }
    // libEGL_nvidia.so.0 is a link to libEGL_nvidia.so.VERSION.
    Dl_info library{};
    const std::string kernel = nvidia_version(root);
    std::error_code failure;
    if (kernel.empty() || !dladdr(found->entry, &library)) return;
    const std::string file = fs::canonical(library.dli_fname, failure).filename().string();
    const std::size_t suffix = file.find(".so.");
    const std::string version = suffix == file.npos ? "" : file.substr(suffix + 4);
    if (contains(version, ".") && version != kernel)
        faults.push_back(
            fmt::format("{} is of version {}, and the kernel's driver of {}; install one version of "
                        "both, or reboot after an update",
                        file, version, kernel));
}

std::string group_of(const struct stat& status) {
    const struct group* entry = getgrgid(status.st_gid);
    return entry ? entry->gr_name : std::to_string(status.st_gid);
}

/// Why this process may not open a device file; "" where it may.
std::string node_fault(const fs::path& node) {
    const int descriptor = open(node.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK);
    if (descriptor >= 0) close(descriptor);
    if (descriptor >= 0) return "";
    const int code = errno;
    std::string text = fmt::format("{}: {}", node.string(), std::generic_category().message(code));
    struct stat status {};
    if (code == EACCES && stat(node.c_str(), &status) == 0)
        text += (status.st_mode & 0060) == 0060
                    ? fmt::format("; its group {} may open it: add this user to that group", group_of(status))
                    : fmt::format("; its mode is {:04o}: let its users read and write it",
                                  status.st_mode & 07777);
    if (code == EPERM)
        text += "; the container's rules forbid it: start it with --gpus all, or map the file into it";
    return text;
}

std::vector<fs::path> gpu_files(const fs::path& root) {
    std::vector<fs::path> files = files_in(root / "dev/dri", "renderD");
    for (const fs::path& file : files_in(root / "dev", "nvidia")) {
        const std::string end = file.filename().string().substr(std::string_view("nvidia").size());
        if (end == "ctl" || (!end.empty() && std::ranges::all_of(end, [](char c) {
                return std::isdigit(static_cast<unsigned char>(c));
            })))
            files.push_back(file);
    }
    for (const char* name : {"dev/dxg", "dev/kfd"})
        if (is_there(root / name)) files.push_back(root / name);
    return files;
}

/// GPUs on PCI without any device file.
void add_faults_of_absent_files(const fs::path& root, Texts& faults) {
    for (const fs::path& device : files_in(root / "sys/bus/pci/devices", "")) {
        const std::string maker = file_text(device / "vendor");
        const bool is_display = file_text(device / "class").starts_with("0x03");
        const char* name = maker.starts_with("0x10de")   ? "NVIDIA"
                           : maker.starts_with("0x1002") ? "AMD"
                           : maker.starts_with("0x8086") ? "Intel"
                                                         : nullptr;
        if (!is_display || !name) continue;
        faults.push_back(fmt::format("{} is a GPU of {}, but {}", device.filename().string(), name,
                                     is_there(device / "driver")
                                         ? "its device files are not here: start the container with --gpus "
                                           "all, or map /dev/dri into it"
                                         : "no kernel driver has it: load its driver"));
    }
}

/// Mesa up to 24.2 opens its drivers as files of a folder; later ones are linked to them.
void add_dri_faults(const Vendor& mesa, Texts& faults) {
    constexpr const char* kDriver = "swrast_dri.so";
    Dl_info library{};
    if (is_loaded("libgallium-") || !dladdr(mesa.entry, &library)) return;
    const std::string given = variable("LIBGL_DRIVERS_PATH");
    const std::string folders =
        given.empty() ? (fs::path(library.dli_fname).parent_path() / "dri").string() : given;
    for (const std::string_view folder : split(folders, ':')) {
        const fs::path file = fs::path(folder) / kDriver;
        if (!is_there(file)) continue;
        if (dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) return;
        const char* said = dlerror();
        const std::string message = said ? said : "";
        faults.push_back(fmt::format("Mesa's driver {} is there, but the loader refuses it: {}{}",
                                     file.string(), message, loader_remedy(message)));
        return;
    }
    faults.push_back(given.empty()
                         ? fmt::format("Mesa has no {} in {}; install the Debian package libgl1-mesa-dri",
                                       kDriver, folders)
                         : fmt::format("LIBGL_DRIVERS_PATH={} has no {}; unset it", given, kDriver));
}

}  // namespace

std::string loader_remedy(std::string_view message) {
    const std::string_view file = message.substr(0, message.find(": "));
    const std::string folder = fs::path(file).parent_path().string();
    if (contains(message, ": version `") && contains(message, "' not found")) {
        const bool is_systems = folder.starts_with("/lib") || folder.starts_with("/usr/lib");
        return is_systems ? fmt::format("; {} is older than the driver needs: update its package", file)
                          : fmt::format(
                                "; an older {} is loaded first: leave {} out of LD_LIBRARY_PATH and "
                                "LD_PRELOAD, or start outside the environment that it is of",
                                fs::path(file).filename().string(), folder);
    }
    if (contains(message, kNoFile) && fs::path(file).filename().string().starts_with("libnvidia-"))
        return fmt::format("; {} comes with NVIDIA's driver: install all its libraries of one version, or {}",
                           file, kAskGraphics);
    if (contains(message, kNoFile))
        return fmt::format("; install the package that has {} (apt-file search {})", file, file);
    if (contains(message, "wrong ELF class")) return "; it is for another kind of processor";
    if (contains(message, "undefined symbol"))
        return "; libraries of different versions are mixed: install its package again";
    if (contains(message, "file too short") || contains(message, "invalid ELF header"))
        return "; the file is damaged: put it back from its package";
    return "";
}

std::vector<std::string> hardware_faults(const fs::path& root) {
    Texts faults;
    const std::vector<Vendor> vendors = read_vendors(root);
    for (const Vendor& vendor : vendors)
        if (!vendor.fault.empty()) faults.push_back(vendor.fault);
    add_nvidia_faults(root, vendors, faults);
    const std::vector<fs::path> files = gpu_files(root);
    for (const fs::path& file : files)
        if (std::string fault = node_fault(file); !fault.empty()) faults.push_back(std::move(fault));
    if (files.empty()) add_faults_of_absent_files(root, faults);
    else if (const std::string value = variable("LIBGL_ALWAYS_SOFTWARE"); !value.empty())
        faults.push_back(fmt::format("LIBGL_ALWAYS_SOFTWARE={} keeps Mesa in software; unset it", value));
    return faults;
}

std::vector<std::string> software_faults(const fs::path& root) {
    Texts faults;
    const std::vector<Vendor> vendors = read_vendors(root);
    const auto mesa = std::ranges::find_if(vendors, [](const Vendor& one) { return one.is_of("mesa"); });
    if (mesa != vendors.end() && mesa->entry) {
        add_dri_faults(*mesa, faults);
        return faults;
    }
    for (const Vendor& vendor : vendors)
        if (!vendor.fault.empty()) faults.push_back(vendor.fault);
    if (mesa != vendors.end()) return faults;
    const std::string chosen = chosen_vendors();
    if (has_glvnd())
        faults.push_back(chosen.empty()
                             ? "no vendor file names Mesa's EGL; install the Debian package libegl-mesa0"
                             : chosen + " leaves Mesa out; unset it");
    return faults;
}

bool has_gpu_file(const fs::path& root) {
    return !gpu_files(root).empty();
}

}  // namespace aftershade::gpu
