#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>

#include "framework/scene/samples.h"
#include "framework/scene/world.h"

namespace aftershade::scene {

using glm::dvec3;

namespace {

constexpr double kFar_m = 1e7;

/// Where a ray to a light leaves a surface that must not hide itself: all light comes to the normal's side.
dvec3 off_surface(const Surface& surface) {
    const dvec3 size = glm::abs(surface.position);
    const double step_m = surface.precision * std::max({size.x, size.y, size.z, 1e-3});
    return surface.position + surface.geometric_normal * step_m;
}

std::uint32_t hash_of(const dvec3& position) {
    const glm::vec3 rounded(position);
    return pcg3d(std::bit_cast<std::uint32_t>(rounded.x), std::bit_cast<std::uint32_t>(rounded.y),
                 std::bit_cast<std::uint32_t>(rounded.z))[0];
}

/// A rotation of +z to `axis` (Duff et al. 2017, Building an Orthonormal Basis, Revisited).
glm::dmat3 frame_about(const dvec3& axis) {
    const double sign = std::copysign(1.0, axis.z);
    const double a = -1 / (sign + axis.z), b = axis.x * axis.y * a;
    return {dvec3(1 + sign * axis.x * axis.x * a, sign * b, -sign * axis.x),
            dvec3(b, sign + axis.y * axis.y * a, -axis.y), axis};
}

using Quad = std::array<dvec3, 4>;

Quad corners_of(const LightState& light) {
    const dvec3 &u = light.half_u_m, &v = light.half_v_m, &centre = light.position_m;
    return {centre - u - v, centre + u - v, centre + u + v, centre - u + v};
}

double height_over(const Surface& surface, const dvec3& point) {
    return glm::dot(point - surface.position, surface.geometric_normal);
}

/// Lambert's formula (Photometria, 1760; Baum et al. 1989) over a quadrilateral cut at the horizon: the
/// integral of the cosine over the solid angle.
double polygon_cosine(const Quad& corners, const Surface& surface) {
    std::array<dvec3, 6> kept;
    std::size_t count = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const dvec3 a = corners[i] - surface.position, b = corners[(i + 1) % 4] - surface.position;
        const double height_a = glm::dot(a, surface.normal), height_b = glm::dot(b, surface.normal);
        if (height_a >= 0) kept[count++] = a;
        if ((height_a >= 0) != (height_b >= 0))
            kept[count++] = glm::mix(a, b, height_a / (height_a - height_b));
    }
    double sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3 &a = kept[i], &b = kept[(i + 1) % count];
        const dvec3 across = glm::cross(a, b);
        const double length = glm::length(across);
        if (length > 0) sum += std::atan2(length, glm::dot(a, b)) * glm::dot(across, surface.normal) / length;
    }
    return std::abs(sum) / 2;
}

double pattern_at(const LightPattern& pattern, const dvec3& position) {
    const double along_m = glm::dot(position, pattern.axis) - pattern.offset_m;
    switch (pattern.kind) {
        case LightPattern::Kind::edge: return along_m >= 0 ? 1 : 0;
        case LightPattern::Kind::cosine:
            return 1 + pattern.amplitude * std::cos(2 * std::numbers::pi * along_m / pattern.period_m);
        case LightPattern::Kind::none: break;
    }
    return 1;
}

/// GGX with the height-correlated masking of Heitz 2014 and Schlick's Fresnel; without the light's cosine.
dvec3 highlight(const Finish& finish, const dvec3& normal, const dvec3& to_light, const dvec3& to_eye) {
    const double n_l = glm::dot(normal, to_light), n_v = glm::dot(normal, to_eye);
    if (finish.reflectance == dvec3(0) || n_l <= 0 || n_v <= 0) return dvec3(0);
    const dvec3 half_way = glm::normalize(to_light + to_eye);
    const double alpha = finish.roughness * finish.roughness, a2 = alpha * alpha;
    const double n_h = std::clamp(glm::dot(normal, half_way), 0.0, 1.0);
    const double base = n_h * n_h * (a2 - 1) + 1;
    const double distribution = a2 / (std::numbers::pi * base * base);
    const double masking =
        0.5 / (n_l * std::sqrt(n_v * n_v * (1 - a2) + a2) + n_v * std::sqrt(n_l * n_l * (1 - a2) + a2));
    const double grazing = 1 - std::clamp(glm::dot(half_way, to_light), 0.0, 1.0),
                 squared = grazing * grazing;
    return distribution * masking *
           (finish.reflectance + (1.0 - finish.reflectance) * squared * squared * grazing);
}

