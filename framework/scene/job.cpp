#include "framework/scene/job.h"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>
#include <deque>
#include <future>
#include <set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/capture/capture_writer.h"
#include "framework/capture/light.h"
#include "framework/document/units.h"
#include "framework/scene/rate_image.h"
#include "framework/scene/samples.h"
#include "framework/scene/triangulate.h"

namespace aftershade::scene {

namespace fs = std::filesystem;

namespace {

constexpr int kJitterPhases = 16;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

CaptureLight capture_light(const Light& light, const LightState& state) {
    CaptureLight result;
    result.name = light.name;
    result.kind = light.kind == LightKind::point  ? CaptureLight::Kind::point
                  : light.kind == LightKind::area ? CaptureLight::Kind::area
                                                  : CaptureLight::Kind::directional;
    for (int c = 0; c < 3; ++c) {
        // Of a directional light only the direction counts.
        if (light.kind != LightKind::directional) result.position_m[std::size_t(c)] = state.position_m[c];
        result.direction[std::size_t(c)] = state.direction[c];
        result.intensity[std::size_t(c)] = state.color_intensity[c];
    }
    if (light.kind == LightKind::area) result.size_m = {light.size_m.x, light.size_m.y};
    return result;
}

std::vector<CaptureLight> capture_lights(const Scene& scene, const SceneState& state) {
    std::vector<CaptureLight> lights;
    for (std::size_t i = 0; i < scene.lights.size(); ++i)
        lights.push_back(capture_light(scene.lights[i], state.lights[i]));
    return lights;
}

bool is_constant(const Light& light) {
    return light.position_m.is_constant() && light.target_m.is_constant() && light.intensity.is_constant();
}

/// Writes files one after another on a thread of its own, with at most one waiting, so that memory stays
/// level.
class BackgroundWriter {
public:
    /// Rethrows what an earlier write threw.
    void write(std::function<void()> work) {
        finish();
        pending_ = std::async(std::launch::async, std::move(work));
    }
    void finish() {
        if (pending_.valid()) pending_.get();
    }

private:
    std::future<void> pending_;
};

class JobRunner {
public:
    JobRunner(const Scene& scene, const Profile& profile, const Job& job)
        : scene_(scene),
          profile_(profile),
          job_(job),
          renderer_(scene, job.width_px, job.height_px, job.threads) {}

    JobReport run(const std::atomic<bool>& stop, const std::function<void(int)>& done) {
        const Clock::time_point start = Clock::now();
        std::error_code failure;
        fs::create_directories(job_.folder, failure);
        if (failure) throw Error(ErrorKind::output, job_.folder.string() + ": " + failure.message());
        remove_stale_temporaries(job_.folder);
        for (const int frame : job_.frames) {
            if (stop) break;
            if (job_.captures) render_captures(frame);
            for (const Truth& truth : job_.truths) render_truth(frame, truth);
            if (job_.visibility) render_visibility_of(frame, *job_.visibility);
            ++report_.frames;
            rendered_.push_back(frame);
            done(frame);
        }
        writer_.finish();
        if (job_.captures && !rendered_.empty()) write_document();
        report_.roles_left_out.assign(left_out_.begin(), left_out_.end());
        report_.total_s = seconds_since(start);
        return report_;
    }

private:
    std::array<double, 2> jitter_px(int frame) const {
        const int phase = ((frame % kJitterPhases) + kJitterPhases) % kJitterPhases;
        return job_.jitter ? halton_jitter_px(phase + 1) : std::array<double, 2>{0, 0};
    }

