#include "cli/visibility_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <iostream>

#include <nlohmann/json.hpp>

#include "cli/gl_options.h"

namespace aftershade::cli {

void add_visibility_options(CLI::App& app, VisibilityArguments& options) {
    scene::VisibilitySettings& settings = options.settings;
    // Only --visibility memoised has shading samples.
    const auto of_memoised = [&options](const std::string& name) {
        return [&options, name](const std::string&) { options.given.push_back(name); };
    };
    const std::string group = app.option_defaults()->get_group();
    app.option_defaults()->group("Many visibility samples");
    app.add_option("--visibility", options.visibility,
                   "Also render lens, shutter and antialias over triangles: memoised (light "
                   "once for each shading sample), supersampled or accumulation (light at every sample)")
        ->check(CLI::IsMember({"none", "memoised", "supersampled", "accumulation"}))
        ->capture_default_str();
    app.add_option("--visibility-samples", settings.samples, "Samples of each pixel")
        ->check(CLI::Range(1, scene::kMaxVisibilitySamples))
        ->capture_default_str();
    app.add_option("--shading-cache", options.cache,
                   "memoised: global, tile or sorted (no sharing between tiles), lru or fifo (some entries)")
        ->check(CLI::IsMember({"global", "tile", "sorted", "lru", "fifo"}))
        ->each(of_memoised("--shading-cache"))
        ->capture_default_str();
    app.add_option("--shading-tile", settings.cache.tile_px, "memoised: side of a tile in px")
        ->check(CLI::Range(8, 32))
        ->each(of_memoised("--shading-tile"))
        ->capture_default_str();
    app.add_option("--cache-entries", settings.cache.entries, "memoised: entries of lru and fifo")
        ->check(CLI::Range(1, 1 << 20))
        ->each(of_memoised("--cache-entries"))
        ->capture_default_str();
    app.add_option("--shading-rate", settings.grid.rate,
                   "memoised: cells of the shading grid for each px, along x and y")
        ->check(CLI::Range(0.125, 4.0))
        ->each(of_memoised("--shading-rate"))
        ->capture_default_str();
    app.add_option("--shading-grid", options.grid,
                   "memoised: where the grid begins: at a corner of each triangle's bounds, or the picture's")
        ->check(CLI::IsMember({"triangle", "picture"}))
        ->each(of_memoised("--shading-grid"))
        ->capture_default_str();
    app.add_option(
           "--transparency", options.transparency,
           "Materials with an opacity below 1: stochastic (a sample shows a random one of its surfaces), "
           "lists (memoised: blend all, by a list for each pixel), or sorted (supersampled, accumulation: "
           "blend all)")
        ->check(CLI::IsMember({"stochastic", "lists", "sorted"}))
        ->capture_default_str();
    app.add_option("--list-nodes", settings.transparency.list_nodes,
                   "--transparency lists: surfaces for each px that a row has room for; further ones "
                   "are counted, and stop samples at random")
        ->check(CLI::Range(0, scene::kMaxListNodes))
        ->each([&options](const std::string&) { options.has_list_nodes = true; })
        ->capture_default_str();
    app.add_option("--visibility-on", options.device,
                   "Trace and light the samples on the cpu, or with gl: in single precision by compute "
                   "shaders, which fill the caches, too")
        ->check(CLI::IsMember({"cpu", "gl"}))
        ->capture_default_str();
    add_gl_options(app, options.gl);
    app.add_flag("--anisotropic-shading", settings.grid.anisotropic,
                 "memoised: coarser shading where lens and shutter blur it");
    app.add_flag("--keep-shading", settings.keep_shading,
                 "memoised: keep shading samples from frame to frame until their surface or light changes");
    app.option_defaults()->group(group);
}

namespace {

void check_transparency(const VisibilityArguments& options, std::optional<scene::Visibility> visibility,
                        scene::Transparency transparency, Diagnostics& diagnostics) {
    const bool memoised = visibility == scene::Visibility::memoised;
    const Place place{"--transparency " + options.transparency, 0, 0};
    if (transparency == scene::Transparency::lists && !memoised)
        diagnostics.error(place, "is for --visibility memoised");
    if (transparency != scene::Transparency::stochastic && options.device == "gl")
        diagnostics.error(place, "is for --visibility-on cpu; gl takes stochastic");
    if (transparency == scene::Transparency::sorted && (memoised || !visibility))
        diagnostics.error(place, "is for --visibility supersampled or accumulation");
    if (options.has_list_nodes && transparency != scene::Transparency::lists)
        diagnostics.error({"--list-nodes", 0, 0}, "is for --transparency lists");
}

}  // namespace

std::optional<scene::VisibilitySettings> read_visibility(const VisibilityArguments& options,
                                                         Diagnostics& diagnostics) {
    std::vector<std::string> unused = options.given;
    if (options.settings.grid.anisotropic) unused.push_back("--anisotropic-shading");
    if (options.settings.keep_shading) unused.push_back("--keep-shading");
    const auto visibility = scene::parse_visibility(options.visibility);
    if (visibility != scene::Visibility::memoised)
        for (const std::string& name : unused)
            diagnostics.error({name, 0, 0}, "is for --visibility memoised");
    const auto transparency = *scene::parse_transparency(options.transparency);
    check_transparency(options, visibility, transparency, diagnostics);
    if (!visibility && options.device == "gl")
        diagnostics.error({"--visibility-on gl", 0, 0},
                          "is for --visibility memoised, supersampled or accumulation");
    if (visibility == scene::Visibility::memoised && options.device == "gl" && options.cache == "lru")
        diagnostics.error({"--shading-cache lru", 0, 0},
                          "is for --visibility-on cpu; gl has fifo, in buckets of four entries");
    if (visibility == scene::Visibility::memoised && options.settings.keep_shading) {
        const Place place{"--keep-shading", 0, 0};
        if (options.device == "gl") diagnostics.error(place, "is for --visibility-on cpu");
        if (options.cache != "global") diagnostics.error(place, "is for --shading-cache global");
    }
    if (!visibility) return std::nullopt;
    scene::VisibilitySettings settings = options.settings;
    settings.visibility = *visibility;
    settings.transparency.transparency = transparency;
    settings.grid.origin =
        options.grid == "picture" ? scene::GridOrigin::picture : scene::GridOrigin::triangle;
    settings.cache.cache = *scene::parse_shading_cache(options.cache);
    return settings;
}

nlohmann::ordered_json visibility_json(const std::vector<scene::VisibilityReport>& reports) {
    auto frames = nlohmann::ordered_json::array();
    for (const scene::VisibilityReport& report : reports)
        frames.push_back({{"frame", report.frame},
                          {"samples", report.samples},
                          {"hits", report.requests - report.shadings},
                          {"misses", report.shadings},
                          {"kept", {{"samples", report.kept}, {"highlights", report.highlights}}},
                          {"shading_rate",
                           {{"mean", report.rate.of_pixels},
                            {"p95", report.rate.p95},
                            {"of_covered_pixels", report.rate.of_covered_pixels},
                            {"multisampled", report.rate.multisampled}}},
                          {"lists", {{"nodes", report.list_nodes}, {"overflows", report.list_overflows}}},
                          {"bytes",
                           {{"visibility", report.bytes.visibility},
                            {"shading", report.bytes.shading},
                            {"cache", report.bytes.cache},
                            {"lists", report.bytes.lists},
                            {"kept", report.bytes.kept},
                            {"supersampled", report.bytes.supersampled}}}});
    return frames;
}

void print_visibility(const std::vector<scene::VisibilityReport>& reports) {
    for (const scene::VisibilityReport& report : reports) {
        std::cerr << fmt::format(
            "frame {}: {:.2f} shadings a px of {} samples, {:.2f} where something is seen, 95 % of the px at "
            "most {:.2f}; cache hits {}, misses {}\n",
            report.frame, report.rate.of_pixels, report.samples, report.rate.of_covered_pixels,
            report.rate.p95, report.requests - report.shadings, report.shadings);
        if (report.kept > 0)
            std::cerr << fmt::format(
                "frame {}: {} shading samples of earlier frames, {} with a new highlight\n", report.frame,
                report.kept, report.highlights);
        if (report.list_nodes + report.list_overflows > 0)
            std::cerr << fmt::format("frame {}: lists hold {} transparent surfaces, {} found no room{}\n",
                                     report.frame, report.list_nodes, report.list_overflows,
                                     report.list_overflows > 0 ? "; give them more --list-nodes" : "");
    }
}

}  // namespace aftershade::cli
