#include "framework/capture/stored_matrices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "framework/image/camera_matrix.h"

namespace aftershade {

namespace {

constexpr const char* kVersionAttribute = "aftershade/matrices";
/// Matrices by OpenEXR's definition.
constexpr int kOpenExrVersion = 2;

/// Producers store float, some of them after products of several matrices.
constexpr double kTolerance = 2e-3;
/// Of a pixel's width over its height, which producers round or leave out.
constexpr double kAspectTolerance = 0.05;

using Rows = std::array<glm::dvec4, 4>;

Rows rows_of(const glm::dmat4& matrix) {
    const glm::dmat4 turned = glm::transpose(matrix);
    return {turned[0], turned[1], turned[2], turned[3]};
}

glm::dmat4 matrix_of(const Rows& rows) {
    return glm::transpose(glm::dmat4(rows[0], rows[1], rows[2], rows[3]));
}

/// As it acts on column vectors. EXR's act on row vectors, so GLM's columns are its rows.
std::optional<glm::dmat4> stored_matrix(const ExrMetadata& metadata, const char* name, std::string& damage) {
    const auto value = metadata.value(name);
    const auto* stored = value ? std::get_if<std::vector<float>>(&*value) : nullptr;
    if (!stored || stored->size() != 16) return std::nullopt;
    const bool is_finite = std::ranges::all_of(*stored, [](float v) { return std::isfinite(v); });
    if (!is_finite || std::ranges::all_of(*stored, [](float v) { return v == 0; })) {
        damage = std::string(name) + (is_finite ? " is 0 everywhere" : " has values that are not finite");
        return std::nullopt;
    }
    glm::dmat4 matrix;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) matrix[column][row] = (*stored)[std::size_t(column * 4 + row)];
    return matrix;
}

std::vector<float> stored_values(const glm::dmat4& matrix) {
    std::vector<float> stored(16);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) stored[std::size_t(column * 4 + row)] = float(matrix[column][row]);
    return stored;
}

bool is_affine(const glm::dmat4& matrix) {
    const glm::dvec4 last = rows_of(matrix)[3];
    return glm::length(last - glm::dvec4(0, 0, 0, 1)) < kTolerance;
}

/// Axes at right angles and of one length: a turn, a mirror and a uniform scale.
bool is_rigid(const glm::dmat4& matrix) {
    const glm::dmat3 axes(matrix);
    const double scale = glm::length(axes[0]);
    if (!(scale > 0)) return false;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(glm::length(axes[i]) / scale - 1) > kTolerance) return false;
        if (std::abs(glm::dot(axes[i], axes[(i + 1) % 3])) > kTolerance * scale * scale) return false;
    }
    return true;
}

bool nearly_equal(const glm::dmat4& a, const glm::dmat4& b) {
    double difference = 0, size = 0;
    for (int i = 0; i < 4; ++i) {
        difference += glm::dot(a[i] - b[i], a[i] - b[i]);
        size += glm::dot(a[i], a[i]);
    }
    return difference <= kTolerance * kTolerance * size;
}

/// One matrix of the view, and its two conventions.
struct View {
    glm::dmat4 camera_from_world{1};  ///< as stored, acting on column vectors
    double ahead = 0;                 ///< +1: +z is ahead, -1: -z, 0: not known
    bool transposed = false;
};

/// The row that a projection divides by is the distance ahead: a multiple of the view's z.
double ahead_by(const glm::dmat4& ndc_from_world, const View& view) {
    const glm::dvec4 divisor = rows_of(ndc_from_world)[3], z = rows_of(view.camera_from_world)[2];
    const double factor = glm::dot(divisor, z) / glm::dot(z, z);
    if (glm::length(divisor - factor * z) > kTolerance * glm::length(divisor)) return 0;
    return factor > 0 ? 1 : factor < 0 ? -1 : 0;
}

/// As stored and, for pbrt-v4, transposed; a camera at the origin may be both. Which way is ahead, they do
/// not know.
std::vector<View> views_of(const glm::dmat4& stored) {
    std::vector<View> views;
    for (const bool transposed : {false, true}) {
        const glm::dmat4 matrix = transposed ? glm::transpose(stored) : stored;
        if (is_affine(matrix) && is_rigid(matrix)) views.push_back({matrix, 0, transposed});
    }
    return views;
}

