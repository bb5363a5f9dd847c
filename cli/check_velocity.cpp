#include "cli/check_velocity.h"

#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "framework/base/cores.h"
#include "framework/capture/capture.h"
#include "framework/inspect/velocity_frames.h"
#include "framework/inspect/velocity_report.h"

namespace aftershade::cli {

namespace {

nlohmann::ordered_json json_of(const VelocitySettings& settings) {
    return {{"delta", settings.delta}, {"y_axis", settings.y_axis},
            {"unit", settings.unit},   {"scale", settings.scale},
            {"bias", settings.bias},   {"exchange_channels", settings.exchange_channels}};
}

nlohmann::ordered_json json_of(const std::string& role, const VelocityCheck& check) {
    nlohmann::ordered_json row{
        {"role", role}, {"verdict", velocity_verdict_name(check.verdict)}, {"sentence", check.sentence}};
    row["settings"] = json_of(check.settings);
    row["suggested"] = json_of(check.suggested);
    row["score"] = check.identity.score;
    row["at_limit"] = check.at_limit;
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
    set_exr_threads(allotted_cores());

    std::vector<Capture> captures;
    std::map<std::string, RoleDecoding> decodings;
    const CaptureReader first(sequences[0], profiles, options.limits);
    for (const Sequence& sequence : sequences) {
        CaptureReader reader(sequence, profiles, options.limits);
        if (&sequence != &sequences[0]) reader.hold_to_first_of(first);
        captures.push_back(reader.read(sequence.frames.front(), velocity_check_roles()));
        decodings = reader.decodings(sequence.frames.front());
        print_differences(captures.back().header);
    }
    nlohmann::ordered_json document{{"aftershade", 1},
                                    {"files", files},
                                    {"profile", captures[1].header.profile},
                                    {"checks", nlohmann::ordered_json::array()}};
    bool all_confirmed = true;
    for (const auto& [role, check] :
         check_velocity_of_frames(std::move(captures[0]), std::move(captures[1]), decodings)) {
        all_confirmed = all_confirmed && check.confirmed();
        document["checks"].push_back(json_of(role, check));
        if (!json) fmt::print("{}\n", format_velocity_check(check));
    }
    if (document["checks"].empty())
        throw Error(ErrorKind::capture, files[1] + ": the profile '" +
                                            document["profile"].get<std::string>() +
                                            "' finds no motion vectors");
    if (json) fmt::print("{}\n", document.dump(2));
    return all_confirmed ? ExitCode::done : ExitCode::partial;
}

}  // namespace aftershade::cli
