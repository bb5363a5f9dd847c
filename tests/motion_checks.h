// What the tests of motion effects share: captures of shipped scenes with the truth of their shutter, the
// changed pixels of docs/architecture.md, and Suzanne through her renderer's shutter.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "framework/capture/profile.h"
#include "framework/capture/sequence.h"
#include "framework/compare/metrics.h"
#include "framework/file/exr_file.h"
#include "framework/scene/scene_renderer.h"
#include "tests/backends.h"
#include "tests/look_runner.h"
#include "tests/scene/scene_text.h"

namespace aftershade::test {

/// One frame of a shipped scene, and what its open shutter sees of it.
struct ShutterScene {
    ShutterScene(const std::string& id, int frame, int width_px, int height_px, int samples = 128)
        : source(scene::shipped_scene(id)) {
        const scene::SceneRenderer renderer(source, width_px, height_px, 2);
        capture = renderer.render_capture(frame);
        scene::TruthSettings settings;
        settings.kinds.shutter = true;
        settings.samples = samples;
        truth = renderer.render_truth(frame, settings);
    }

    double psnr_db(const Image& picture) const { return display_psnr_db(truth, picture); }

    scene::Scene source;
    Capture capture;
    Image truth;
};

/// Whether a pixel lies where truth and sharp picture differ: d, the mean over RGB of their difference as
/// sRGB, has a mean above 0.02 over the window x - 8 to x + 9, y - 8 to y + 9, its edges repeated.
inline std::vector<bool> changed_pixels(const Image& sharp, const Image& truth) {
    const int width = sharp.width(), height = sharp.height();
    const auto difference = [&](int x, int y) {
        const int i = std::clamp(x, 0, width - 1), j = std::clamp(y, 0, height - 1);
        double sum = 0;
        for (int c = 0; c < 3; ++c)
            sum += std::abs(srgb_of_clamped(truth.at(i, j, c)) - srgb_of_clamped(sharp.at(i, j, c))) / 3;
        return sum;
    };
    // Sums over all that lies above and to the left, of the picture with 8 and 9 pixels around it.
    const int across = width + 18;
    std::vector<double> sums(std::size_t(across) * std::size_t(height + 18), 0.0);
    const auto sum_at = [&](int x, int y) -> double& {
        return sums[std::size_t(y) * std::size_t(across) + std::size_t(x)];
    };
    for (int y = 1; y < height + 18; ++y)
        for (int x = 1; x < across; ++x)
            sum_at(x, y) =
                difference(x - 9, y - 9) + sum_at(x - 1, y) + sum_at(x, y - 1) - sum_at(x - 1, y - 1);
    std::vector<bool> changed;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double sum = sum_at(x + 18, y + 18) - sum_at(x, y + 18) - sum_at(x + 18, y) + sum_at(x, y);
            changed.push_back(sum / (18.0 * 18.0) > 0.02);
        }
    return changed;
}

inline double display_psnr_db_where(const std::vector<bool>& where, const Image& truth,
                                    const Image& picture) {
    double sum = 0;
    std::size_t count = 0;
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            if (!where[std::size_t(y) * std::size_t(truth.width()) + std::size_t(x)]) continue;
            for (int c = 0; c < 3; ++c) {
                const double error =
                    srgb_of_clamped(truth.at(x, y, c)) - srgb_of_clamped(picture.at(x, y, c));
                sum += error * error;
            }
            count += 3;
        }
    return -10 * std::log10(sum / double(count));
}

/// Suzanne's frame 4, which a shutter of half a frame sees for 128 samples; `folder` is
/// $AFTERSHADE_CAPTURES/suzanne.
struct SuzanneInMotion {
    explicit SuzanneInMotion(const std::filesystem::path& folder) {
        Sequence sequence;
        sequence.files = FramePattern((folder / "large/gbuffer_####.exr").string());
        sequence.profile = "blender";
        Diagnostics diagnostics;
        const CaptureReader reader(sequence, read_profiles(AFTERSHADE_SOURCE_DIR "/profiles", diagnostics),
                                   {});
        const std::vector<std::string> all{"color", "depth", "velocity", "velocity_next", "object_id"};
        const std::vector<std::string> seen{"color", "depth"};
        before = reader.read(3, seen);
        capture = reader.read(4, all);
        after = reader.read(5, seen);
        const ExrFile truth_file(folder / "truth/motion_0004.exr");
        truth = truth_file.read_floats(0, std::vector<std::string>{"R", "G", "B"});
        changed = changed_pixels(capture.images.at("color"), truth);
    }

    struct Psnr {
        double all_db = 0;
        double changed_db = 0;
    };
    Psnr psnr(const Image& picture) const {
        return {display_psnr_db(truth, picture), display_psnr_db_where(changed, truth, picture)};
    }
    Psnr through(const std::string& effect, const std::string& params = "") const {
        LookRunner runner(look_of_step(effect, params), gpu::test_backend());
        FrameInputs frame;
        frame.capture = &capture;
        frame.neighbours[-1] = &before;
        frame.neighbours[1] = &after;
        const Psnr result = psnr(runner.run(frame).images.at("color"));
        fmt::print("{} {}: {:.2f} dB, in changed pixels {:.2f}\n", effect, params, result.all_db,
                   result.changed_db);
        return result;
    }

    Capture before, capture, after;
    Image truth;
    std::vector<bool> changed;
};

}  // namespace aftershade::test
