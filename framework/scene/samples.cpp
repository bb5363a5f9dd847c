#include "framework/scene/samples.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace aftershade::scene {

using glm::dvec2;

namespace {

/// In [0, 1).
double unit_hash(std::uint32_t index, std::uint32_t seed) {
    return pcg3d(index, seed, 0x5bd1e995u)[0] / 4294967296.0;
}

double radical_inverse(int index, int base) {
    double result = 0;
    for (double digit = 1.0 / base; index > 0; index /= base, digit /= base) result += digit * (index % base);
    return result;
}

}  // namespace

std::array<std::uint32_t, 3> pcg3d(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    const auto step = [](std::uint32_t v) { return v * 1664525u + 1013904223u; };
    const auto mix = [&] {
        x += y * z;
        y += z * x;
        z += x * y;
    };
    x = step(x);
    y = step(y);
    z = step(z);
    mix();
    x ^= x >> 16u;
    y ^= y >> 16u;
    z ^= z >> 16u;
    mix();
    return {x, y, z};
}

std::uint32_t light_seed(std::uint32_t id, std::uint32_t sample) {
    return pcg3d(id, sample, 0x2545f491u)[0];
}

std::uint32_t permuted(std::uint32_t index, std::uint32_t count, std::uint32_t seed) {
    if (count < 2) return 0;
    const std::uint32_t mask = std::bit_ceil(count) - 1;
    const int shift = std::max(std::popcount(mask) / 2, 1);
    // Cycle walking: what leaves [0, count) is hashed again until it is inside.
    do {
        for (std::uint32_t round = 0; round < 3; ++round) {
            // Each line is a bijection of [0, mask]: an odd factor, a sum, a shift to the right.
            const auto key = pcg3d(seed, round, count);
            index = (index * (key[0] | 1u)) & mask;
            index = (index + key[1]) & mask;
            index ^= index >> shift;
        }
    } while (index >= count);
    return index;
}

dvec2 multi_jittered(std::uint32_t index, std::uint32_t count, std::uint32_t seed) {
    const auto columns = std::uint32_t(std::sqrt(double(count)));
    const std::uint32_t rows = (count + columns - 1) / columns;
    const std::uint32_t cell = permuted(index, count, seed);
    const std::uint32_t column = cell % columns, row = cell / columns;
    const double x = (permuted(row, rows, pcg3d(seed, 1, 0)[0]) + unit_hash(cell, seed ^ 0xa511e9b3u)) / rows;
    const double y =
        (permuted(column, columns, pcg3d(seed, 2, 0)[0]) + unit_hash(cell, seed ^ 0x63d83595u)) / columns;
    return {(column + x) / columns, (row + y) / rows};
}

dvec2 shifted_hammersley(std::uint32_t index, std::uint32_t count, std::uint32_t seed) {
    const dvec2 shifted(double(index) / count + unit_hash(0, seed),
                        radical_inverse(int(index), 2) + unit_hash(1, seed));
    return shifted - glm::floor(shifted);
}

dvec2 on_aperture(const dvec2& u, int blades, double rotation_rad) {
    if (blades == 0) {
        const dvec2 p = 2.0 * u - 1.0;
        if (p == dvec2(0)) return p;
        const bool wide = std::abs(p.x) > std::abs(p.y);
        const double radius = wide ? p.x : p.y;
        const double angle_rad =
            wide ? std::numbers::pi / 4 * p.y / p.x : std::numbers::pi / 2 - std::numbers::pi / 4 * p.x / p.y;
        return radius * dvec2(std::cos(angle_rad), std::sin(angle_rad));
    }
    const double scaled = u.x * blades;
    const double blade = std::min(std::floor(scaled), double(blades - 1));
    const double first_rad = rotation_rad + (2 * blade - 1) * std::numbers::pi / blades,
                 second_rad = first_rad + 2 * std::numbers::pi / blades;
    const dvec2 first(std::cos(first_rad), std::sin(first_rad)),
        second(std::cos(second_rad), std::sin(second_rad));
    return std::sqrt(u.y) * glm::mix(first, second, scaled - blade);
}

std::array<double, 2> halton_jitter_px(int index) {
    return {radical_inverse(index, 2) - 0.5, radical_inverse(index, 3) - 0.5};
}

}  // namespace aftershade::scene
