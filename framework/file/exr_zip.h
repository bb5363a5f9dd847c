// The transform of OpenEXR's ZIP on a block's bytes before they are packed ("Technical Introduction to
// OpenEXR", Data Compression): bytes at even places before those at odd ones, then each byte less the one
// before it, plus 128.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace aftershade::exr {

#if defined(__SSE2__)

/// The running sums of 16 bytes, and their last one in all places of `last`.
inline __m128i running_sums(__m128i bytes, __m128i& last) {
    bytes = _mm_add_epi8(bytes, _mm_slli_si128(bytes, 1));
    bytes = _mm_add_epi8(bytes, _mm_slli_si128(bytes, 2));
    bytes = _mm_add_epi8(bytes, _mm_slli_si128(bytes, 4));
    bytes = _mm_add_epi8(bytes, _mm_slli_si128(bytes, 8));
    last = _mm_shufflehi_epi16(_mm_unpackhi_epi8(bytes, bytes), 0xff);
    last = _mm_unpackhi_epi64(last, last);
    return bytes;
}

#endif

/// Turns differences back into bytes, of which `before` stands before the first; returns the last.
inline unsigned char undo_differences(std::span<char> bytes, unsigned char before) {
    std::size_t i = 0;
#if defined(__SSE2__)
    const __m128i offset = _mm_set1_epi8(char(128));
    __m128i sum = _mm_set1_epi8(char(before));
    for (; i + 16 <= bytes.size(); i += 16) {
        auto* const at = reinterpret_cast<__m128i*>(bytes.data() + i);
        __m128i last;
        const __m128i sums = running_sums(_mm_add_epi8(_mm_loadu_si128(at), offset), last);
        _mm_storeu_si128(at, _mm_add_epi8(sums, sum));
        sum = _mm_add_epi8(sum, last);
    }
    if (i > 0) before = static_cast<unsigned char>(bytes[i - 1]);
#endif
    for (; i < bytes.size(); ++i) {
        before = static_cast<unsigned char>(before + static_cast<unsigned char>(bytes[i]) - 128);
        bytes[i] = char(before);
    }
    return before;
}

/// The byte that undo_differences would return, without the others.
inline unsigned char last_of_differences(std::span<const char> bytes, unsigned char before) {
    std::size_t i = 0;
    std::uint64_t sum = before + 128 * (bytes.size() % 2);
#if defined(__SSE2__)
    __m128i sums = _mm_setzero_si128();
    for (; i + 16 <= bytes.size(); i += 16)
        sums = _mm_add_epi64(sums,
                             _mm_sad_epu8(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes.data() + i)),
                                          _mm_setzero_si128()));
    std::uint64_t halves[2];
    std::memcpy(halves, &sums, sizeof halves);
    sum += halves[0] + halves[1];
#endif
    for (; i < bytes.size(); ++i) sum += static_cast<unsigned char>(bytes[i]);
    return static_cast<unsigned char>(sum);
}

/// Bytes at even places of `bytes`, then those at odd ones.
inline void split_halves(std::span<const char> bytes, char* to) {
    const std::size_t half = bytes.size() / 2;
    for (std::size_t i = 0; i < half; ++i) {
        to[i] = bytes[2 * i];
        to[half + i] = bytes[2 * i + 1];
    }
}

/// Each byte less the one before it, plus 128; the first as it is. `to` lies elsewhere.
inline void make_differences(std::span<const char> bytes, char* to) {
    to[0] = bytes[0];
    for (std::size_t i = 1; i < bytes.size(); ++i) to[i] = char(bytes[i] - bytes[i - 1] + 128);
}

/// Puts `count` bytes of each half together again.
inline void interleave_halves(const char* even, const char* odd, std::size_t count, char* to) {
    std::size_t i = 0;
#if defined(__SSE2__)
    for (; i + 16 <= count; i += 16) {
        const __m128i e = _mm_loadu_si128(reinterpret_cast<const __m128i*>(even + i));
        const __m128i o = _mm_loadu_si128(reinterpret_cast<const __m128i*>(odd + i));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to + 2 * i), _mm_unpacklo_epi8(e, o));
        _mm_storeu_si128(reinterpret_cast<__m128i*>(to + 2 * i + 16), _mm_unpackhi_epi8(e, o));
    }
#endif
    for (; i < count; ++i) {
        to[2 * i] = even[i];
        to[2 * i + 1] = odd[i];
    }
}

}  // namespace aftershade::exr
