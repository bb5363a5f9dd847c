#include "framework/gpu/device.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "framework/base/error.h"
#include "framework/base/text.h"

namespace aftershade::gpu {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCuda = "cuda:", kGpu = "GPU-";
constexpr const char* kCudaVisible = "CUDA_VISIBLE_DEVICES";

std::optional<int> whole_number(std::string_view text, int base = 10) {
    int value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value, base);
    if (text.empty() || failure != std::errc() || end != text.data() + text.size() || value < 0)
        return std::nullopt;
    return value;
}

/// "65:00.0" and "00000000:65:00.0", as nvidia-smi has it, as "0000:65:00.0"; "" for anything else.
std::string pci_address(std::string_view text) {
    const std::size_t dot = text.rfind('.'), colon = text.rfind(':', dot);
    if (dot == text.npos || colon == text.npos) return "";
    const std::string_view before = text.substr(0, colon);
    const std::size_t domain_end = before.rfind(':');
    const auto domain = domain_end == before.npos ? 0 : whole_number(before.substr(0, domain_end), 16);
    const auto bus = whole_number(domain_end == before.npos ? before : before.substr(domain_end + 1), 16);
    const auto slot = whole_number(text.substr(colon + 1, dot - colon - 1), 16);
    const auto function = whole_number(text.substr(dot + 1), 16);
    if (!domain || !bus || !slot || !function) return "";
    return fmt::format("{:04x}:{:02x}:{:02x}.{:x}", *domain, *bus, *slot, *function);
}

/// The address of the card whose node this is, by /sys/class/drm.
std::string pci_of_node(const fs::path& root, const std::string& node) {
    if (node.empty()) return "";
    std::error_code failure;
    const fs::path device =
        fs::canonical(root / "sys/class/drm" / fs::path(node).filename() / "device", failure);
    return failure ? "" : pci_address(device.filename().string());
}

/// UUIDs of NVIDIA's cards by address, from /proc/driver/nvidia/gpus/ADDRESS/information.
std::map<std::string, std::string> nvidia_uuids(const fs::path& root) {
    std::map<std::string, std::string> uuids;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(root / "proc/driver/nvidia/gpus", failure)) {
        std::ifstream file(entry.path() / "information");
        for (std::string line; std::getline(file, line);)
            if (line.starts_with("GPU UUID:"))
                uuids[pci_address(entry.path().filename().string())] =
                    line.substr(line.find_last_of(" \t") + 1);
    }
    return uuids;
}

std::string bare_uuid(std::string_view uuid) {
    return lower_case(uuid.starts_with(kGpu) ? uuid.substr(kGpu.size()) : uuid);
}

bool is_uuid(const Device& device, std::string_view name) {
    if (device.uuid.empty() || name.size() <= kGpu.size()) return false;
    const std::string mine = bare_uuid(device.uuid), asked = bare_uuid(name);
    return name.starts_with(kGpu) ? mine.starts_with(asked) : mine == asked;
}

bool is_named(const Device& device, const std::string& name) {
    if (const auto index = whole_number(name)) return device.index == *index;
    if (name.starts_with(kCuda)) {
        const auto number = whole_number(std::string_view(name).substr(kCuda.size()));
        return number && device.cuda == number;
    }
    if (const std::string pci = pci_address(name); !pci.empty() && device.pci == pci) return true;
    std::error_code failure;
    // Nodes have links to them, such as /dev/dri/by-path/pci-0000:65:00.0-render.
    const fs::path node =
        name.starts_with("/") ? fs::weakly_canonical(name, failure) : fs::path("/dev/dri") / name;
    return node == device.card || node == device.render_node || is_uuid(device, name);
}

void apply_cuda_visible(std::vector<Device>& devices, std::string_view variable) {
    std::vector<std::string_view> entries = split(variable, ',');
    for (std::string_view& entry : entries) entry = trimmed(entry);
    int most = -1;
    for (const Device& device : devices) most = std::max(most, device.cuda.value_or(-1));
    // Of a driver that numbers no card, a number here says nothing.
    if (most < 0 && whole_number(entries.front())) return;
    // A driver numbers either all cards or, as CUDA itself, those that the variable leaves.
    const bool numbers_all = most >= int(entries.size());
    std::map<int, int> numbers;  // of CUDA in this process, by index
    for (int i = 0; i < int(entries.size()); ++i) {
        const std::string_view entry = entries[std::size_t(i)];
        const auto number = whole_number(entry);
        const auto found = std::ranges::find_if(devices, [&](const Device& device) {
            if (!device.has_cuda) return false;
            return number ? device.cuda == (numbers_all ? *number : i)
                          : entry.starts_with(kGpu) && is_uuid(device, entry);
        });
        if (found == devices.end() || !numbers.emplace(found->index, i).second) break;  // as CUDA does
    }
    for (Device& device : devices) {
        if (!device.has_cuda) continue;
        const auto number = numbers.find(device.index);
        device.is_hidden = number == numbers.end();
        device.cuda = device.is_hidden ? std::nullopt : std::optional(number->second);
    }
}

