// Rendering a scene into a folder: captures, their document, and truths.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/capture/profile.h"
#include "framework/file/exr_file.h"
#include "framework/scene/scene.h"
#include "framework/scene/scene_renderer.h"
#include "framework/scene/visibility.h"

namespace aftershade::scene {

/// One true picture: any of lens, shutter and antialias together, or scattering alone.
struct Truth {
    TruthKinds kinds;
    bool scattering = false;
    std::string name() const;  ///< "lens+shutter", "scattering"
};

/// "lens", "lens+shutter", "antialias", "scattering", ...; nullopt for anything else.
std::optional<Truth> parse_truth(const std::string& text);

struct Job {
    std::filesystem::path folder;  ///< is made where it is not there
    std::vector<int> frames;       ///< of the scene
    int width_px = 480;
    int height_px = 270;
    bool captures = true;     ///< false: truths alone
    int layers = 1;           ///< of captures: surfaces behind one another, up to kMostLayers
    bool deep = false;        ///< captures hold deep samples
    int subframes = 1;        ///< of the exposure; files N * frame + s
    bool jitter = false;      ///< of captures and truths, by halton_jitter_px over 16 frames
    int texture_object = -1;  ///< index of the object whose texture space is rendered; -1: the picture
    int texture_side_px = 512;
    std::vector<Truth> truths;
    TruthMethod method = TruthMethod::accumulation;
    int samples = 256;  ///< of lens, shutter and antialias
    int scattering_samples = 2048;
    bool visible_only = true;
    std::optional<VisibilitySettings> visibility;  ///< jitter and seed are the job's
    VisibilityPasses visibility_passes = {};
    std::uint32_t seed = 0;
    int threads = 1;
    std::string compression = "zip";
};

/// Memory of the pictures that a job may keep at once.
inline constexpr std::uint64_t kMaxJobBytes = 16ull * 1024 * 1024 * 1024;

/// Faults that show before any work; `label` of each is the option's name.
void check_job(const Scene& scene, const Job& job, Diagnostics& diagnostics);

struct JobReport {
    int frames = 0;
    std::vector<std::filesystem::path> files;
    std::vector<std::string> roles_left_out;   ///< that the profile has no way to store
    std::vector<VisibilityReport> visibility;  ///< of each frame
    double render_s = 0;                       ///< without writing
    double total_s = 0;
};

/// Renders and writes, files by rename, with one frame being written while the next is rendered. `done` is
/// called after each frame with its number. Ends early, between frames, when `stop` is set; capture.json then
/// names the frames that are there. Throws Error(ErrorKind::output).
JobReport run_job(const Scene& scene, const Profile& profile, const Job& job, const std::atomic<bool>& stop,
                  const std::function<void(int frame)>& done);

}  // namespace aftershade::scene
