#include "aftershade/host.h"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/effect/program_store.h"
#include "framework/gpu/device.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/host/rendering.h"

namespace aftershade::host {

namespace fs = std::filesystem;

namespace {

void check_folder(const fs::path& folder, const char* option, Diagnostics& faults) {
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) faults.error({option}, "no folder '" + folder.string() + "'");
}

void check_host_options(const HostOptions& options) {
    Diagnostics faults;
    if (options.data.empty())
        faults.error({"HostOptions::data"},
                     "is empty; give the folder that holds effects, glsl and profiles");
    else
        for (const char* part : {"effects", "glsl", "profiles"})
            check_folder(options.data / part, "HostOptions::data", faults);
    for (const fs::path& folder : options.effect_paths)
        check_folder(folder, "HostOptions::effect_paths", faults);
    for (const fs::path& folder : options.profile_paths)
        check_folder(folder, "HostOptions::profile_paths", faults);
    for (const fs::path& folder : options.plugin_paths)
        check_folder(folder, "HostOptions::plugin_paths", faults);
    if (int(options.backend) < int(Backend::automatic) || int(options.backend) > int(Backend::software))
        faults.error({"HostOptions::backend"}, fmt::format("{} is not a backend", int(options.backend)));
    if (options.share && (!options.share->display || !options.share->context))
        faults.error({"HostOptions::share"}, "display and context may not be null");
    if (options.share && !options.device.empty())
        faults.error({"HostOptions::device"}, "is the device of the shared context; leave it empty");
    if (options.share && options.backend == Backend::osmesa)
        faults.error({"HostOptions::share"}, "EGL objects cannot be shared with OSMesa");
    if (options.limits.max_side_px < 1 || options.limits.max_side_px > kMaxSide_px)
        faults.error({"HostOptions::limits"}, fmt::format("max_side_px is {}; it must be from 1 to {}",
                                                          options.limits.max_side_px, kMaxSide_px));
    if (options.limits.max_image_bytes < 1)
        faults.error({"HostOptions::limits"}, "max_image_bytes is 0; it must be at least 1");
    stop_at_errors(ErrorKind::usage, faults);
}

std::vector<fs::path> with_shipped(std::vector<fs::path> folders, const fs::path& shipped) {
    folders.push_back(shipped);
    return folders;
}

gpu::Backend internal_backend(Backend backend) {
    return gpu::Backend(int(backend));
}
static_assert(int(Backend::automatic) == int(gpu::Backend::automatic) &&
              int(Backend::egl) == int(gpu::Backend::egl) &&
              int(Backend::egl_software) == int(gpu::Backend::egl_software) &&
              int(Backend::osmesa) == int(gpu::Backend::osmesa) &&
              int(Backend::software) == int(gpu::Backend::software));

}  // namespace

Host::Data::Data(HostOptions given) : options(std::move(given)), owner(std::this_thread::get_id()) {
    check_host_options(options);
    natives = std::make_unique<NativeRegistry>(options.plugin_paths);
}

const std::vector<Profile>& Host::Data::profiles() {
    if (!profiles_) {
        Diagnostics faults;
        auto profiles = read_profiles(with_shipped(options.profile_paths, options.data / "profiles"), faults);
        stop_at_errors(ErrorKind::document, faults);
        profiles_ = std::move(profiles);
    }
    return *profiles_;
}

EffectRegistry Host::Data::registry() const {
    return EffectRegistry(with_shipped(options.effect_paths, options.data / "effects"), glsl());
}

gpu::Context& Host::Data::context() {
    if (!context_) {
        Diagnostics faults;
        if (const std::string fault = gpu::device_fault(options.device); !fault.empty())
            faults.error({"HostOptions::device"}, fault);
        stop_at_errors(ErrorKind::usage, faults);
        if (options.share)
            context_ = std::make_unique<gpu::Context>(
                gpu::SharedEglContext{options.share->display, options.share->context});
        else
            context_ = std::make_unique<gpu::Context>(
                gpu::GlChoice(internal_backend(options.backend), options.device));
    }
    context_->make_current();
    return *context_;
}

const std::shared_ptr<ProgramCache>& Host::Data::programs() {
    const ProgramStore store = options.cache.empty() ? ProgramStore() : ProgramStore(options.cache);
    if (!programs_) programs_ = std::make_shared<ProgramCache>(context(), glsl(), store);
    return programs_;
}

void Host::Data::close(bool abandons) noexcept {
    const std::lock_guard lock(mutex);
    if (is_closed) return;
    is_closed = true;
    if (abandons && context_) context_->abandon();
    for (Rendering* rendering : renderings) rendering->drop();
    renderings.clear();
    left.clear();
    programs_.reset();
    context_.reset();
}

Call::Call(Host::Data& host) : data_path_(host.options.data) {
    const std::lock_guard lock(host.mutex);
    if (host.is_closed) fail(ErrorKind::usage, "the host is closed, or was destroyed");
    if (host.owner == std::thread::id()) host.owner = std::this_thread::get_id();
    if (host.owner != std::this_thread::get_id())
        fail(ErrorKind::usage,
             "the host belongs to another thread; make a host for each thread, or call Host::detach() there");
    if (!host.left.empty()) {
        host.context();
        host.left.clear();
    }
}

const char* backend_name(Backend backend) noexcept {
    return gpu::backend_name(internal_backend(backend)).data();  // of literals
}

const char* library_version() noexcept {
    static constexpr auto text = AFTERSHADE_VERSION;
    return text;
}

Host::Host(HostOptions options)
    : data_(with_public_errors([&] { return std::make_shared<Data>(std::move(options)); })) {}
Host::Host(Host&&) noexcept = default;

Host& Host::operator=(Host&& other) noexcept {
    std::swap(data_, other.data_);
    return *this;
}

Host::~Host() {
    if (!data_) return;
    if (gpu::is_forked_from_gl()) {
        gpu::leave_to_exit(std::move(data_));
        return;
    }
    bool is_mine = false;
    {
        const std::lock_guard lock(data_->mutex);
        is_mine = data_->owner == std::thread::id() || data_->owner == std::this_thread::get_id();
    }
    const gpu::ForeignContextGuard foreign;
    data_->close(!is_mine);
}

void Host::close() {
    if (is_closed()) return;
    if (gpu::is_forked_from_gl()) {
        data_->is_closed = true;
        return;
    }
    called(*data_, [&] { data_->close(false); });
}

bool Host::is_closed() const noexcept {
    return !data_ || data_->is_closed;
}

void Host::detach() {
    Data& data = Access::host(*this);
    if (gpu::is_forked_from_gl()) return;
    called(data, [&] {
        data.release();
        const std::lock_guard lock(data.mutex);
        data.owner = {};
    });
}

GlInfo Host::gl() {
    Data& data = Access::host(*this);
    return called(data, [&] {
        const gpu::ContextInfo& info = data.context().info();
        return GlInfo{
            Backend(int(info.backend)), info.renderer, info.version, info.vendor, info.software, info.device,
            info.hardware_fault};
    });
}

std::vector<NameAndSummary> Host::profiles() const {
    Data& data = Access::host(*this);
    return called(data, [&] {
        std::vector<NameAndSummary> list;
        for (const Profile& profile : data.profiles()) list.push_back({profile.id, profile.summary});
        return list;
    });
}

Host::Data& Access::host(const Host& host) {
    if (!host.data_) fail(ErrorKind::usage, "this Host was moved from");
    return *host.data_;
}

}  // namespace aftershade::host