    void render_captures(int frame) {
        for (int s = 0; s < job_.subframes; ++s) {
            const double time =
                job_.subframes == 1 ? frame : exposure_of(scene_.camera, frame).middle(s, job_.subframes);
            const int number = frame * job_.subframes + s;
            if (job_.deep) {
                render_deep(frame, time, number);
                continue;
            }
            const Clock::time_point start = Clock::now();
            std::vector<Capture> layers;
            if (job_.texture_object >= 0)
                layers.push_back(
                    renderer_.render_texture_space(frame, job_.texture_object, job_.texture_side_px));
            else layers = renderer_.render_layers(frame, time, jitter_px(frame), job_.layers);
            report_.render_s += seconds_since(start);
            for (std::size_t i = 0; i < layers.size(); ++i)
                write(std::move(layers[i]), fmt::format("{}_{:04}.exr", capture_name(i), number), frame, time,
                      {});
        }
    }

    static std::string capture_name(std::size_t layer) {
        return layer == 0 ? "gbuffer" : "layer" + std::to_string(layer);
    }

    void render_deep(int frame, double time, int number) {
        const Clock::time_point start = Clock::now();
        DeepImage image = renderer_.render_deep(frame, time, jitter_px(frame));
        report_.render_s += seconds_since(start);
        CaptureHeader header;
        header.data_window = header.display_window = {0, 0, job_.width_px - 1, job_.height_px - 1};
        header.camera = capture_camera(scene_, state_at(scene_, frame, time), job_.width_px, job_.height_px);
        const CaptureWriteOptions options = complete(header, frame, time, {});
        const fs::path path = path_below(job_.folder, fmt::format("gbuffer_{:04}.exr", number));
        report_.files.push_back(path);
        writer_.write([image = std::move(image), header, path, options] {
            write_deep_capture(path, image, header, options);
        });
    }

    void render_truth(int frame, const Truth& truth) {
        const Clock::time_point start = Clock::now();
        Capture capture = empty_capture(frame);
        if (truth.scattering) {
            ScatteringTruth scattered = renderer_.render_scattering(
                frame, {job_.scattering_samples, job_.visible_only, jitter_px(frame)});
            capture.images["irradiance"] = std::move(scattered.irradiance);
            capture.images["color"] = std::move(scattered.color);
        } else {
            capture.images["color"] = renderer_.render_truth(
                frame, {truth.kinds, job_.method, job_.samples, job_.seed, jitter_px(frame)});
        }
        report_.render_s += seconds_since(start);
        std::string name = truth.name();
        std::replace(name.begin(), name.end(), '+', '_');
        const int samples = truth.scattering ? job_.scattering_samples : job_.samples;
        write(std::move(capture), fmt::format("truth_{}_{:04}.exr", name, frame), frame, frame,
              {{"aftershade/truth", truth.name()}, {"aftershade/samples", samples}});
    }

    Capture empty_capture(int frame) const {
        Capture capture;
        capture.header.data_window =
            capture.header.display_window = {0, 0, job_.width_px - 1, job_.height_px - 1};
        capture.header.camera =
            capture_camera(scene_, state_at(scene_, frame, frame), job_.width_px, job_.height_px);
        return capture;
    }

    void render_visibility_of(int frame, VisibilitySettings settings) {
        const Clock::time_point start = Clock::now();
        settings.seed = job_.seed;
        settings.jitter_px = jitter_px(frame);
        const Scene triangles = triangulated(scene_);
        VisibilityPicture picture =
            render_visibility(SceneRenderer(triangles, job_.width_px, job_.height_px, job_.threads), frame,
                              settings, job_.visibility_passes, settings.keep_shading ? &kept_ : nullptr);
        report_.render_s += seconds_since(start);
        report_.visibility.push_back(picture.report);
        Capture capture = empty_capture(frame);
        capture.images["color"] = std::move(picture.color);
        const std::string name(visibility_name(settings.visibility));
        write(std::move(capture), fmt::format("{}_{:04}.exr", name, frame), frame, frame,
              {{"aftershade/visibility", name}, {"aftershade/samples", settings.samples}});
        const fs::path rates = job_.folder / fmt::format("{}_rate_{:04}", name, frame);
        for (const char* ending : {".exr", ".png"})
            report_.files.push_back(path_below(job_.folder, rates.filename().string() + ending));
        writer_.write([rates, rate = std::move(picture.shading_rate)] {
            write_rate_exr(rates.string() + ".exr", rate);
            write_rate_png(rates.string() + ".png", rate);
        });
    }

