#include "framework/scene/capture_images.h"

#include <array>

#include "framework/image/role.h"

namespace aftershade::scene {

namespace {

void write(Image& image, int x, int y, const glm::dvec3& value) {
    for (int c = 0; c < 3; ++c) image.at(x, y, c) = float(value[c]);
}

}  // namespace

std::span<const std::string> all_roles() {
    static const std::array<std::string, 11> roles = {"color",      "depth",    "velocity", "velocity_next",
                                                      "irradiance", "albedo",   "specular", "emission",
                                                      "normal",     "position", "object_id"};
    return roles;
}

Capture make_capture(int frame, int width_px, int height_px, std::span<const std::string> roles) {
    Capture capture;
    CaptureHeader& header = capture.header;
    header.frame = header.source_frame = frame;
    header.data_window = header.display_window = {0, 0, width_px - 1, height_px - 1};
    header.profile = "native";
    for (const std::string& name : roles) {
        const ChannelRole role = *find_role(name);
        capture.images.emplace(name, Image(width_px, height_px, role.channels, role.type));
        header.roles.push_back(name);
    }
    return capture;
}

void write_surface(Capture& capture, int x, int y, const Scene& scene, const Surface& surface,
                   const Shading& shading) {
    write(capture.images.at("color"), x, y, shading.color());
    capture.images.at("color").at(x, y, 3) = 1;
    write(capture.images.at("irradiance"), x, y, shading.irradiance);
    write(capture.images.at("albedo"), x, y, shading.albedo);
    write(capture.images.at("specular"), x, y, shading.specular);
    write(capture.images.at("emission"), x, y, shading.emission);
    write(capture.images.at("normal"), x, y, shading.normal);
    write(capture.images.at("position"), x, y, surface.position);
    capture.images.at("object_id").uint_at(x, y, 0) = scene.objects[std::size_t(surface.object)].id;
}

void write_color(Capture& capture, int x, int y, const glm::dvec3& premultiplied, double alpha) {
    write(capture.images.at("color"), x, y, premultiplied);
    capture.images.at("color").at(x, y, 3) = float(alpha);
}

void write_motion(Capture& capture, int x, int y, const glm::dvec2& velocity_px,
                  const glm::dvec2& velocity_next_px) {
    for (int c = 0; c < 2; ++c) {
        capture.images.at("velocity").at(x, y, c) = float(velocity_px[c]);
        capture.images.at("velocity_next").at(x, y, c) = float(velocity_next_px[c]);
    }
}

void write_background(Capture& capture, int x, int y, const glm::dvec3& radiance) {
    write(capture.images.at("color"), x, y, radiance);
    capture.images.at("color").at(x, y, 3) = 1;
    write(capture.images.at("emission"), x, y, radiance);
}

}  // namespace aftershade::scene
