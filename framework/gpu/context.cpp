#include "framework/gpu/context.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/text.h"
#include "framework/gpu/backend.h"
#include "framework/gpu/context_internal.h"
#include "framework/gpu/device.h"
#include "framework/gpu/driver_cache.h"
#include "framework/gpu/egl_current.h"
#include "framework/gpu/flushed_denormals.h"
#include "framework/gpu/fork_guard.h"
#include "framework/gpu/handle.h"
#include "framework/gpu/platform.h"

namespace aftershade::gpu {

namespace {

// The platform of a backend.

/// The platform of one backend. Throws Error(ErrorKind::gl) whose message is the reason alone, and
/// Error(ErrorKind::usage) where no device has the name of the choice.
std::unique_ptr<Platform> make_platform(const GlChoice& choice) {
    prepare_driver_cache();
    const bool is_osmesa = choice.backend == Backend::osmesa;
    if (is_osmesa && names_one_device(choice.device))
        throw Error(ErrorKind::gl, "OSMesa draws on no device; name none, or take another backend");
    if (is_osmesa) return make_osmesa_platform();
    return make_egl_platform(
        choice.backend == Backend::egl_software ? Renderer::software : Renderer::hardware, choice.device);
}

constexpr std::size_t kMaxErrors = 16;
constexpr std::size_t kMaxDebugText = 255;
/// What is current in this thread; EGL and OSMesa share Mesa's slot and would not see each other's change.
thread_local Context::Impl* current = nullptr;

std::string error_name(GLenum code) {
    switch (code) {
        case GL_INVALID_ENUM: return "GL_INVALID_ENUM";
        case GL_INVALID_VALUE: return "GL_INVALID_VALUE";
        case GL_INVALID_OPERATION: return "GL_INVALID_OPERATION";
        case GL_INVALID_FRAMEBUFFER_OPERATION: return "GL_INVALID_FRAMEBUFFER_OPERATION";
        case GL_OUT_OF_MEMORY: return "GL_OUT_OF_MEMORY";
        case GL_CONTEXT_LOST: return "GL_CONTEXT_LOST";
        default: return fmt::format("GL error 0x{:04x}", code);
    }
}

void GLAD_API_PTR on_debug_message(GLenum, GLenum type, GLuint, GLenum, GLsizei length, const GLchar* message,
                                   const void* user) {
    auto& errors = *static_cast<std::vector<std::string>*>(const_cast<void*>(user));
    if (type != GL_DEBUG_TYPE_ERROR || errors.size() >= kMaxErrors) return;
    errors.push_back(length < 0 ? std::string(message)
                                : std::string(message, static_cast<std::size_t>(length)));
}

}  // namespace

void load_ahead(Backend backend) noexcept {
    // Its size would count against what a context requires.
    if (backend != Backend::osmesa || address_space_left()) return;
    try {
        load_osmesa();
    } catch (const std::exception&) {
    }
}

Context::~Context() {
    if (impl_) impl_->half_kernels.reset();  // its objects refer to this
}

const ContextInfo& Context::info() const {
    return impl_->info;
}

void Context::make_current() {
    impl_->make_current();
}

void Context::release() noexcept {
    if (current == impl_.get() && !is_forked_from_gl()) impl_->release();
}

void Context::abandon() noexcept {
    impl_->abandoned = true;
}

void count_object(Context& context, ObjectKind kind, int by) noexcept {
    ObjectCounts& counts = context.impl().handles;
    (kind == ObjectKind::buffer    ? counts.buffers
     : kind == ObjectKind::texture ? counts.textures
                                   : counts.programs) += std::size_t(by);
}

ObjectCounts Context::objects() const {
    ObjectCounts counts = impl_->handles;
    counts.framebuffers = impl_->cache->framebuffer_count();
    counts.views = impl_->cache->view_count();
    return counts;
}

TransferUse Context::transfer_use() const {
    return impl_->transfers->use();
}

void Context::finish() {
    make_current();
    impl_->gl.Finish();
}

void Context::check(std::string_view what) {
    make_current();
    std::vector<std::string> reported = std::exchange(impl_->errors, {});
    const bool described = !reported.empty();
    // Bounded, since a lost context reports an error for ever.
    for (std::size_t i = 0; i < kMaxErrors; ++i) {
        const GLenum code = impl_->gl.GetError();
        if (code == GL_NO_ERROR) break;
        if (!described) reported.push_back(error_name(code));
    }
    if (reported.empty()) return;
    const bool is_memory = std::ranges::any_of(
        reported, [](const std::string& text) { return text.find("GL_OUT_OF_MEMORY") != std::string::npos; });
    if (is_memory) abandon();
    throw Error(is_memory ? ErrorKind::memory : ErrorKind::effect,
                fmt::format("{}{}: {} [{}]", is_memory ? "out of memory: " : "", what,
                            fmt::join(reported, "; "), impl_->info.renderer));
}

const GladGLContext& Context::gl() const {
    return impl_->gl;
}

Context::Impl::Impl(const GlChoice& choice) {
    const FlushedDenormals of_the_threads_of_mesa;
    watch_for_forks();
    if (current) current->release();
    platform = make_platform(choice);
    info.backend = choice.backend;
    start();
}

Context::Impl::Impl(const SharedEglContext& shared) {
    watch_for_forks();
    if (current) current->release();
    platform = make_egl_platform(shared);
    start();
    info.backend = info.software ? Backend::egl_software : Backend::egl;
}

Context::Impl::Impl(const Impl& other, std::unique_ptr<Platform> made) : platform(std::move(made)) {
    info.backend = other.info.backend;
    start();
}

/// What the platform made current becomes a usable context.
void Context::Impl::start() {
    current = this;
    try {
        load_functions();
        info.maps_transfers = chosen_transfer_way(info.software) == TransferWay::mapped;
    } catch (...) {
        release();
        throw;
    }
    cache = std::make_unique<ObjectCache>(gl);
    watch_errors();
    set_state();
    const auto way = info.maps_transfers ? TransferWay::mapped : TransferWay::direct;
    transfers = std::make_unique<Transfers>(gl, way, [this] {
        while (gl.GetError() != GL_NO_ERROR) {
        }
        errors.clear();
    });
}

Context::Impl::~Impl() {
    if (abandoned || is_forked_from_gl()) {  // what these own goes with the process
        static_cast<void>(cache.release());
        static_cast<void>(transfers.release());
        static_cast<void>(platform.release());
        return;
    }
    if (!try_make_current()) return;
    gl.DebugMessageCallback(nullptr, nullptr);
    cache.reset();
    transfers.reset();
    gl.DeleteQueries(static_cast<GLsizei>(free_queries.size()), free_queries.data());
    gl.DeleteVertexArrays(1, &vertex_array);
    gl.DeleteProgramPipelines(1, &pipeline);
    release();
}

void Context::Impl::make_current() {
    require_not_forked();
    if (current == this) return;
    if (current) current->release();
    platform->make_current();
    current = this;
}

bool Context::Impl::try_make_current() noexcept {
    if (abandoned) return false;
    try {
        make_current();
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

ForeignContextGuard::ForeignContextGuard() : found_(current_egl_context()) {
    if (current && current->platform->is_current()) {
        found_ = {nullptr, nullptr, nullptr, nullptr, found_.api};
        return;
    }
    current = nullptr;
    // EGL and OSMesa would not see each other's change.
    if (found_.context) release_egl_context(found_);
}

ForeignContextGuard::~ForeignContextGuard() {
    if (found_.context && current) current->release();
    restore_egl_context(found_);
}

void Context::Impl::release_current() noexcept {
    if (current) current->release();
}

void Context::Impl::release() noexcept {
    platform->release();
    current = nullptr;
}

void Context::Impl::load_functions() {
    const auto load = [](void* user, const char* name) {
        return static_cast<const Platform*>(user)->proc(name);
    };
    const int version = gladLoadGLContextUserPtr(&gl, load, platform.get());
    info.renderer = gl_string(*platform, GL_RENDERER);
    info.version = gl_string(*platform, GL_VERSION);
    info.vendor = gl_string(*platform, GL_VENDOR);
    info.device = platform->device();
    info.software = is_software_renderer(info.renderer);
    if (version < GLAD_MAKE_VERSION(4, 5)) {
        throw Error(ErrorKind::gl,
                    fmt::format("{} offers GL '{}'; 4.5 core is needed", info.renderer, info.version));
    }
}

void Context::Impl::set_state() {
    gl.PixelStorei(GL_PACK_ALIGNMENT, 1);
    gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl.Disable(GL_DITHER);
    // docs/architecture.md, Conventions: NDC y up, z in [0, 1], texel row 0 at the top.
    gl.ClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
    gl.CreateVertexArrays(1, &vertex_array);
    gl.CreateProgramPipelines(1, &pipeline);
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limits.texture_size);
    info.texture_side_px = limits.texture_size;
    gl.GetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &limits.array_layers);
    gl.GetIntegerv(GL_MAX_COLOR_ATTACHMENTS, &limits.colour_attachments);
    if (info.software) gl.GetIntegerv(GL_MAX_FRAGMENT_IMAGE_UNIFORMS, &info.load_units);
    gl.GetInteger64v(GL_MAX_UNIFORM_BLOCK_SIZE, &limits.uniform_block_bytes);
    gl.GetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &limits.storage_block_bytes);
}

void Context::Impl::watch_errors() {
    gl.Enable(GL_DEBUG_OUTPUT);
    gl.Enable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    gl.DebugMessageControl(GL_DONT_CARE, GL_DONT_CARE, GL_DONT_CARE, 0, nullptr, GL_FALSE);
    gl.DebugMessageControl(GL_DEBUG_SOURCE_API, GL_DEBUG_TYPE_ERROR, GL_DONT_CARE, 0, nullptr, GL_TRUE);
    // Shader messages stay off: Program reads the log, and an error in it must not fail the next pass too.
    gl.DebugMessageCallback(on_debug_message, &errors);
}

std::string_view debug_text(std::string_view text) {
    return text.substr(0, kMaxDebugText);
}

void set_label(const GladGLContext& gl, GLenum kind, GLuint handle, std::string_view text) {
    const std::string_view label = debug_text(text);
    gl.ObjectLabel(kind, handle, static_cast<GLsizei>(label.size()), label.data());
}

}  // namespace aftershade::gpu