/// Along the normal where the eye lies on the surface: a camera in a triangle's plane meets it nowhere else.
dvec3 direction_to(const dvec3& eye, const Surface& surface) {
    const dvec3 way = eye - surface.position;
    return way == dvec3(0) ? surface.normal : glm::normalize(way);
}

/// Whether a ray meets one of the boxes between its origin and the end of its direction.
bool meets_any(const Bvh& boxes, const Ray& ray) {
    const dvec3 inverse = 1.0 / ray.direction;
    for (std::uint32_t at = 0; at < boxes.nodes.size();) {
        const BvhNode& node = boxes.nodes[at];
        const bool met = meets(ray, inverse, node.bounds, 0, 1);
        if (met && node.count > 0) return true;
        at = met ? at + 1 : node.skip;
    }
    return false;
}

}  // namespace

/// An area light has a ray to each point of a grid on it. Points below the surface's horizon do not count,
/// since polygon_cosine cuts them off; where all are, the highest corner stands for the rest.
template <class Visit>
void World::visit_shadow_rays(std::size_t index, const Surface& surface, const dvec3& toward,
                              const Visit& visit) const {
    const LightState& now = state_.lights[index];
    const Light& light = scene().lights[index];
    if (light.kind == LightKind::directional) return visit(off_surface(surface) + toward * kFar_m);
    if (light.kind == LightKind::point) return visit(now.position_m);
    const int side = light.shadow_samples;
    bool any = false;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double u = (x + 0.5) / side * 2 - 1, v = (y + 0.5) / side * 2 - 1;
            const dvec3 to = now.position_m + u * now.half_u_m + v * now.half_v_m;
            if (height_over(surface, to) <= 0) continue;
            any = true;
            visit(to);
        }
    if (any) return;
    const Quad corners = corners_of(now);
    visit(*std::max_element(corners.begin(), corners.end(), [&](const dvec3& a, const dvec3& b) {
        return height_over(surface, a) < height_over(surface, b);
    }));
}

/// The share of a light that comes through.
double World::visible_part(std::size_t index, const Surface& surface, const dvec3& toward) const {
    const dvec3 from = off_surface(surface);
    double seen = 0;
    int count = 0;
    visit_shadow_rays(index, surface, toward, [&](const dvec3& to) {
        seen += light_through(from, to);
        ++count;
    });
    return seen / count;
}

/// As likely as their cosine (Malley's method).
template <class Visit>
void World::visit_ambient_rays(const Surface& surface, const Visit& visit) const {
    const auto rays = std::uint32_t(scene().ambient_rays);
    const std::uint32_t seed = surface.light_seed.value_or(hash_of(surface.local));
    const glm::dmat3 frame = frame_about(surface.normal);
    for (std::uint32_t i = 0; i < rays; ++i) {
        const glm::dvec2 on_disk = on_aperture(shifted_hammersley(i, rays, seed), 0, 0);
        const double height = std::sqrt(std::max(1 - glm::dot(on_disk, on_disk), 0.0));
        visit(frame * dvec3(on_disk, height));
    }
}

/// The share of the ambient light that shines through.
double World::visible_ambient(const Surface& surface) const {
    const dvec3 from = off_surface(surface);
    double seen = 0;
    visit_ambient_rays(surface, [&](const dvec3& way) {
        // A mesh does not hide what its bent normal sees behind the flat triangle.
        seen += glm::dot(way, surface.geometric_normal) > 0 ? light_through(from, from + kFar_m * way) : 1;
    });
    return seen / scene().ambient_rays;
}

