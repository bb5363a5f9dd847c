// Textures made on a thread beside that of the context.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "framework/gpu/texture.h"

namespace aftershade::gpu {

/// llvmpipe fills a texture's memory with zeros when it makes it, and the system makes the memory's pages
/// then: at 1080p that takes a quarter of the time that a first frame's passes do. A thread with a context of
/// its own that shares its objects does it while the caller loads programs. It begins with the largest, so
/// that both are done at about the same time when the caller helps. What the thread cannot make, the caller
/// does, who then meets the fault. [the context's thread; a thread of its own]
class TexturesAhead {
public:
    /// Whether a thread is worth it for textures of that description: none is where a driver does not take
    /// its memory on the processor, or the address space is limited, since Mesa does not check what it
    /// allocates.
    static bool is_useful(const Context& context, const std::vector<TextureDesc>& descs);

    /// `context` outlives this.
    TexturesAhead(Context& context, std::vector<TextureDesc> descs);
    /// Waits for the texture at hand; those that were not taken are deleted.
    ~TexturesAhead();
    TexturesAhead(const TexturesAhead&) = delete;
    TexturesAhead& operator=(const TexturesAhead&) = delete;

    /// The caller makes textures too, until the thread has begun the last, and waits for that one.
    void finish();
    /// One of that description, once it is made; nullopt where the thread has none or has not begun it, and
    /// will not then.
    std::optional<Texture> take(const TextureDesc& desc, const std::string& label);
    /// How many the thread has made so far.
    std::size_t textures_made() const;

private:
    struct Made {
        TextureDesc desc;
        unsigned int handle = 0;  ///< 0: not yet, or it could not be made
        bool is_begun = false;
        bool is_taken = false;
    };

    void work();
    void make_all(Context& context);
    Made* begin_largest();

    Context& context_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Made> textures_;
    bool stops_ = false;
    bool is_over_ = false;
    std::thread thread_;
};

}  // namespace aftershade::gpu
