// The name of one GL object, deleted with its owner.
#pragma once

#include <utility>

namespace aftershade::gpu {

class Context;

enum class ObjectKind { buffer, texture, program };

/// For Context::objects().
void count_object(Context& context, ObjectKind kind, int by) noexcept;

/// Moves leave no name behind, so that a class with such a member needs no move and no destructor of its own.
/// [the context's thread]
template <ObjectKind kind>
class Handle {
public:
    Handle() = default;
    Handle(Context& context, unsigned int name) : context_(&context), name_(name) {
        if (name_ != 0) count_object(*context_, kind, 1);
    }
    ~Handle() {
        if (name_ == 0) return;
        count_object(*context_, kind, -1);
        remove(*context_, name_);
    }
    Handle(Handle&& other) noexcept : context_(other.context_), name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        Handle taken(std::move(other));
        std::swap(context_, taken.context_);
        std::swap(name_, taken.name_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    Context& context() const { return *context_; }
    unsigned int name() const { return name_; }

private:
    static void remove(Context& context, unsigned int name) noexcept;

    Context* context_ = nullptr;
    unsigned int name_ = 0;
};

template <>
void Handle<ObjectKind::buffer>::remove(Context& context, unsigned int name) noexcept;
template <>
void Handle<ObjectKind::texture>::remove(Context& context, unsigned int name) noexcept;
template <>
void Handle<ObjectKind::program>::remove(Context& context, unsigned int name) noexcept;

}  // namespace aftershade::gpu