std::string list_text(const std::vector<Device>& devices) {
    std::vector<std::string> texts;
    for (const Device& device : devices) texts.push_back(device.text());
    return joined(texts, ", ");
}

}  // namespace

std::vector<std::string> Device::names() const {
    std::vector<std::string> names{std::to_string(index)};
    for (const std::string* name : {&card, &render_node, &pci, &uuid})
        if (!name->empty()) names.push_back(*name);
    if (cuda) names.push_back(fmt::format("{}{}", kCuda, *cuda));
    return names;
}

std::string Device::name() const {
    return !card.empty() ? card : !render_node.empty() ? render_node : fmt::format("EGL device {}", index);
}

std::string Device::text() const {
    std::vector<std::string> others = names();
    others.erase(others.begin());
    if (is_software) others.emplace_back("software");
    return others.empty() ? std::to_string(index) : fmt::format("{} ({})", index, joined(others, ", "));
}

void complete_devices(std::vector<Device>& devices, const fs::path& root) {
    const auto uuids = nvidia_uuids(root);
    for (Device& device : devices) {
        if (device.pci.empty()) device.pci = pci_of_node(root, device.card);
        if (device.pci.empty()) device.pci = pci_of_node(root, device.render_node);
        for (const auto& [pci, uuid] : uuids) {
            if (device.pci.empty() && is_uuid(device, uuid)) device.pci = pci;
            if (device.uuid.empty() && device.has_cuda && device.pci == pci) device.uuid = uuid;
        }
    }
    if (const char* variable = std::getenv(kCudaVisible)) apply_cuda_visible(devices, variable);
}

std::string uuid_text(const std::array<unsigned char, 16>& bytes, bool is_nvidia) {
    if (std::ranges::all_of(bytes, [](unsigned char byte) { return byte == 0; })) return "";
    std::string text = fmt::format("{:02x}", fmt::join(bytes, ""));
    for (const std::size_t at : {20, 16, 12, 8}) text.insert(at, "-");
    return (is_nvidia ? std::string(kGpu) : "") + text;
}

bool names_one_device(std::string_view name) {
    return !name.empty() && name != "all";
}

std::vector<Device> devices_named(const std::vector<Device>& devices, std::string_view name) {
    std::vector<Device> found;
    if (!names_one_device(name)) {
        std::ranges::copy_if(devices, std::back_inserter(found),
                             [](const Device& device) { return !device.is_hidden; });
        if (std::getenv(kCudaVisible))
            std::ranges::stable_sort(found, {}, [](const Device& device) {
                return device.cuda.value_or(std::numeric_limits<int>::max());
            });
        return found;
    }
    std::ranges::copy_if(devices, std::back_inserter(found),
                         [&](const Device& device) { return is_named(device, std::string(name)); });
    if (found.size() == 1 && !found.front().is_hidden) return found;
    const std::string subject = fmt::format("device '{}'", printable(name));
    if (found.empty())
        throw Error(ErrorKind::usage,
                    subject + " is not there; " +
                        (devices.empty() ? "EGL lists no device" : "EGL lists " + list_text(devices)));
    if (found.size() > 1)
        throw Error(ErrorKind::usage, subject + " may be each of " + list_text(found) + "; name one");
    throw Error(ErrorKind::usage,
                subject + ": " + hidden_text(found) + "; name another one, or change the variable");
}

std::string device_fault(std::string_view name) {
    const std::vector<Device> devices = names_one_device(name) ? list_devices() : std::vector<Device>();
    try {
        if (!devices.empty()) devices_named(devices, name);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

std::string device_of_part(const std::vector<Device>& devices, Backend backend, int part) {
    if (backend != Backend::automatic && backend != Backend::egl) return "";
    std::vector<Device> cards = devices_named(devices, "all");
    std::erase_if(cards, &Device::is_software);
    return cards.empty() ? "" : std::to_string(cards[std::size_t(part) % cards.size()].index);
}

std::string hidden_text(const std::vector<Device>& devices) {
    std::vector<Device> hidden;
    std::ranges::copy_if(devices, std::back_inserter(hidden), &Device::is_hidden);
    const char* variable = std::getenv(kCudaVisible);
    return hidden.empty()
               ? ""
               : fmt::format("{}={} hides {}", kCudaVisible, variable ? variable : "", list_text(hidden));
}

}  // namespace aftershade::gpu
