#include "cli/check_velocity.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <thread>
#include <utility>

#include "framework/capture/capture.h"
#include "framework/image/role.h"
#include "framework/image/window.h"
#include "framework/inspect/velocity_check.h"
#include "framework/inspect/velocity_report.h"

namespace aftershade::cli {

namespace {

VelocitySettings settings_of(const RoleDecoding& decoding) {
    constexpr std::array kDeltas = {"cur-prev", "prev-cur", "next-cur", "cur-next"};
    constexpr std::array kUnits = {"px", "uv", "ndc"};
    VelocitySettings settings;
    settings.delta = kDeltas[std::size_t(decoding.delta)];
    settings.y_axis = decoding.y_axis_up ? "up" : "down";
    settings.unit = kUnits[std::size_t(decoding.unit)];
    settings.scale = {decoding.velocity_scale[0], decoding.velocity_scale[1]};
    return settings;
}

/// Frames of a moving camera may have data windows of their own; both are brought onto the display window.
const Image* on_display(Capture& capture, const std::string& role) {
    const auto image = capture.images.find(role);
    if (image == capture.images.end()) return nullptr;
    image->second = place_in_window(std::move(image->second), capture.header.data_window,
                                    capture.header.display_window, 0);
    return &image->second;
}

nlohmann::ordered_json json_of(const VelocitySettings& settings) {
    return {{"delta", settings.delta},
            {"y_axis", settings.y_axis},
            {"unit", settings.unit},
            {"scale", settings.scale},
            {"exchange_channels", settings.exchange_channels}};
}

nlohmann::ordered_json json_of(const std::string& role, const VelocityCheck& check) {
    nlohmann::ordered_json row{
        {"role", role}, {"verdict", velocity_verdict_name(check.verdict)}, {"sentence", check.sentence}};
    row["settings"] = json_of(check.settings);
    row["suggested"] = json_of(check.suggested);
    row["score"] = check.identity.score;
    row["hypotheses"] = nlohmann::ordered_json::array();
    for (const VelocityScore& score : check.hypotheses)
        row["hypotheses"].push_back({{"other_time", score.hypothesis.other_time},
                                     {"swapped", score.hypothesis.swapped},
                                     {"scale_x", score.hypothesis.scale_x},
                                     {"scale_y", score.hypothesis.scale_y},
                                     {"tested", score.tested},
                                     {"score", score.score}});
    if (check.fit) {
        const auto number = [](const std::optional<double>& value) {
            return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
        };
        row["free_scale"] = {{"other_time", check.fit->other_time},
                             {"swapped", check.fit->swapped},
                             {"x", number(check.fit->scale_x)},
                             {"y", number(check.fit->scale_y)},
                             {"score", check.fit->score}};
    }
    return row;
}

}  // namespace

ExitCode check_velocity_of_files(const std::vector<std::string>& files, const CaptureOptions& options,
                                 bool json) {
    Diagnostics diagnostics;
    const std::vector<Profile> profiles = load_profiles(options.profile_paths, diagnostics);
    std::vector<Sequence> sequences;
    for (const std::string& file : files) {
        CaptureOptions one = options;
        one.capture = file;
        one.frames = "";
        if (auto sequence = find_sequence(one, profiles, diagnostics))
            sequences.push_back(std::move(*sequence));
    }
    stop_at_errors(diagnostics);
    set_exr_threads(int(std::thread::hardware_concurrency()));

    std::vector<std::string> motions;
    for (const ChannelRole& role : channel_roles())
        if (role.kind == RoleKind::motion) motions.push_back(role.name);
    std::vector<std::string> roles = motions;
    roles.push_back(kColorRole);
    std::vector<Capture> captures;
    std::map<std::string, RoleDecoding> decodings;
    for (const Sequence& sequence : sequences) {
        const CaptureReader reader(sequence, profiles, options.limits);
        captures.push_back(reader.read(sequence.frames.front(), roles));
        decodings = reader.decodings(sequence.frames.front());
    }
    const Image* color_a = on_display(captures[0], kColorRole);
    const Image* color_b = on_display(captures[1], kColorRole);
    if (!color_a || !color_b)
        throw Error(ExitCode::capture, files[color_a ? 1 : 0] + ": has no color to compare");

    nlohmann::ordered_json document{{"aftershade", 1},
                                    {"files", files},
                                    {"profile", captures[1].header.profile},
                                    {"checks", nlohmann::ordered_json::array()}};
    bool all_confirmed = true;
    for (const std::string& role : motions) {
        const Image* vectors_a = on_display(captures[0], role);
        const Image* vectors_b = on_display(captures[1], role);
        if (!vectors_a && !vectors_b) continue;
        const VelocityCheck check =
            check_velocity({color_a, color_b, vectors_a, vectors_b, settings_of(decodings.at(role))});
        all_confirmed = all_confirmed && check.confirmed();
        document["checks"].push_back(json_of(role, check));
        if (!json) fmt::print("{}\n", format_velocity_check(check));
    }
    if (document["checks"].empty())
        throw Error(ExitCode::capture,
                    files[1] + ": the profile '" + captures[1].header.profile + "' finds no motion vectors");
    if (json) fmt::print("{}\n", document.dump(2));
    return all_confirmed ? ExitCode::done : ExitCode::partial;
}

}  // namespace aftershade::cli
