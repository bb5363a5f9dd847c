// Faults of a job that show before any work.
#include <fmt/format.h>
#include <algorithm>
#include <cstdint>

#include "framework/base/option.h"
#include "framework/image/role.h"
#include "framework/scene/job.h"
#include "framework/scene/kept_shadings.h"

namespace aftershade::scene {

namespace {

constexpr std::int64_t kMaxFileNumber = 999'999'999;  // nine digits: parse_frame_range

bool numbers_fit(const Job& job) {
    if (job.frames.empty()) return true;
    const auto [first, last] = std::minmax_element(job.frames.begin(), job.frames.end());
    return std::int64_t(*first) * job.subframes >= -kMaxFileNumber &&
           (std::int64_t(*last) + 1) * job.subframes - 1 <= kMaxFileNumber;
}

/// Whether any texel can show the object: shapes have coordinates of their own, meshes those of their file.
bool has_texture_space(const Scene& scene, int object) {
    const Shape& shape = scene.objects[std::size_t(object)].shape;
    if (shape.kind != ShapeKind::mesh) return shape.kind != ShapeKind::group;
    const Mesh& mesh = scene.meshes[std::size_t(shape.mesh)];
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const auto& corners) {
        const glm::dvec2 &a = mesh.vertices[corners[0]].uv, &b = mesh.vertices[corners[1]].uv,
                         &c = mesh.vertices[corners[2]].uv;
        const glm::dvec2 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        const glm::dvec2 ab = b - a, ac = c - a;
        return ab.x * ac.y != ab.y * ac.x && std::max(low.x, low.y) < 1 && std::min(high.x, high.y) > 0;
    });
}

constexpr double kGiB = 1024.0 * 1024 * 1024;

bool has_lists(const Job& job) {
    return job.visibility && job.visibility->transparency.transparency == Transparency::lists;
}

bool keeps_shading(const Job& job) {
    return job.visibility && job.visibility->keep_shading;
}

/// The memory of one capture with every role and of the one before it, which is being written, of the hits of
/// visibility samples, and of kept light.
std::uint64_t bytes_of_job(const Scene& scene, const Job& job) {
    std::uint64_t channels = 0;
    for (const std::string& role : role_names()) channels += std::uint64_t(find_role(role)->channels);
    const bool is_texture = job.texture_object >= 0;
    const std::uint64_t width = std::uint64_t(is_texture ? job.texture_side_px : job.width_px);
    const std::uint64_t height = std::uint64_t(is_texture ? job.texture_side_px : job.height_px);
    std::uint64_t visibility = 0;
    if (job.visibility) {
        visibility = std::uint64_t(job.visibility->samples) * sizeof(std::uint32_t);
        if (has_lists(job))
            visibility += std::uint64_t(job.visibility->transparency.list_nodes) *
                          (sizeof(ListNode) + sizeof(std::uint32_t));
        if (keeps_shading(job))
            visibility += std::uint64_t(
                KeptShadings::samples_of_pixel(job.visibility->samples, job.visibility->grid.rate) *
                double(KeptShadings::bytes_of_sample(scene.lights.size())));
        visibility *= width * height;
    }
    return 2 * width * height * channels * sizeof(float) * std::uint64_t(job.layers) + visibility;
}

}  // namespace

void check_job(const Scene& scene, const Job& job, Diagnostics& diagnostics) {
    const auto fault = [&](Option option, const std::string& text, const std::string& value = "") {
        diagnostics.error(option_place(option, value), text);
    };
    if (job.folder.empty()) fault(Option::output, "names no folder");
    if (!numbers_fit(job))
        fault(Option::subframes,
              fmt::format("file numbers are {} times the frame's number and exceed {}, the largest "
                          "that a capture can have; choose lower frames",
                          job.subframes, kMaxFileNumber));
    if (const std::uint64_t bytes = bytes_of_job(scene, job); bytes > kMaxJobBytes)
        fault(job.texture_object >= 0 ? Option::texture_size : Option::size,
              fmt::format("rendering needs about {:.1f} GiB of memory; the limit is {:.0f} GiB (render fewer "
                          "pixels at once{})",
                          double(bytes) / kGiB, double(kMaxJobBytes) / kGiB,
                          has_lists(job)       ? ", or choose fewer " + spelled(Option::list_nodes)
                          : keeps_shading(job) ? ", or choose a lower " + spelled(Option::shading_rate)
                                               : ""));
    if (!job.captures && job.truths.empty() && !job.visibility)
        fault(Option::truth_only, "leaves nothing to render; add " + spelled(Option::truth) + " or " +
                                      spelled(Option::visibility));
    const bool scattering =
        std::any_of(job.truths.begin(), job.truths.end(), [](const Truth& t) { return t.scattering; });
    const bool scatters =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [](const Material& material) { return material.scattering.has_value(); });
    if (scattering && scene.has_transparency())
        fault(Option::truth,
              "the scene has materials with an \"opacity\" below 1 or glTF's alphaMode BLEND; scattering "
              "needs opaque ones",
              "scattering");
    if (scattering && !scatters)
        fault(Option::truth, "no material of the scene has a \"scattering_profile\"", "scattering");
    if (scattering && job.scattering_samples < 64)
        fault(Option::samples, "scattering needs at least 64 points for each pixel");
    const bool shutter =
        std::any_of(job.truths.begin(), job.truths.end(), [](const Truth& t) { return t.kinds.shutter; });
    if ((shutter || job.subframes > 1) && scene.camera.shutter_angle_deg == 0)
        diagnostics.error(
            {"the shutter"},
            "its angle is 0, so that it never opens; write \"shutter\": { \"angle\": 180 } in the scene");
    if (job.texture_object >= 0 && job.subframes > 1)
        fault(Option::subframes, "texture space has no sub-frames");
    if (job.texture_object >= 0 && !job.truths.empty()) fault(Option::truth, "is not there in texture space");
    if (job.texture_object >= 0 && job.visibility) fault(Option::visibility, "is not there in texture space");
    const bool is_layered = job.deep || job.layers > 1;
    const Option layered = job.deep ? Option::deep : Option::layers;
    if (is_layered && job.texture_object >= 0) fault(layered, "is not there in texture space");
    if (is_layered && !job.captures)
        fault(layered, "is of captures, and " + spelled(Option::truth_only) + " writes none");
    if (job.deep && job.layers > 1)
        fault(Option::layers, "is not for " + spelled(Option::deep) + ", whose samples have no such number");
    if (job.texture_object >= 0 && job.jitter) fault(Option::jitter, "is not there in texture space");
    if (job.texture_object >= 0 && !has_texture_space(scene, job.texture_object))
        fault(Option::object,
              "no triangle of its mesh has texture coordinates between 0 and 1, so there would be nothing to "
              "see; give the mesh an unwrapping (TEXCOORD_0)");
}

}  // namespace aftershade::scene
