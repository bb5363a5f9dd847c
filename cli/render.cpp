#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <optional>
#include <thread>

#include <nlohmann/json.hpp>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "cli/gl_options.h"
#include "cli/gl_visibility.h"
#include "cli/interrupt.h"
#include "cli/verbs.h"
#include "cli/visibility_options.h"
#include "framework/base/cores.h"
#include "framework/base/input_files.h"
#include "framework/base/text.h"
#include "framework/capture/deep_layers.h"
#include "framework/capture/frame_range.h"
#include "framework/scene/job.h"
#include "framework/scene/scene_reader.h"

namespace aftershade::cli {

namespace {

struct RenderArguments {
    std::string scene;
    std::string folder;
    std::string frames;
    std::string size;
    std::vector<std::string> truths;
    std::string method = "accumulation";
    int samples = 0;
    std::string surface = "visible";
    std::string jitter = "none";
    std::string space = "screen";
    std::string object;
    int texture_size = 512;
    std::string profile = "native";
    std::vector<std::string> profile_paths;
    VisibilityArguments visibility;
    bool only_truth = false;
    bool json = false;
    bool quiet = false;
    scene::Job job;
};

void add_options(CLI::App& app, RenderArguments& options) {
    app.add_option("scene", options.scene, "A scene.json or its folder")->required();
    app.add_option("-o,--output", options.folder, "Folder for the capture; created if missing")->required();
    app.add_option("--frames", options.frames, "Frames to render, such as 1-24 (default: the scene's)");
    app.add_option("--size", options.size, "WIDTHxHEIGHT in px (default: the scene's)");
    const std::string group = app.option_defaults()->get_group();
    app.option_defaults()->group("Truth");
    app.add_option(
           "--truth", options.truths,
           "Also render a true picture: lens, shutter and antialias, joined by +, or scattering; repeatable")
        ->allow_extra_args(false);
    app.add_option(
           "--truth-method", options.method,
           "accumulation (all pixels share one set of samples) or interleaved (each pixel has its own)")
        ->check(CLI::IsMember({"accumulation", "interleaved"}))
        ->capture_default_str();
    app.add_option("--samples", options.samples, "Samples of each truth (default: 256; scattering: 2048)")
        ->check(CLI::Range(1, scene::kMaxSamples));
    app.add_option("--surface", options.surface,
                   "scattering: light from the visible surface, or from the whole object")
        ->check(CLI::IsMember({"visible", "whole"}))
        ->capture_default_str();
    app.add_flag("--truth-only", options.only_truth, "Write no capture");
    app.option_defaults()->group(group);
    add_visibility_options(app, options.visibility);
    app.add_option("--layers", options.job.layers,
                   "Surfaces behind one another, each in files of its own that capture.json names as layers")
        ->check(CLI::Range(1, kMostLayers))
        ->capture_default_str();
    app.add_flag(
        "--deep", options.job.deep,
        "Deep captures: every surface that 16 rays a pixel meet, with the share of the rays as its alpha");
    app.add_option("--subframes", options.job.subframes, "Number of captures over each frame's exposure")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--jitter", options.jitter, "Jitter of the pixel samples: none, or halton (16 phases)")
        ->check(CLI::IsMember({"none", "halton"}))
        ->capture_default_str();
    app.add_option("--space", options.space, "screen, or uv for one object over its texture coordinates")
        ->check(CLI::IsMember({"screen", "uv"}))
        ->capture_default_str();
    app.add_option("--object", options.object, "--space uv: the object's name");
    app.add_option("--texture-size", options.texture_size, "--space uv: side of the picture, in px")
        ->check(CLI::Range(1, 8192))
        ->capture_default_str();
    app.add_option("--profile", options.profile,
                   "Conventions of the files: native, blender, unreal, nuke, ...")
        ->capture_default_str();
    app.add_option("--profile-path", options.profile_paths,
                   "Search this folder for profiles before the shipped ones; repeatable")
        ->allow_extra_args(false);
    app.add_option("--compression", options.job.compression,
                   "none, rle, zips, zip or piz; zip:1 packs fastest, zip:9 most")
        ->check([](const std::string& text) -> std::string {
            const std::vector<std::string> lossless = {"none", "rle", "zips", "zip", "piz"};
            if (std::ranges::find(lossless, text) != lossless.end() || exr_compression_level(text)) return "";
            return text + " is not one of " + list_of_names(lossless) +
                   ", or zip or zips with a level, as zip:1";
        })
        ->capture_default_str();
    app.add_option("--seed", options.job.seed, "Seed of the random samples");
    add_allow_path_option(app);
    app.add_flag("--json", options.json, "Print a report as JSON on stdout");
    app.add_flag("--quiet", options.quiet, "Do not print a line per frame");
}

Place place_of(const std::string& option, const std::string& value) {
    return {option + " " + value, 0, 0};
}

void read_size(const std::string& text, scene::Job& job, Diagnostics& diagnostics) {
    const std::size_t x = text.find('x');
    const auto side = [&](const std::string& part) {
        const auto range = parse_frame_range(part);
        return range && range->size() == 1 ? range->front() : 0;
    };
    const int width_px = x == std::string::npos ? 0 : side(text.substr(0, x));
    const int height_px = x == std::string::npos ? 0 : side(text.substr(x + 1));
    if (std::min(width_px, height_px) >= 1 && std::max(width_px, height_px) <= 16384)
        job.width_px = width_px, job.height_px = height_px;
    else diagnostics.error(place_of("--size", text), "a size is WIDTHxHEIGHT, sides from 1 to 16384 px");
}

void read_texture_space(const RenderArguments& options, const scene::Scene& scene, scene::Job& job,
                        Diagnostics& diagnostics) {
    if (options.space != "uv") {
        if (!options.object.empty())
            diagnostics.error(place_of("--object", options.object), "is for --space uv");
        return;
    }
    std::vector<std::string> names;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        if (object.name.empty() || object.shape.kind == scene::ShapeKind::group) continue;
        names.push_back(object.name);
        if (object.name == options.object) job.texture_object = int(i);
    }
    if (job.texture_object >= 0) return;
    diagnostics.error(place_of("--object", options.object),
                      names.empty() ? "the scene has no object with a name"
                                    : "--space uv needs the name of an object: " + list_of_names(names) +
                                          did_you_mean(options.object, names));
}

/// The rest of the job, from words.
void complete_job(const RenderArguments& options, const scene::Scene& scene, scene::Job& job,
                  Diagnostics& diagnostics) {
    job.folder = options.folder;
    job.frames = scene.frames;
    job.width_px = scene.width_px;
    job.height_px = scene.height_px;
    if (!options.size.empty()) read_size(options.size, job, diagnostics);
    if (!options.frames.empty()) {
        const auto frames = parse_frame_range(options.frames);
        if (frames && !frames->empty()) job.frames = *frames;
        else diagnostics.error(place_of("--frames", options.frames), frame_range_fault(options.frames));
    }
    for (const std::string& text : options.truths) {
        if (const auto truth = scene::parse_truth(text)) job.truths.push_back(*truth);
        else
            diagnostics.error(place_of("--truth", text),
                              "is neither scattering nor lens, shutter and antialias joined by +");
    }
    if (options.samples > 0) job.samples = job.scattering_samples = options.samples;
    job.method =
        options.method == "interleaved" ? scene::TruthMethod::interleaved : scene::TruthMethod::accumulation;
    job.visible_only = options.surface == "visible";
    job.visibility = read_visibility(options.visibility, diagnostics);
    job.captures = !options.only_truth;
    job.jitter = options.jitter == "halton";
    job.texture_side_px = options.texture_size;
    job.threads = allotted_cores();
    read_texture_space(options, scene, job, diagnostics);
    scene::check_job(scene, job, diagnostics);
}

void print_report(const RenderArguments& options, const scene::JobReport& report,
                  const std::optional<GlVisibility>& gl) {
    if (options.json) {
        nlohmann::ordered_json json = {{"frames", report.frames},
                                       {"render_s", report.render_s},
                                       {"total_s", report.total_s},
                                       {"roles_left_out", report.roles_left_out}};
        json["files"] = nlohmann::json::array();
        for (const auto& file : report.files) json["files"].push_back(file.string());
        if (!report.visibility.empty()) json["visibility"] = visibility_json(report.visibility);
        if (gl) json["gl"] = gl->json();
        std::cout << json.dump(2) << "\n";
    } else {
        for (const auto& file : report.files) std::cout << file.string() << "\n";
    }
    if (!report.roles_left_out.empty())
        std::cerr << "the profile '" << options.profile << "' has no way to store "
                  << list_of_names(report.roles_left_out, "and") << "\n";
    if (!options.quiet && !options.json) print_visibility(report.visibility);
    if (!options.quiet)
        std::cerr << counted(std::size_t(report.frames), "frame") << " in " << report.total_s
                  << " s, of which rendering " << report.render_s << " s\n";
}

ExitCode render(RenderArguments options) {
    const std::atomic<bool>& stop = watch_for_interrupt();
    Diagnostics diagnostics;
    const std::vector<Profile> profiles = load_profiles(options.profile_paths, diagnostics);
    std::vector<std::string> ids;
    for (const Profile& profile : profiles) ids.push_back(profile.id);
    const auto profile = std::find_if(profiles.begin(), profiles.end(),
                                      [&](const Profile& one) { return one.id == options.profile; });
    if (profile == profiles.end())
        diagnostics.error(place_of("--profile", options.profile),
                          "there are " + list_of_names(ids, "and") + did_you_mean(options.profile, ids));
    std::filesystem::path path = options.scene;
    if (std::filesystem::is_directory(path)) path /= "scene.json";
    const auto scene = scene::read_scene(path, diagnostics);
    if (options.job.deep && options.profile != "native")
        diagnostics.error(place_of("--profile", options.profile), "--deep writes the native channels alone");
    if (scene) complete_job(options, *scene, options.job, diagnostics);
    InputFiles inputs;
    inputs.add(diagnostics.documents());
    if (options.job.captures)
        inputs.check_output(place_of("-o", options.folder),
                            std::filesystem::path(options.folder) / "capture.json", diagnostics);
    diagnostics.print(std::cerr);
    if (diagnostics.has_errors()) return ExitCode::usage;
    std::optional<GlVisibility> gl;
    if (options.job.visibility && options.visibility.device == "gl") {
        gl.emplace(chosen_gl(options.visibility.gl));
        warn_of_software(gl->info());
        options.job.visibility_passes = gl->passes();
    }
    const scene::JobReport report = scene::run_job(*scene, *profile, options.job, stop, [&](int frame) {
        if (!options.quiet) std::cerr << "frame " << frame << "\n";
    });
    print_report(options, report, gl);
    return stop ? ExitCode::interrupted : ExitCode::done;
}

}  // namespace

Verb add_render(CLI::App& app) {
    auto options = std::make_shared<RenderArguments>();
    add_options(app, *options);
    return [options] { return render(*options); };
}

}  // namespace aftershade::cli
