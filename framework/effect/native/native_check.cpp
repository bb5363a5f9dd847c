// Which structs of a plug-in this host takes.
#include <algorithm>
#include <cstring>

#include "framework/base/error.h"
#include "framework/effect/native/native_library.h"

namespace aftershade {

namespace {

// Sizes in ABI 1.0: what a struct must have at least. A field that a later minor appends goes after these.
constexpr std::size_t kLibrarySize10 = offsetof(aftershade_library, contact);
constexpr std::size_t kFactorySize10 = sizeof(aftershade_factory);
constexpr std::size_t kInstanceSize10 = offsetof(aftershade_instance, reset);

// No struct ends in padding: a later minor's field there would lie within an older struct_size.
#define ENDS_WITH(type, field) (sizeof(type) == offsetof(type, field) + sizeof(type::field))
static_assert(ENDS_WITH(aftershade_host, get_extension) && ENDS_WITH(aftershade_params, get_unit));
static_assert(ENDS_WITH(aftershade_camera, clip_from_world) && ENDS_WITH(aftershade_metadata, get_text));
static_assert(ENDS_WITH(aftershade_image, reserved) && ENDS_WITH(aftershade_frame, reserved));
static_assert(ENDS_WITH(aftershade_output, set_overscan) && ENDS_WITH(aftershade_instance, reset));
static_assert(ENDS_WITH(aftershade_factory, create) && ENDS_WITH(aftershade_library, contact));
#undef ENDS_WITH

std::string version_text(std::uint32_t major, std::uint32_t minor) {
    return std::to_string(major) + "." + std::to_string(minor);
}

const std::string& host_version() {
    static const std::string text = version_text(AFTERSHADE_ABI_MAJOR, AFTERSHADE_ABI_MINOR);
    return text;
}

[[noreturn]] void refuse(const std::string& place, const std::string& reason) {
    throw Error(ErrorKind::effect, place + ": " + reason);
}

/// The fields that both sides know; those that the other lacks stay zero.
template <class Struct>
Struct known_fields(const Struct& other, std::size_t size_1_0, const char* name, const std::string& place) {
    if (other.struct_size < size_1_0)
        refuse(place, std::string(name) + ".struct_size is " + std::to_string(other.struct_size) +
                          ", below the " + std::to_string(size_1_0) + " bytes of ABI 1.0; set it to sizeof(" +
                          name + ") and rebuild");
    Struct copy{};
    std::memcpy(&copy, &other, std::min<std::size_t>(other.struct_size, sizeof copy));
    return copy;
}

}  // namespace

aftershade_library checked_library(const aftershade_library& entry, const std::string& place) {
    if (entry.abi_major != AFTERSHADE_ABI_MAJOR)
        refuse(place, "the library is built for plug-in ABI " +
                          version_text(entry.abi_major, entry.abi_minor) + ", this host takes " +
                          std::to_string(AFTERSHADE_ABI_MAJOR) + ".x (its own is " + host_version() +
                          "); rebuild the library with this host's aftershade_plugin.h");
    const aftershade_library library = known_fields(
        entry, kLibrarySize10, "aftershade_library",
        place + ": ABI " + version_text(entry.abi_major, entry.abi_minor) + ", host " + host_version());
    if (!library.name || !library.version) refuse(place, "aftershade_library.name or .version is NULL");
    if (library.factory_count == 0 || !library.get_factory)
        refuse(place, "the library '" + std::string(library.name) +
                          "' offers no effect (factory_count is 0 or get_factory NULL)");
    return library;
}

aftershade_factory checked_factory(const aftershade_factory* factory, const std::string& place) {
    if (!factory) refuse(place, "get_factory returned NULL for an index below factory_count");
    const auto copy = known_fields(*factory, kFactorySize10, "aftershade_factory", place);
    if (!copy.effect_id || !*copy.effect_id || !copy.effect_version || !copy.create)
        refuse(place, "aftershade_factory.effect_id, .effect_version or .create is NULL or empty");
    return copy;
}

aftershade_instance checked_instance(const aftershade_instance* instance, const std::string& place) {
    if (!instance) refuse(place, "create returned NULL");
    const auto copy = known_fields(*instance, kInstanceSize10, "aftershade_instance", place);
    if (!copy.prepare || !copy.destroy) refuse(place, "aftershade_instance.prepare or .destroy is NULL");
    return copy;
}

}  // namespace aftershade
