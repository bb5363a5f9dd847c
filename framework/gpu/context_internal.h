// What a Context is made of. Internal to framework/gpu, whose sources alone see GL's types.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/gpu/object_cache.h"
#include "framework/gpu/platform.h"
#include "framework/gpu/transfers.h"

#include <glad/gl.h>

namespace aftershade::gpu {

class Buffer;
class HalfKernels;

struct Limits {
    int texture_size = 0;
    int array_layers = 0;
    int colour_attachments = 0;
    std::int64_t uniform_block_bytes = 0;
    std::int64_t storage_block_bytes = 0;
};

struct Context::Impl {
    /// Throws Error(ErrorKind::gl) whose message is the reason alone; else current in this thread.
    explicit Impl(const GlChoice& choice);
    explicit Impl(const SharedEglContext& shared);
    explicit Impl(const Impl& other, std::unique_ptr<Platform> made);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void make_current();
    /// For destructors: false where make_current() throws, and after Context::abandon().
    bool try_make_current() noexcept;
    void release() noexcept;
    /// Leaves this thread without the context that is current in it, if one is.
    static void release_current() noexcept;
    /// Call before GL touches a texture's or a buffer's memory from the CPU (read, write, clear): llvmpipe
    /// (Mesa 22.3.6) gives back a target as it was before a draw still in flight, where another target was
    /// drawn to since.
    void wait_for_draws() const {
        if (info.software) gl.Finish();
    }

    std::unique_ptr<Platform> platform;
    GladGLContext gl{};
    ContextInfo info;
    Limits limits;
    std::vector<std::string> errors;  ///< what KHR_debug reported since the last check()
    GLuint vertex_array = 0;          ///< empty; core profile draws nothing without one
    GLuint pipeline = 0;              ///< of programs with one stage each
    std::unique_ptr<ObjectCache> cache;
    std::unique_ptr<Transfers> transfers;
    std::shared_ptr<HalfKernels> half_kernels;  ///< made where they are first needed
    std::vector<GLuint> free_queries;           ///< of GL_TIMESTAMP
    std::size_t queries_made = 0;
    ObjectCounts handles;  ///< of Handle alone
    bool abandoned = false;
    bool is_untested = false;               ///< SelfTest::at_first_use
    std::optional<bool> zeroes_textures{};  ///< Context::zeroes_new_textures(), once it is known
    const Buffer* nothing = nullptr;        ///< of NothingToDo: zero work groups

private:
    void start();
    void load_functions();
    void set_state();
    void watch_errors();
};

/// `text` cut to what every driver takes as a label or a debug group's name (GL_MAX_LABEL_LENGTH is at least
/// 256).
std::string_view debug_text(std::string_view text);
void set_label(const GladGLContext& gl, GLenum kind, GLuint handle, std::string_view text);

}  // namespace aftershade::gpu