std::optional<World::Arriving> World::arriving(std::size_t index, const Surface& surface) const {
    const Light& light = scene().lights[index];
    const LightState& now = state_.lights[index];
    const bool is_area = light.kind == LightKind::area, is_far = light.kind == LightKind::directional;
    const dvec3 way = is_far ? -now.direction : now.position_m - surface.position;
    const double distance2 = glm::dot(way, way);
    if (distance2 == 0) return std::nullopt;  // in the light itself no direction leads to it
    Arriving arriving;
    arriving.toward = way / std::sqrt(distance2);
    const double cosine = std::max(glm::dot(surface.normal, arriving.toward), 0.0);
    const double front = is_area ? -glm::dot(now.direction, arriving.toward) : 1;
    // Parts of an area light may stand above the horizon where its middle does not.
    if (front <= 0 || (!is_area && glm::dot(surface.geometric_normal, arriving.toward) <= 0))
        return std::nullopt;
    arriving.received = is_far ? cosine * pattern_at(light.pattern, surface.position) : cosine / distance2;
    arriving.highlighted = arriving.received;
    if (is_area) {
        arriving.highlighted *= front * 4 * glm::length(now.half_u_m) * glm::length(now.half_v_m);
        arriving.received = polygon_cosine(corners_of(now), surface);
    }
    if (arriving.received <= 0) return std::nullopt;
    return arriving;
}

Shading World::light(const Surface& surface, const Finish& finish, const dvec3* to_eye,
                     std::span<double> seen) const {
    Shading shading;
    shading.irradiance = finish.ambient * scene().ambient;
    if (scene().ambient_rays > 0 && scene().ambient != dvec3(0))
        shading.irradiance *= visible_ambient(surface);
    for (std::size_t i = 0; i < state_.lights.size(); ++i) {
        if (!seen.empty()) seen[i] = 0;
        const auto source = arriving(i, surface);
        if (!source) continue;
        const double part = scene().lights[i].shadows ? visible_part(i, surface, source->toward) : 1;
        if (!seen.empty()) seen[i] = part;
        const dvec3& color = state_.lights[i].color_intensity;
        shading.irradiance += color * (source->received * part / std::numbers::pi);
        if (to_eye && source->highlighted * part > 0)
            shading.specular += color * (source->highlighted * part *
                                         highlight(finish, surface.normal, source->toward, *to_eye));
    }
    return shading;
}

dvec3 World::highlights(const Surface& surface, const dvec3& eye, std::span<const double> seen) const {
    const dvec3 to_eye = direction_to(eye, surface);
    const auto [lit, finish] = finished(surface, eye);
    dvec3 specular(0);
    for (std::size_t i = 0; i < seen.size(); ++i) {
        if (seen[i] <= 0) continue;
        const auto source = arriving(i, lit);
        if (source && source->highlighted * seen[i] > 0)
            specular +=
                state_.lights[i].color_intensity *
                (source->highlighted * seen[i] * highlight(finish, lit.normal, source->toward, to_eye));
    }
    return specular;
}

bool World::light_meets(const Surface& surface, const Bvh& boxes) const {
    const Surface lit = finished(surface, dvec3(state_.camera.world_from_camera[3])).surface;
    const dvec3 from = off_surface(lit);
    bool found = false;
    const auto visit = [&](const dvec3& to) { found = found || meets_any(boxes, {from, to - from}); };
    for (std::size_t i = 0; i < state_.lights.size() && !found; ++i)
        if (const auto source = arriving(i, lit); source && scene().lights[i].shadows)
            visit_shadow_rays(i, lit, source->toward, visit);
    if (!found && scene().ambient != dvec3(0))
        visit_ambient_rays(lit, [&](const dvec3& way) { visit(from + kFar_m * way); });
    return found;
}

World::Finished World::finished(const Surface& surface, const dvec3& eye) const {
    const Material& material = material_at(surface);
    TexturePoint at = texture_point(surface);
    if (material.maps.any()) at.weights_of_pixel = weights_of_pixel(surface, eye);
    Finished result{surface, finish_at(material, at)};
    if (material.maps.normal) result.surface.normal = mapped_normal(surface, material.maps, at);
    return result;
}

Shading World::shade(const Surface& surface, const dvec3& eye, std::span<double> seen) const {
    const dvec3 to_eye = direction_to(eye, surface);
    const auto [lit, finish] = finished(surface, eye);
    Shading shading = light(lit, finish, &to_eye, seen);
    shading.albedo = finish.albedo;
    shading.emission = finish.emission;
    shading.normal = lit.normal;
    return shading;
}

}  // namespace aftershade::scene
