#include "framework/gpu/buffer.h"

#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "framework/base/error.h"
#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

/// Uniform blocks round their size up to a vec4; a shorter buffer is undefined behaviour.
constexpr std::size_t kGranule = 16;

}  // namespace

template <>
void Handle<ObjectKind::buffer>::remove(Context& context, unsigned int name) noexcept {
    if (context.impl().try_make_current()) context.gl().DeleteBuffers(1, &name);
}

Buffer::Buffer(Context& context, std::size_t bytes, std::string label)
    : bytes_(bytes), label_(std::move(label)) {
    if (bytes_ == 0)
        throw Error(ErrorKind::effect, fmt::format("buffer '{}': 0 bytes; it must hold something", label_));
    context.make_current();
    const GladGLContext& gl = context.gl();
    GLuint name = 0;
    gl.CreateBuffers(1, &name);
    handle_ = Handle<ObjectKind::buffer>(context, name);
    const std::size_t stored = (bytes_ + kGranule - 1) / kGranule * kGranule;
    gl.NamedBufferStorage(name, static_cast<GLsizeiptr>(stored), nullptr, GL_DYNAMIC_STORAGE_BIT);
    set_label(gl, GL_BUFFER, name, label_);
    context.check(fmt::format("buffer '{}', {} bytes", label_, bytes_));
    clear(0);
}

void Buffer::write(std::span<const std::byte> values, std::size_t offset) {
    assert(offset <= bytes_ && values.size() <= bytes_ - offset);
    if (values.empty()) return;
    handle_.context().make_current();
    handle_.context().impl().wait_for_draws();
    handle_.context().gl().NamedBufferSubData(handle(), static_cast<GLintptr>(offset),
                                              static_cast<GLsizeiptr>(values.size()), values.data());
    handle_.context().check(fmt::format("writing buffer '{}'", label_));
}

std::vector<std::byte> Buffer::read() const {
    handle_.context().make_current();
    handle_.context().impl().wait_for_draws();
    std::vector<std::byte> values(bytes_);
    handle_.context().gl().GetNamedBufferSubData(handle(), 0, static_cast<GLsizeiptr>(bytes_), values.data());
    handle_.context().check(fmt::format("reading buffer '{}'", label_));
    return values;
}

void Buffer::clear(std::uint32_t value) {
    handle_.context().make_current();
    handle_.context().impl().wait_for_draws();
    handle_.context().gl().ClearNamedBufferData(handle(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    handle_.context().check(fmt::format("clearing buffer '{}'", label_));
}

}  // namespace aftershade::gpu
