// The devices that EGL draws on, by every name that people have for a card.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/gpu/backend.h"

namespace aftershade::gpu {

/// A string is empty, and a number absent, where neither EGL nor the system has it.
struct Device {
    int index = 0;              ///< in EGL's list, whose order is not CUDA's
    std::string renderer{};     ///< GL_RENDERER
    std::string card{};         ///< node of DRM: "/dev/dri/card0"
    std::string render_node{};  ///< "/dev/dri/renderD128"
    std::string pci{};          ///< address: "0000:65:00.0"
    std::string uuid{};         ///< "6bcd0a81-..."; of NVIDIA "GPU-6bcd0a81-..."
    std::optional<int> cuda{};  ///< CUDA's number in this process
    bool has_cuda = false;      ///< draws by NVIDIA's driver (EGL_NV_device_cuda)
    bool is_software = false;
    bool is_hidden = false;  ///< CUDA_VISIBLE_DEVICES leaves it out

    /// What --device takes for it, the index first.
    std::vector<std::string> names() const;
    /// The node, or else "EGL device 0".
    std::string name() const;
    /// "0 (/dev/dri/card0, /dev/dri/renderD128, 0000:65:00.0, GPU-6bcd0a81-..., cuda:0)"
    std::string text() const;
};

/// Every device of EGL; none where there is no EGL. Makes no context. [any thread]
std::vector<Device> list_devices();

/// Whether the files below `root` have a GPU's device file, so that drawing on hardware is expected.
bool has_gpu_file(const std::filesystem::path& root);

/// Adds what /sys and /proc below `root` have: the address on PCI, NVIDIA's UUID. Where CUDA_VISIBLE_DEVICES
/// is set, NVIDIA's cards get the numbers that CUDA gives them in this process, and those that it does not
/// list are hidden.
void complete_devices(std::vector<Device>& devices, const std::filesystem::path& root);

/// "6bcd0a81-...", with "GPU-" before it for NVIDIA's; "" for zeros, which mean none.
std::string uuid_text(const std::array<unsigned char, 16>& bytes, bool is_nvidia);

/// Whether `name` names one device: it is neither empty nor "all".
bool names_one_device(std::string_view name);

/// The device with this name: an index, a node of DRM, an address on PCI, a UUID (with "GPU-" its beginning
/// is enough) or cuda:N. Of "" and "all", every device that is not hidden, CUDA's in CUDA's order before the
/// others where CUDA_VISIBLE_DEVICES orders them. Throws Error(ErrorKind::usage), listing what there is.
std::vector<Device> devices_named(const std::vector<Device>& devices, std::string_view name);

/// What devices_named() says of a name that no device of this machine has; "" where one has it, and where EGL
/// lists none, which a context explains.
std::string device_fault(std::string_view name);

/// The index of the GPU for worker or chunk `part`, counted from 0, so that parts go evenly to all GPUs. ""
/// where EGL lists none, or the backend draws in software.
std::string device_of_part(const std::vector<Device>& devices, Backend backend, int part);

/// "CUDA_VISIBLE_DEVICES=1 hides 0 (...)"; "" where no device is hidden.
std::string hidden_text(const std::vector<Device>& devices);

}  // namespace aftershade::gpu
