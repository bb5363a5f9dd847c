#include "framework/file/deflate.h"

#ifdef AFTERSHADE_HAS_LIBDEFLATE
#include <libdeflate.h>
#else
#include <zlib.h>
#endif

#include <new>

namespace aftershade {

#ifdef AFTERSHADE_HAS_LIBDEFLATE

struct Inflater::State {
    struct Closer {
        void operator()(libdeflate_decompressor* one) const { libdeflate_free_decompressor(one); }
    };
    std::unique_ptr<libdeflate_decompressor, Closer> decompressor{libdeflate_alloc_decompressor()};
};

Inflater::Inflater() : state_(std::make_unique<State>()) {
    if (!state_->decompressor) throw std::bad_alloc();
}

bool Inflater::unpack(std::span<const char> packed, std::span<char> raw) {
    return libdeflate_zlib_decompress(state_->decompressor.get(), packed.data(), packed.size(), raw.data(),
                                      raw.size(), nullptr) == LIBDEFLATE_SUCCESS;
}

#else

struct Inflater::State {};

Inflater::Inflater() = default;

bool Inflater::unpack(std::span<const char> packed, std::span<char> raw) {
    uLongf size = uLongf(raw.size());
    return uncompress(reinterpret_cast<Bytef*>(raw.data()), &size,
                      reinterpret_cast<const Bytef*>(packed.data()), uLong(packed.size())) == Z_OK &&
           size == raw.size();
}

#endif

Inflater::~Inflater() = default;

}  // namespace aftershade
