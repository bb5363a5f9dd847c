#include "framework/base/half_values.h"

#include <cassert>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace aftershade {

#if defined(__x86_64__)

// The program runs on processors without them, so the compiler may use them in these functions alone.
#define AFTERSHADE_F16C __attribute__((target("avx,f16c")))

bool converts_halfs() {
    static const bool converts = __builtin_cpu_supports("avx") && __builtin_cpu_supports("f16c");
    return converts;
}

AFTERSHADE_F16C bool to_exact_halfs(const float* values, std::uint16_t* halfs, std::size_t count) {
    assert(count % 4 == 0);
    __m256 differences = _mm256_setzero_ps();
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        const __m256 given = _mm256_loadu_ps(values + i);
        const __m128i half = _mm256_cvtps_ph(given, _MM_FROUND_TO_NEAREST_INT);
        _mm_storeu_si128(reinterpret_cast<__m128i*>(halfs + i), half);
        differences = _mm256_or_ps(differences, _mm256_xor_ps(given, _mm256_cvtph_ps(half)));
    }
    __m128 last = _mm_setzero_ps();
    if (i < count) {
        const __m128 given = _mm_loadu_ps(values + i);
        const __m128i half = _mm_cvtps_ph(given, _MM_FROUND_TO_NEAREST_INT);
        _mm_storel_epi64(reinterpret_cast<__m128i*>(halfs + i), half);
        last = _mm_xor_ps(given, _mm_cvtph_ps(half));
    }
    differences = _mm256_or_ps(differences, _mm256_set_m128(last, last));
    const __m256i bits = _mm256_castps_si256(differences);
    return _mm256_testz_si256(bits, bits) != 0;
}

AFTERSHADE_F16C void from_halfs(const std::uint16_t* halfs, float* values, std::size_t count) {
    assert(count % 4 == 0);
    std::size_t i = 0;
    for (; i + 8 <= count; i += 8)
        _mm256_storeu_ps(values + i,
                         _mm256_cvtph_ps(_mm_loadu_si128(reinterpret_cast<const __m128i*>(halfs + i))));
    if (i < count)
        _mm_storeu_ps(values + i, _mm_cvtph_ps(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(halfs + i))));
}

#else

bool converts_halfs() {
    return false;
}

bool to_exact_halfs(const float*, std::uint16_t*, std::size_t) {
    return false;
}

void from_halfs(const std::uint16_t*, float*, std::size_t) {
    assert(false && "see converts_halfs()");
}

#endif

}  // namespace aftershade
