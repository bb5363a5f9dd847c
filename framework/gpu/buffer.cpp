#include "framework/gpu/buffer.h"

#include <cassert>
#include <utility>

#include <fmt/format.h>

#include "framework/core/error.h"
#include "framework/gpu/context_impl.h"

namespace aftershade::gpu {
namespace {

/// Uniform blocks round their size up to a vec4; a shorter buffer is undefined behaviour.
constexpr std::size_t kGranule = 16;

}  // namespace

Buffer::Buffer(Context& context, std::size_t bytes, std::string label)
    : context_(&context), bytes_(bytes), label_(std::move(label)) {
    if (bytes_ == 0)
        throw Error(ExitCode::effect, fmt::format("buffer '{}': 0 bytes; it must hold something", label_));
    context.make_current();
    const GladGLContext& gl = context.gl();
    gl.CreateBuffers(1, &handle_);
    const std::size_t stored = (bytes_ + kGranule - 1) / kGranule * kGranule;
    gl.NamedBufferStorage(handle_, static_cast<GLsizeiptr>(stored), nullptr, GL_DYNAMIC_STORAGE_BIT);
    set_label(gl, GL_BUFFER, handle_, label_);
    try {
        context.check(fmt::format("buffer '{}', {} bytes", label_, bytes_));
        clear(0);
    } catch (const Error&) {
        gl.DeleteBuffers(1, &handle_);
        throw;
    }
}

Buffer::~Buffer() {
    if (handle_ == 0 || !context_->impl().try_make_current()) return;
    context_->gl().DeleteBuffers(1, &handle_);
}

Buffer::Buffer(Buffer&& other) noexcept
    : context_(other.context_),
      handle_(std::exchange(other.handle_, 0)),
      bytes_(std::exchange(other.bytes_, 0)),
      label_(std::move(other.label_)) {}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    std::swap(context_, taken.context_);
    std::swap(handle_, taken.handle_);
    std::swap(bytes_, taken.bytes_);
    std::swap(label_, taken.label_);
    return *this;
}

void Buffer::write(std::span<const std::byte> values, std::size_t offset) {
    assert(offset <= bytes_ && values.size() <= bytes_ - offset);
    if (values.empty()) return;
    context_->make_current();
    context_->impl().wait_for_draws();
    context_->gl().NamedBufferSubData(handle_, static_cast<GLintptr>(offset),
                                      static_cast<GLsizeiptr>(values.size()), values.data());
    context_->check(fmt::format("writing buffer '{}'", label_));
}

std::vector<std::byte> Buffer::read() const {
    context_->make_current();
    context_->impl().wait_for_draws();
    std::vector<std::byte> values(bytes_);
    context_->gl().GetNamedBufferSubData(handle_, 0, static_cast<GLsizeiptr>(bytes_), values.data());
    context_->check(fmt::format("reading buffer '{}'", label_));
    return values;
}

void Buffer::clear(std::uint32_t value) {
    context_->make_current();
    context_->impl().wait_for_draws();
    context_->gl().ClearNamedBufferData(handle_, GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, &value);
    context_->check(fmt::format("clearing buffer '{}'", label_));
}

}  // namespace aftershade::gpu