class Projection {
public:
    /// `ndc_from_world` divides by a multiple of the view's z, or by 1.
    Projection(const glm::dmat4& ndc_from_world, const View& view, const ExrPart& part)
        : ndc_(rows_of(ndc_from_world)),
          by_camera_(rows_of(ndc_from_world * glm::inverse(view.camera_from_world))) {
        const bool is_orthographic = std::abs(by_camera_[3].w) > std::abs(by_camera_[3].z);
        divisor_ = is_orthographic ? by_camera_[3].w : by_camera_[3].z;
        middle_ = is_orthographic ? glm::dvec2(by_camera_[0].w, by_camera_[1].w) / divisor_
                                  : glm::dvec2(by_camera_[0].z, by_camera_[1].z) / divisor_;
        width_ = part.display_window.width() * double(part.pixel_aspect);
        height_ = part.display_window.height();
    }

    /// Why it is no projection onto the display window; "" where it is.
    std::string fault() const {
        const double x = by_camera_[0].x, y = by_camera_[1].y;
        if (!(x != 0 && y != 0) || std::abs(by_camera_[0].y) > kTolerance * std::abs(x) ||
            std::abs(by_camera_[1].x) > kTolerance * std::abs(y))
            return "does not project along the axes of worldToCamera";
        if (x / std::abs(divisor_) < 0) return "mirrors the picture";
        const double aspect = std::abs(x) * width_ / (std::abs(y) * height_);
        if (std::abs(aspect - 1) > kAspectTolerance)
            return "is for a picture of another aspect ratio than the display window";
        return "";
    }

    /// From 0 to 1, not from -1 to 1. The lens decides where it is known, else where the view's axis meets
    /// the picture, which is near its middle.
    bool is_unsigned(const Camera& lens) const {
        const auto focal_length = lens.get("focal_length"), sensor_width = lens.get("sensor_width");
        if (focal_length && sensor_width) {
            const double slope = std::abs(by_camera_[0].x / divisor_) * *sensor_width / *focal_length;
            if (std::abs(slope - 1) < 0.05) return true;
            if (std::abs(slope - 2) < 0.1) return false;
        }
        const glm::dvec2 from_half = middle_ - glm::dvec2(0.5);
        return glm::dot(from_half, from_half) < glm::dot(middle_, middle_);
    }
    bool is_down() const { return by_camera_[1].y < 0; }

    /// From -1 to 1 with y up, dividing by a positive multiple of the distance.
    glm::dmat4 normalized(bool is_unsigned) const {
        Rows rows = ndc_;
        if (is_unsigned)
            for (const int row : {0, 1}) rows[std::size_t(row)] = 2.0 * rows[std::size_t(row)] - rows[3];
        if (is_down()) rows[1] = -rows[1];
        return matrix_of(rows);
    }

private:
    Rows ndc_, by_camera_;
    double divisor_ = 1;
    glm::dvec2 middle_{0};  ///< of a point on the view's axis
    double width_ = 1, height_ = 1;
};

/// View space looks along -z.
glm::dmat4 looking_back(const View& view) {
    if (view.ahead < 0) return view.camera_from_world;
    Rows rows = rows_of(view.camera_from_world);
    rows[2] = -rows[2];
    return matrix_of(rows);
}

std::optional<glm::dmat4> ndc_of_lens(const glm::dmat4& camera_from_world, const ExrPart& part,
                                      const Camera& lens) {
    const auto focal_length = lens.get("focal_length"), sensor_width = lens.get("sensor_width");
    if (!focal_length || !sensor_width) return std::nullopt;
    const double slope = 2 * *focal_length / *sensor_width;
    const double aspect =
        part.display_window.width() * double(part.pixel_aspect) / part.display_window.height();
    const Rows view = rows_of(camera_from_world);
    return matrix_of({slope * view[0], slope * aspect * view[1], -view[2], -view[2]});
}

/// Rows of x, y and the divisor that no point would be lost by.
bool spans_picture(const glm::dmat4& ndc_from_world) {
    const Rows rows = rows_of(ndc_from_world);
    const glm::dvec3 normal = glm::cross(glm::dvec3(rows[0]), glm::dvec3(rows[1]));
    const double size = glm::length(glm::dvec3(rows[0])) * glm::length(glm::dvec3(rows[1]));
    return glm::length(normal) > kTolerance * size && glm::length(rows[3]) > 0;
}

