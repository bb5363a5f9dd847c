#include "aftershade/capture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "framework/base/text.h"
#include "framework/host/failures.h"
#include "framework/host/image_data.h"
#include "framework/image/role.h"

namespace aftershade::host {

namespace {

constexpr int kMaxOrigin_px = 1'000'000;
constexpr double kMaxScale = 64;
constexpr double kMaxAspect = 100;

struct CameraMember {
    const char* field;
    std::optional<double> Camera::*member;
};
constexpr CameraMember kCameraMembers[] = {{"focus_distance", &Camera::focus_distance_m},
                                           {"focal_length", &Camera::focal_length_mm},
                                           {"sensor_width", &Camera::sensor_width_mm},
                                           {"f_number", &Camera::f_number},
                                           {"blades", &Camera::blades},
                                           {"rotation", &Camera::rotation_deg},
                                           {"shutter_angle", &Camera::shutter_angle_deg},
                                           {"near", &Camera::near_m},
                                           {"far", &Camera::far_m}};

bool is_finite(const std::optional<Matrix4>& matrix) {
    return !matrix || std::ranges::all_of(*matrix, [](double value) { return std::isfinite(value); });
}

void check_camera(const Camera& camera) {
    Diagnostics faults;
    for (const CameraMember& entry : kCameraMembers) {
        const CameraField& field = *find_camera_field(entry.field);
        const std::optional<double>& value = camera.*entry.member;
        if (value && !(std::isfinite(*value) && *value >= field.min))
            faults.error({"camera." + field.name},
                         fmt::format("{:g} is not a finite number from {:g}{}{}", *value, field.min,
                                     field.unit.empty() ? "" : " ", field.unit));
    }
    const auto& models = lens_model_names();
    if (!camera.lens_model.empty() &&
        std::find(models.begin(), models.end(), camera.lens_model) == models.end())
        faults.error({"camera.lens_model"},
                     "'" + camera.lens_model + "' is not " + list_of_names(models) + ", nor empty");
    if (!is_finite(camera.camera_from_world))
        faults.error({"camera.camera_from_world"}, "the matrix has values that are not finite");
    if (!is_finite(camera.ndc_from_world))
        faults.error({"camera.ndc_from_world"}, "the matrix has values that are not finite");
    if (camera.jitter_px && !(std::isfinite((*camera.jitter_px)[0]) && std::isfinite((*camera.jitter_px)[1])))
        faults.error({"camera.jitter_px"}, "the offset is not finite");
    stop_at_errors(ErrorKind::usage, faults);
}

void check_window(const Window& window, const char* name) {
    if (window.width < 1 || window.height < 1 || window.width > kMaxSide_px || window.height > kMaxSide_px)
        fail_at(ErrorKind::usage, name,
                fmt::format("{} x {} px; each side must be from 1 to {}", window.width, window.height,
                            kMaxSide_px));
    if (std::abs(window.x) > kMaxOrigin_px || std::abs(window.y) > kMaxOrigin_px)
        fail_at(ErrorKind::usage, name,
                fmt::format("begins at ({}, {}); each must be from {} to {}", window.x, window.y,
                            -kMaxOrigin_px, kMaxOrigin_px));
}

/// A role that a producer of captures may give.
ChannelRole known_role(const std::string& name) {
    const auto role = find_role(name);
    if (!role)
        fail_at(ErrorKind::usage, name,
                "not a role" + did_you_mean(name, role_names()) +
                    " (roles: " + list_of_names(role_names(), "and") + ", and aov:<name>)");
    if (role->kind == RoleKind::display)
        fail_at(ErrorKind::usage, name, "only effects make this role; no capture has it");
    return *role;
}

void check_size(const Window& window, const std::string& role, int width, int height) {
    if (width != window.width || height != window.height)
        fail_at(ErrorKind::usage, role,
                fmt::format("the image has {} x {} px, the capture's data window {} x {}", width, height,
                            window.width, window.height));
}

void list_roles(aftershade::Capture& capture) {
    capture.header.roles.clear();
    for (const auto& [role, image] : capture.images)
        if (!role.is_coverage()) capture.header.roles.push_back(role.name());
}

}  // namespace

aftershade::Window internal_window(const Window& window) {
    return {window.x, window.y, window.x + window.width - 1, window.y + window.height - 1};
}

Window public_window(const aftershade::Window& window) {
    return {window.min_x, window.min_y, window.width(), window.height()};
}

std::vector<std::string> notes_of(const CaptureHeader& header) {
    std::vector<std::string> notes;
    for (const auto* more : {&header.notes, &header.warnings, &header.differences})
        notes.insert(notes.end(), more->begin(), more->end());
    return notes;
}

Capture Access::capture(Capture::Data data) {
    return Capture(std::make_shared<Capture::Data>(std::move(data)));
}

Capture::Capture(std::shared_ptr<Data> data) : data_(std::move(data)) {}

Capture::Capture(int width, int height) {
    const Window window{0, 0, width, height};
    check_window(window, "Capture");
    auto data = std::make_shared<Data>();
    CaptureHeader& header = data->capture.header;
    header.frame = header.source_frame = 1;
    header.data_window = header.display_window = internal_window(window);
    data_ = std::move(data);
}

Capture::Capture(const Capture&) noexcept = default;
Capture& Capture::operator=(const Capture&) noexcept = default;
Capture::~Capture() = default;

/// Alone with what is going to change.
Capture::Data& Capture::own() {
    if (data_.use_count() > 1) data_ = std::make_shared<Data>(*data_);
    return *data_;
}

void Capture::set_image(const std::string& role, const ArrayView& pixels) {
    with_public_errors([&] {
        const ChannelRole known = known_role(role);
        aftershade::Image image = copy_of(pixels, role);
        check_size(data_window(), role, image.width(), image.height());
        if (image.type() != known.type)
            fail_at(ErrorKind::usage, role,
                    known.type == ComponentType::uint32 ? "the role holds uint32; the array has float32"
                                                        : "the role holds float32; the array has uint32");
        if (known.kind == RoleKind::other ? image.channels() > known.channels
                                          : image.channels() != known.channels)
            fail_at(
                ErrorKind::usage, role,
                fmt::format("the array has {} channels; the role has {}", image.channels(), known.channels));
        Data& data = own();
        data.textures.erase(role);
        data.capture.images[role] = std::move(image);
        list_roles(data.capture);
    });
}

void Capture::set_texture(const std::string& role, const GlTexture& texture) {
    with_public_errors([&] {
        known_role(role);
        if (texture.name == 0) fail_at(ErrorKind::usage, role, "0 names no texture");
        check_size(data_window(), role, texture.width, texture.height);
        Data& data = own();
        data.textures[role] = texture;
        data.capture.images[role] = aftershade::Image();
        list_roles(data.capture);
    });
}

void Capture::remove_image(const std::string& role) {
    with_public_errors([&] {
        if (!has_image(role)) fail_at(ErrorKind::usage, role, "the capture has no image of this role");
        Data& data = own();
        data.textures.erase(role);
        data.capture.images.erase(role);
        list_roles(data.capture);
    });
}

Image Capture::image(const std::string& role) const {
    const auto found = data_->capture.images.find(role);
    if (found == data_->capture.images.end())
        fail_at(ErrorKind::usage, role, "the capture has no image of this role");
    if (data_->has_texture(role))
        fail_at(ErrorKind::usage, role, "this image is a texture, whose pixels are on the GPU");
    return Access::image(std::shared_ptr<const aftershade::Image>(data_, &found->second));
}

bool Capture::has_image(const std::string& role) const noexcept {
    return data_->capture.images.find(role) != data_->capture.images.end();
}

std::vector<std::string> Capture::roles() const {
    std::vector<std::string> roles;
    for (const auto& [role, image] : data_->capture.images)
        if (!role.is_coverage()) roles.push_back(role.name());
    return roles;
}

int Capture::frame() const noexcept {
    return data_->capture.header.frame;
}

void Capture::set_frame(int frame) {
    if (frame != this->frame()) own().capture.header.frame = frame;
}

Window Capture::data_window() const noexcept {
    return public_window(data_->capture.header.data_window);
}

Window Capture::display_window() const noexcept {
    return public_window(data_->capture.header.display_window);
}

void Capture::set_windows(const Window& data, const Window& display) {
    with_public_errors([&] {
        check_window(data, "data window");
        check_window(display, "display window");
        const Window now = data_window();
        if (!data_->capture.images.empty() && (data.width != now.width || data.height != now.height))
            fail_at(ErrorKind::usage, "data window",
                    fmt::format("{} x {} px; the images have {} x {}", data.width, data.height, now.width,
                                now.height));
        CaptureHeader& header = own().capture.header;
        header.data_window = internal_window(data);
        header.display_window = internal_window(display);
    });
}

double Capture::pixel_aspect() const noexcept {
    return double(data_->capture.header.pixel_aspect);
}

void Capture::set_pixel_aspect(double aspect) {
    if (!(aspect >= 1 / kMaxAspect && aspect <= kMaxAspect))
        fail_at(ErrorKind::usage, "pixel aspect",
                fmt::format("{:g} is not from {:g} to {:g}", aspect, 1 / kMaxAspect, kMaxAspect));
    own().capture.header.pixel_aspect = float(aspect);
}

double Capture::scale() const noexcept {
    return data_->scale;
}

void Capture::set_scale(double scale) {
    if (!(scale > 0 && scale <= kMaxScale))
        fail_at(ErrorKind::usage, "scale",
                fmt::format("{:g} is not above 0 and at most {:g}", scale, kMaxScale));
    own().scale = scale;
}

std::string Capture::color_space() const {
    return name_of_primaries(data_->capture.header.primaries);
}

void Capture::set_color_space(const std::string& name) {
    const auto primaries = color_space_primaries(name);
    if (!primaries)
        fail_at(ErrorKind::usage, "color space",
                "'" + name + "' is not " + list_of_names(color_space_names()));
    CaptureHeader& header = own().capture.header;
    header.primaries = *primaries;
    header.stored_colors = declared_colors(name, "set_color_space()");
}

Camera Capture::camera() const {
    const aftershade::Camera& from = data_->capture.header.camera;
    Camera camera;
    for (const CameraMember& entry : kCameraMembers) camera.*entry.member = from.get(entry.field);
    camera.lens_model = from.lens_model;
    camera.camera_from_world = from.camera_from_world;
    camera.ndc_from_world = from.ndc_from_world;
    camera.jitter_px = from.jitter_px;
    return camera;
}

void Capture::set_camera(const Camera& camera) {
    with_public_errors([&] {
        check_camera(camera);
        const std::string origin = "set_camera()";
        aftershade::Camera now;
        for (const CameraMember& entry : kCameraMembers)
            if (const auto& value = camera.*entry.member) now.set(entry.field, *value, origin);
        if (!camera.lens_model.empty()) now.set_lens_model(camera.lens_model, origin);
        now.camera_from_world = camera.camera_from_world;
        now.ndc_from_world = camera.ndc_from_world;
        now.jitter_px = camera.jitter_px;
        own().capture.header.camera = std::move(now);
    });
}

std::vector<Light> Capture::lights() const {
    std::vector<Light> lights;
    for (const CaptureLight& light : data_->capture.header.lights)
        lights.push_back({LightKind(int(light.kind)), light.name, light.position_m, light.direction,
                          light.size_m, light.intensity});
    return lights;
}

void Capture::set_lights(const std::vector<Light>& lights) {
    std::vector<CaptureLight> now;
    for (const Light& light : lights)
        now.push_back({CaptureLight::Kind(int(light.kind)), light.name, light.position_m, light.direction,
                       light.size_m, light.intensity});
    own().capture.header.lights = std::move(now);
}

std::string Capture::profile() const {
    return data_->capture.header.profile;
}
std::string Capture::path() const {
    return data_->capture.header.path.string();
}
std::vector<std::string> Capture::notes() const {
    return notes_of(data_->capture.header);
}

}  // namespace aftershade::host
