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

struct Deflater::State {
    struct Closer {
        void operator()(libdeflate_compressor* one) const { libdeflate_free_compressor(one); }
    };
    std::unique_ptr<libdeflate_compressor, Closer> compressor;
};

Deflater::Deflater(int level) : state_(std::make_unique<State>()) {
    state_->compressor.reset(libdeflate_alloc_compressor(level));
    if (!state_->compressor) throw std::bad_alloc();
}

std::size_t Deflater::pack(std::span<const char> raw, std::span<char> packed) {
    return libdeflate_zlib_compress(state_->compressor.get(), raw.data(), raw.size(), packed.data(),
                                    packed.size());
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

struct Deflater::State {
    int level;
};

Deflater::Deflater(int level) : state_(std::make_unique<State>(State{level})) {}

std::size_t Deflater::pack(std::span<const char> raw, std::span<char> packed) {
    uLongf size = uLongf(packed.size());
    const bool fits =
        compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(raw.data()),
                  uLong(raw.size()), state_->level) == Z_OK;
    return fits ? std::size_t(size) : 0;
}

#endif

Deflater::~Deflater() = default;
Inflater::~Inflater() = default;

}  // namespace aftershade
