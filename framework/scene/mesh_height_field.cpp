#include "framework/scene/mesh.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace aftershade::scene {

namespace {

struct Height {
    double z_m = 0;
    glm::dvec2 slope{0};
};

Height height_at(const glm::dvec2& point, std::span<const Wave> waves) {
    constexpr double kTwoPi = 2 * std::numbers::pi;
    Height height;
    for (const Wave& wave : waves) {
        const double phase = kTwoPi * glm::dot(point, wave.cycles_per_m) + wave.phase_rad;
        height.z_m += wave.amplitude_m * std::cos(phase);
        height.slope -= wave.amplitude_m * kTwoPi * std::sin(phase) * wave.cycles_per_m;
    }
    return height;
}

}  // namespace

Mesh make_height_field(const glm::dvec2& size_m, std::span<const Wave> waves, int segments) {
    // 65534 a side is what 32-bit indices number.
    assert(segments >= 1 && segments < 65535 && size_m.x > 0 && size_m.y > 0);
    Mesh mesh;
    const std::size_t side = std::size_t(segments) + 1;
    mesh.vertices.reserve(side * side);
    mesh.triangles.reserve(2 * std::size_t(segments) * std::size_t(segments));
    for (int row = 0; row <= segments; ++row)
        for (int column = 0; column <= segments; ++column) {
            const glm::dvec2 part = glm::dvec2(column, row) / double(segments);
            const glm::dvec2 point = (part - 0.5) * size_m;
            const Height height = height_at(point, waves);
            mesh.vertices.push_back(
                {{point, height.z_m}, glm::normalize(glm::dvec3(-height.slope, 1)), {part.x, 1 - part.y}});
        }
    for (std::uint32_t row = 0; row + 1 < side; ++row)
        for (std::uint32_t column = 0; column + 1 < side; ++column) {
            const std::uint32_t corner = row * std::uint32_t(side) + column;
            const std::uint32_t above = corner + std::uint32_t(side);
            mesh.triangles.push_back({corner, corner + 1, above + 1});
            mesh.triangles.push_back({corner, above + 1, above});
        }
    return mesh;
}

}  // namespace aftershade::scene
