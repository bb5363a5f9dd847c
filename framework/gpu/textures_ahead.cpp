#include "framework/gpu/textures_ahead.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <system_error>
#include <utility>

#include "framework/base/memory_limit.h"
#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

/// Below that a context costs more than it saves: one takes 2 ms, and a MiB 0.4 ms.
constexpr std::uint64_t kLeastBytes = 16ull * 1024 * 1024;

}  // namespace

bool TexturesAhead::is_useful(const Context& context, const std::vector<TextureDesc>& descs) {
    std::uint64_t bytes = 0;
    for (const TextureDesc& desc : descs) bytes += byte_size(desc);
    return context.info().software && bytes >= kLeastBytes && !address_space_left();
}

TexturesAhead::TexturesAhead(Context& context, std::vector<TextureDesc> descs) : context_(context) {
    std::ranges::stable_sort(descs, std::greater(), byte_size);
    for (const TextureDesc& desc : descs) textures_.push_back({desc});
    try {
        thread_ = std::thread([this] { work(); });
    } catch (const std::system_error&) {
        is_over_ = true;  // the caller makes everything
    }
}

TexturesAhead::~TexturesAhead() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    if (thread_.joinable()) thread_.join();
    if (!context_.impl().try_make_current()) return;
    for (const Made& made : textures_)
        if (!made.is_taken && made.handle != 0) context_.gl().DeleteTextures(1, &made.handle);
}

std::optional<Texture> TexturesAhead::take(const TextureDesc& desc, const std::string& label) {
    std::unique_lock lock(mutex_);
    const auto found = std::ranges::find_if(
        textures_, [&](const Made& made) { return !made.is_taken && made.desc == desc; });
    if (found == textures_.end()) return std::nullopt;
    found->is_taken = true;
    changed_.wait(lock, [&] { return found->handle != 0 || !found->is_begun || is_over_; });
    if (found->handle == 0) return std::nullopt;
    return Texture(context_, desc, label, found->handle);
}

void TexturesAhead::finish() {
    try {
        make_all(context_);
    } catch (const std::exception&) {
        // Whoever takes it meets the fault.
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] {
        return is_over_ || std::ranges::all_of(
                               textures_, [](const Made& made) { return made.handle != 0 || made.is_taken; });
    });
}

std::size_t TexturesAhead::textures_made() const {
    const std::lock_guard lock(mutex_);
    return std::size_t(std::ranges::count_if(textures_, [](const Made& made) { return made.handle != 0; }));
}

/// The largest that is neither taken nor begun; nullptr: there is nothing to do.
TexturesAhead::Made* TexturesAhead::begin_largest() {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::ranges::find_if(textures_, [](const Made& made) { return !made.is_taken && !made.is_begun; });
    if (stops_ || found == textures_.end()) return nullptr;
    found->is_begun = true;
    return &*found;
}

void TexturesAhead::make_all(Context& context) {
    while (Made* const made = begin_largest()) {
        const unsigned int handle = Texture::made(context, made->desc, "made ahead");
        context.finish();
        const std::lock_guard lock(mutex_);
        made->handle = handle;
        changed_.notify_all();
    }
}

void TexturesAhead::work() {
    try {
        Context context(SiblingOf{context_, true});
        make_all(context);
    } catch (const std::exception&) {
        // No context, or no memory: the caller makes the rest.
    }
    const std::lock_guard lock(mutex_);
    is_over_ = true;
    changed_.notify_all();
}

}  // namespace aftershade::gpu
