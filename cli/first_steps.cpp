#include "cli/first_steps.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/capture_options.h"
#include "cli/effect_options.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/capture.h"
#include "framework/document/document.h"
#include "framework/look/starting_looks.h"

namespace aftershade::cli {

namespace {

struct Opened {
    Sequence sequence;
    CaptureHeader header;
};

/// nullopt where the word does not name a capture.
std::optional<Opened> opened(const std::string& word) {
    Diagnostics faults;
    CaptureOptions options;
    options.capture = word;
    const std::vector<Profile> profiles = load_profiles({}, faults);
    try {
        auto sequence = find_sequence(options, profiles, faults);
        if (!sequence || faults.has_errors()) return std::nullopt;
        const CaptureReader reader(*sequence, profiles, options.limits);
        CaptureHeader header = reader.read_header(sequence->file_number(sequence->frames.front()));
        return Opened{std::move(*sequence), std::move(header)};
    } catch (const Error&) {
        return std::nullopt;
    }
}

std::string text_of(const std::string& word, const Opened& capture) {
    Diagnostics faults;
    EffectRegistry effects = find_effects({}, faults);
    const auto looks = find_starting_looks(starting_looks_folder(data_path()), effects, capture.header);
    const Window& window = capture.header.display_window;
    std::string text =
        fmt::format("{}: {}, {} x {} px\nroles: {}\n", word, counted(capture.sequence.frames.size(), "frame"),
                    window.width(), window.height(), joined(capture.header.roles, ", ", ", "));
    const std::map<std::string, std::string>& known = capture.header.remedies;
    std::map<std::string, std::string> remedies;  // by role that a look lacks
    std::string first;
    for (const StartingLook& look : looks) {
        if (!look.missing.empty()) {
            std::vector<std::string> roles;
            for (const MissingRole& missing : look.missing) {
                roles.push_back(missing.role);
                if (const auto found = known.find(missing.role); found != known.end())
                    remedies.insert(*found);
            }
            text += fmt::format("  {:<10} needs {} {}\n", look.name(),
                                roles.size() == 1 ? "the role" : "the roles", joined(roles, " and "));
            continue;
        }
        if (first.empty()) text += "looks to start from:\n";
        if (first.empty() || look.name() == "portrait") first = look.file.string();
        text += fmt::format("  {:<10} {}\n", look.name(), look.summary);
    }
    for (const auto& [role, remedy] : remedies) text += fmt::format("for {}: {}\n", role, remedy);
    const char* output = capture.sequence.frames.size() == 1 ? "out.png" : "out_####.png";
    if (!first.empty())
        text += "draw one: " + printed_command({"aftershade", "run", first, word, "-o", output}) + "\n";
    return text + "make your own: " + printed_command({"aftershade", "serve", word}) + "\n";
}

}  // namespace

bool names_look(const std::string& word) {
    Diagnostics faults;
    if (!word.ends_with(".json")) return false;
    const auto document = read_document(word, faults);
    return document && document->find("steps");
}

bool print_first_steps(const CLI::App& run) {
    if (run.count("capture") > 0 || run.count("look") != 1) return false;
    const auto word = run.get_option("look")->as<std::string>();
    if (names_look(word)) return false;
    const auto capture = opened(word);
    if (!capture) return false;
    std::cerr << "LOOK is missing: run takes a look and a capture\n"
              << printable_lines(text_of(word, *capture));
    return true;
}

}  // namespace aftershade::cli