    void write(Capture capture, const std::string& name, int frame, double time,
               std::map<std::string, ExrValue> attributes) {
        const CaptureWriteOptions options = complete(capture.header, frame, time, std::move(attributes));
        const fs::path path = path_below(job_.folder, name);
        report_.files.push_back(path);
        writer_.write([this, capture = std::move(capture), path, options] {
            for (const std::string& role : write_capture(path, capture, profile_, options))
                left_out_.insert(role);
        });
    }

    /// Lights and jitter into the header; and how it is written.
    CaptureWriteOptions complete(CaptureHeader& header, int frame, double time,
                                 std::map<std::string, ExrValue> attributes) const {
        header.lights = capture_lights(scene_, state_at(scene_, frame, time));
        if (job_.jitter) header.camera.jitter_px = jitter_px(frame);
        attributes["aftershade/time"] = float(time);
        CaptureWriteOptions options;
        options.compression = job_.compression;
        options.fps = scene_.fps;
        options.attributes = std::move(attributes);
        return options;
    }

    void write_document() {
        CaptureDocument document;
        document.frames = capture_name(0) + "_####.exr";
        for (int layer = 1; layer < job_.layers; ++layer)
            document.layers_behind.push_back(capture_name(std::size_t(layer)) + "_####.exr");
        document.frame_numbers = rendered_;
        document.fps = scene_.fps;
        document.profile = profile_.id;
        for (const Object& object : scene_.objects) document.objects[object.name] = object.id;
        document.cuts = scene_.cuts;
        document.subframes = job_.subframes;
        const SceneState state = state_at(scene_, job_.frames.front(), job_.frames.front());
        const Camera camera = capture_camera(scene_, state, job_.width_px, job_.height_px);
        document.camera = camera.values();
        document.lens_model = camera.lens_model;
        // What moves is in each frame's own header; capture.json would overrule that.
        if (!scene_.camera.focal_length_mm.is_constant()) document.camera.erase("focal_length");
        if (!scene_.camera.focus_distance_m.is_constant()) document.camera.erase("focus_distance");
        if (std::all_of(scene_.lights.begin(), scene_.lights.end(), is_constant))
            document.lights = capture_lights(scene_, state);
        const fs::path path = path_below(job_.folder, "capture.json");
        write_capture_document(path, document);
        report_.files.push_back(path);
    }

    const Scene& scene_;
    const Profile& profile_;
    const Job& job_;
    SceneRenderer renderer_;
    KeptShadings kept_;
    JobReport report_;
    std::vector<int> rendered_;  ///< frames
    std::set<std::string> left_out_;
    BackgroundWriter writer_;
};

}  // namespace

std::string Truth::name() const {
    if (scattering) return "scattering";
    std::string name;
    const auto add = [&](bool has, const char* word) {
        if (has) name += (name.empty() ? "" : "+") + std::string(word);
    };
    add(kinds.lens, "lens");
    add(kinds.shutter, "shutter");
    add(kinds.antialias, "antialias");
    return name;
}

std::optional<Truth> parse_truth(const std::string& text) {
    Truth truth;
    if (text == "scattering") {
        truth.scattering = true;
        return truth;
    }
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find('+', at), text.size());
        const std::string word = text.substr(at, end - at);
        bool* kind = word == "lens"        ? &truth.kinds.lens
                     : word == "shutter"   ? &truth.kinds.shutter
                     : word == "antialias" ? &truth.kinds.antialias
                                           : nullptr;
        if (!kind || *kind) return std::nullopt;
        *kind = true;
        at = end + 1;
    }
    return truth;
}

JobReport run_job(const Scene& scene, const Profile& profile, const Job& job, const std::atomic<bool>& stop,
                  const std::function<void(int frame)>& done) {
    return JobRunner(scene, profile, job).run(stop, done);
}

}  // namespace aftershade::scene