StoredMatrices of_version_2(const ExrPart& part) {
    StoredMatrices result;
    std::string& damage = result.fault;
    const auto view = stored_matrix(part.metadata, "worldToCamera", damage);
    const auto ndc = stored_matrix(part.metadata, "worldToNDC", damage);
    if (view && (!is_affine(*view) || !(std::abs(glm::determinant(glm::dmat3(*view))) > 0)))
        damage = "worldToCamera is singular";
    else if (view) result.camera_from_world = camera_matrix(looking_back({*view, 1, false}));
    if (ndc && !spans_picture(*ndc)) damage = "worldToNDC is singular";
    else if (ndc) {
        Rows rows = rows_of(*ndc);
        rows[0] = 2.0 * rows[0] - rows[3];
        rows[1] = rows[3] - 2.0 * rows[1];
        result.ndc_from_world = camera_matrix(matrix_of(rows));
    }
    if (result.camera_from_world || result.ndc_from_world) result.found = "by OpenEXR's definition";
    result.contradiction = result.fault;
    return result;
}

/// A projection of the header and the view that it fits.
struct Fit {
    View view;
    glm::dmat4 ndc_from_world{1};
    std::string found;  ///< "worldToNDC, 0 to 1 with y down"
};

/// nullopt with a sentence in `fault` where the matrix does not project as the view does.
std::optional<Fit> fit_of(const char* name, const glm::dmat4& stored, View view, const ExrPart& part,
                          const Camera& lens, std::string& fault) {
    const glm::dmat4 ndc_from_world = view.transposed ? glm::transpose(stored) : stored;
    if (nearly_equal(ndc_from_world, view.camera_from_world)) {
        fault = std::string(name) + " equals worldToCamera: it does not project";
        return std::nullopt;
    }
    const glm::dvec4 divisor = rows_of(ndc_from_world)[3];
    const bool is_orthographic = glm::length(glm::dvec3(divisor)) < kTolerance * std::abs(divisor.w);
    view.ahead = ahead_by(ndc_from_world, view);
    if (view.ahead == 0 && !is_orthographic) {
        fault = std::string(name) + " does not divide by the distance that worldToCamera gives";
        return std::nullopt;
    }
    const Projection projection(ndc_from_world, view, part);
    if (const std::string why = projection.fault(); !why.empty()) {
        fault = std::string(name) + " " + why;
        return std::nullopt;
    }
    const bool is_unsigned = projection.is_unsigned(lens);
    return Fit{view, projection.normalized(is_unsigned),
               std::string(name) + (is_unsigned ? ", 0 to 1" : ", -1 to 1") +
                   (projection.is_down() ? " with y down" : " with y up")};
}

/// The camera's axes in the world: right, up and back, each as long as a unit of the camera.
struct Axes {
    glm::dvec3 right, up, back;
    const char* order = "";
};

/// Whether the camera is level by the world's axis `vertical`, and tilted by 45 degrees at most.
bool stands_upright(const Axes& axes, int vertical) {
    const double length = glm::length(axes.right);
    return std::abs(axes.right[vertical]) < 0.02 * length && axes.up[vertical] > 0.7 * length;
}

/// V-Ray's rows are right, back and down from Maya, where y is up, and right, up and back from 3ds Max, where
/// z is up; found on headers of V-Ray 3.60 and 4.30 for Maya and of files that vrimg2exr made. nullopt where
/// neither the header nor the picture's level says which.
std::optional<Axes> axes_of_transform(const glm::dmat4& stored, const ExrMetadata& metadata) {
    const glm::dmat3 rows(stored);
    const Axes maya{rows[0], -rows[2], rows[1], "right, back and down"};
    const Axes max{rows[0], rows[1], rows[2], "right, up and back"};
    const std::string version = metadata.text("vrayInfo/vrayversion").value_or("");
    if (version.find("Maya") != std::string::npos) return maya;
    const bool fits_maya = stands_upright(maya, 1), fits_max = stands_upright(max, 2);
    if (fits_maya == fits_max) return std::nullopt;
    return fits_maya ? maya : max;
}

