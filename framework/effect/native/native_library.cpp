#include "framework/effect/native/native_library.h"

#include <dlfcn.h>

#include <algorithm>

#include "framework/base/error.h"
#include "framework/effect/native/native_host.h"
#include "framework/effect/native/native_process.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kEntryName = "aftershade_library_entry";
// Far above any real library: a count of rubbish must not keep the host busy.
constexpr std::uint32_t kMaxFactories = 1000;

std::string last_dl_error() {
    const char* text = dlerror();
    return text ? text : "unknown reason";
}

}  // namespace

NativeLibrary::NativeLibrary(void* handle, std::string place)
    : handle_(handle), place_(std::move(place)), host_(std::make_unique<NativeHost>()) {}

NativeLibrary::~NativeLibrary() {
    try {
        if (deinit_) call_plugin(place_ + ": deinit", deinit_);
    } catch (const Error&) {  // the work is done; there is nobody left to tell
    }
    if (handle_) dlclose(handle_);
}

std::shared_ptr<NativeLibrary> NativeLibrary::open(const fs::path& path) {
    std::error_code failure;
    if (!fs::is_regular_file(path, failure))
        throw Error(ErrorKind::effect, path.string() + ": no such file; expected a shared library");
    // An absolute path, for dlopen searches the system's folders for a name without a slash.
    void* handle = dlopen(fs::absolute(path).c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!handle)
        throw Error(ErrorKind::effect,
                    path.string() + ": cannot be loaded as a shared library: " + last_dl_error());
    const std::shared_ptr<NativeLibrary> library(new NativeLibrary(handle, path.string()));
    const void* entry = dlsym(handle, kEntryName);
    if (!entry)
        throw Error(ErrorKind::effect,
                    path.string() + ": exports no symbol '" + kEntryName +
                        "'; define it as framework/plugin/aftershade_plugin.h shows, or take "
                        "the file out of the plug-in folder");
    library->start(*static_cast<const aftershade_library*>(entry));
    return library;
}

std::shared_ptr<NativeLibrary> NativeLibrary::open_in(std::shared_ptr<NativeProcess> process,
                                                      const fs::path& path) {
    const NativeProcess::Offer offer = process->open(path);
    const std::shared_ptr<NativeLibrary> library(new NativeLibrary(nullptr, path.string()));
    library->process_ = std::move(process);
    library->contact_ = offer.contact;
    for (const auto& [id, version] : offer.effects) library->effects_.push_back({id, version, nullptr});
    return library;
}

std::shared_ptr<NativeLibrary> NativeLibrary::adopt(const StaticNativeLibrary& linked) {
    const std::shared_ptr<NativeLibrary> library(
        new NativeLibrary(nullptr, std::string(linked.source) + " (linked into this program)"));
    library->start(*linked.entry);
    return library;
}

void NativeLibrary::start(const aftershade_library& entry) {
    const aftershade_library checked = checked_library(entry, place_);
    if (checked.contact) contact_ = checked.contact;
    if (checked.init) {
        if (!call_plugin(place_ + ": init", [&] { return checked.init(host_->get()); })) {
            const std::string text = host_->take_error();
            throw Error(ErrorKind::effect,
                        place_ + ": the library '" + checked.name + "' " + checked.version +
                            " refused to start: " + (text.empty() ? "no reason given" : text));
        }
    }
    deinit_ = checked.deinit;
    list_effects(checked);
}

void NativeLibrary::list_effects(const aftershade_library& library) {
    if (library.factory_count > kMaxFactories)
        throw Error(ErrorKind::effect, place_ + ": factory_count is " +
                                           std::to_string(library.factory_count) + ", above the limit " +
                                           std::to_string(kMaxFactories));
    for (std::uint32_t index = 0; index < library.factory_count; ++index) {
        const aftershade_factory* found =
            call_plugin(place_ + ": get_factory", [&] { return library.get_factory(index); });
        const aftershade_factory factory = checked_factory(found, place_);
        const auto same = [&](const Effect& effect) { return effect.id == factory.effect_id; };
        if (std::any_of(effects_.begin(), effects_.end(), same))
            throw Error(ErrorKind::effect, place_ + ": offers the effect '" + factory.effect_id +
                                               "' twice; give each its own id");
        effects_.push_back({factory.effect_id, factory.effect_version, found});
    }
}

}  // namespace aftershade