/// V-Ray stores where the camera is in the world, and no projection.
StoredMatrices of_camera_transform(const ExrPart& part, const Camera& lens) {
    StoredMatrices result;
    const auto stored = stored_matrix(part.metadata, "cameraTransform", result.fault);
    result.contradiction = result.fault;
    if (!stored) return result;
    if (!is_affine(*stored) || !is_rigid(*stored) || glm::determinant(glm::dmat3(*stored)) <= 0) {
        result.fault =
            "cameraTransform is not a camera's: its axes are not right-handed, at right angles and of "
            "one length";
        result.contradiction = result.fault;
        return result;
    }
    const auto axes = axes_of_transform(*stored, part.metadata);
    if (part.metadata.number("cameraProjection").value_or(0) != 0 || !axes) {
        result.fault = axes ? "cameraTransform is of a camera that does not project in perspective"
                            : "cameraTransform does not show which of its rows is up";
        return result;
    }
    const glm::dmat4 camera_from_world = glm::inverse(glm::dmat4(
        glm::dvec4(axes->right, 0), glm::dvec4(axes->up, 0), glm::dvec4(axes->back, 0), (*stored)[3]));
    result.camera_from_world = camera_matrix(camera_from_world);
    result.found = std::string("cameraTransform, rows are ") + axes->order;
    if (const auto ndc = ndc_of_lens(camera_from_world, part, lens)) {
        result.ndc_from_world = camera_matrix(*ndc);
        result.found += "; projection of the lens";
    }
    return result;
}

/// Of an orthographic or unknown projection: of a right-handed world, OpenEXR's view is mirrored.
double ahead_by_handedness(const View& view) {
    return glm::determinant(glm::dmat3(view.camera_from_world)) < 0 ? 1 : -1;
}

}  // namespace

StoredMatrices read_matrices(const ExrPart& part, const Camera& lens) {
    if (part.metadata.number(kVersionAttribute) == kOpenExrVersion) return of_version_2(part);
    StoredMatrices result;
    const auto stored = stored_matrix(part.metadata, "worldToCamera", result.fault);
    if (!stored && result.fault.empty()) return of_camera_transform(part, lens);
    const std::vector<View> views = stored ? views_of(*stored) : std::vector<View>{};
    if (stored && views.empty())
        result.fault = "worldToCamera is not a camera's: its axes are not at right angles and of one length";
    result.contradiction = result.fault;
    if (views.empty()) return result;
    std::optional<Fit> fit;
    for (const View& view : views)
        for (const char* name : {"worldToNDC", "worldToScreen"}) {
            std::string fault;
            const auto ndc = fit ? std::nullopt : stored_matrix(part.metadata, name, fault);
            if (ndc) fit = fit_of(name, *ndc, view, part, lens, fault);
            if (result.fault.empty()) result.fault = fault;
            // Some renderers write it a second time, for want of a projection.
            if (!fit && !(ndc && nearly_equal(*ndc, *stored)) && result.contradiction.empty())
                result.contradiction = fault;
        }
    View view = fit ? fit->view : views.front();
    if (view.ahead == 0) view.ahead = ahead_by_handedness(view);
    const glm::dmat4 camera_from_world = looking_back(view);
    result.camera_from_world = camera_matrix(camera_from_world);
    result.found = std::string("worldToCamera, ") + (view.ahead > 0 ? "+z" : "-z") + " ahead" +
                   (view.transposed ? ", transposed" : "");
    if (fit) {
        result.ndc_from_world = camera_matrix(fit->ndc_from_world);
        result.found += "; " + fit->found;
        result.fault.clear();
        result.contradiction.clear();
    } else if (const auto ndc = ndc_of_lens(camera_from_world, part, lens)) {
        result.ndc_from_world = camera_matrix(*ndc);
        result.found += "; projection of the lens";
    }
    return result;
}

void add_matrices(const Camera& camera, std::map<std::string, ExrValue>& attributes) {
    if (camera.camera_from_world) {
        Rows rows = rows_of(glm_matrix(*camera.camera_from_world));
        rows[2] = -rows[2];
        attributes["worldToCamera"] = stored_values(matrix_of(rows));
    }
    if (camera.ndc_from_world) {
        Rows rows = rows_of(glm_matrix(*camera.ndc_from_world));
        rows[0] = 0.5 * (rows[0] + rows[3]);
        rows[1] = 0.5 * (rows[3] - rows[1]);
        attributes["worldToNDC"] = stored_values(matrix_of(rows));
    }
    if (camera.camera_from_world || camera.ndc_from_world) attributes[kVersionAttribute] = kOpenExrVersion;
}

}  // namespace aftershade
