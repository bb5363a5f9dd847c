#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <array>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/compare_options.h"
#include "cli/golden_options.h"
#include "cli/interrupt.h"
#include "framework/base/atomic_file.h"
#include "framework/base/text.h"
#include "framework/golden/golden_approve.h"

namespace aftershade::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct InitOptions {
    GoldenOptions golden;
    std::string look, capture, folder = "golden", name, frames;
    std::vector<std::string> outputs;
};

/// From the strictest on. The last stands for a renderer that rounds otherwise along edges.
const std::array<Json, 5>& candidates() {
    static const std::array<Json, 5> all{
        Json{{"fail_ulp", 2}}, Json{{"fail_ulp", 8}}, Json{{"fail", 0.001}, {"fail_relative", 0.004}},
        Json{{"fail", 0.004}, {"fail_relative", 0.01}, {"fail_percent", 0.1}, {"hard_fail", 0.25}},
        Json{{"fail", 0.01}, {"fail_relative", 0.02}, {"fail_percent", 1}}};
    return all;
}

/// As names of cases may be: letters, digits, '_' and '-'.
std::string case_name(const std::string& look) {
    std::string name = fs::path(look).stem().string();
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    return name;
}

fs::path from_folder(const std::string& path, const fs::path& folder) {
    return fs::proximate(fs::absolute(path).lexically_normal(), fs::absolute(folder).lexically_normal());
}

void write_suite(const InitOptions& options, const Json& tolerance) {
    Json test = {{"name", options.name.empty() ? case_name(options.look) : options.name},
                 {"look", from_folder(options.look, options.folder).generic_string()},
                 {"capture", from_folder(options.capture, options.folder).generic_string()}};
    if (!options.frames.empty()) test["frames"] = options.frames;
    if (!options.outputs.empty()) test["outputs"] = options.outputs;
    test["tolerance"] = tolerance;
    const Json suite = {{"aftershade", 1}, {"cases", Json::array({test})}};
    write_text_file(fs::path(options.folder) / "golden.json", suite.dump(2) + "\n");
}

/// What an image that another run drew is like.
struct Trial {
    std::string backend, renderer;
    bool bits_equal = true;
    Verdict verdict = Verdict::same;
};

/// Draws the case again. nullopt where this machine lacks the backend.
std::optional<Trial> drawn_again(const InitOptions& options, const std::string& backend) {
    GoldenOptions golden = options.golden;
    golden.gl.backend = backend;
    std::optional<GoldenSetup> setup;
    try {
        setup = prepare_golden(golden);
    } catch (const Error& error) {
        if (error.kind() == ErrorKind::gl) return std::nullopt;
        throw;
    }
    const GoldenSuiteResult result =
        run_golden_suite(setup->suite, setup->context.options, {}, watch_for_interrupt());
    if (result.interrupted)
        throw CodedError(ExitCode::interrupted,
                         "interrupted; " + options.folder + " has no measured tolerance yet");
    Trial trial{setup->context.options.render.backend, setup->context.options.environment.renderer, true,
                Verdict::same};
    for (const GoldenCaseResult& test : result.cases) {
        if (test.images.empty()) throw Error(ErrorKind::effect, joined(test.messages, "\n", "\n"));
        for (const GoldenImage& image : test.images) {
            trial.bits_equal &= image.bits_equal;
            if (image.comparison) trial.verdict = std::max(trial.verdict, image.comparison->verdict);
        }
    }
    return trial;
}

/// Runs that the tolerance must let pass: the same backend once more, and each other one of this machine.
std::vector<Trial> trials_of(const InitOptions& options, const std::string& own) {
    std::vector<Trial> trials;
    for (const std::string& backend :
         {own, std::string("egl"), std::string("egl-software"), std::string("osmesa")}) {
        if (!trials.empty() && backend == own) continue;
        if (const auto trial = drawn_again(options, backend)) trials.push_back(*trial);
    }
    return trials;
}

GoldenApproval approve_first(const InitOptions& options, const GoldenSetup& setup) {
    const std::string command = printed_command(
        {"aftershade", "golden", "init", options.look, options.capture, "-o", options.folder});
    return approve_goldens(setup.suite, approve_options_of(setup, options.golden, command), {},
                           watch_for_interrupt());
}

std::string words_of(const Json& tolerance) {
    std::string text;
    for (const auto& [key, value] : tolerance.items())
        text += (text.empty() ? "" : ", ") + key + " " + value.dump();
    return text;
}

void print_choice(const Json& tolerance, const std::vector<Trial>& trials) {
    bool all_equal = true;
    std::string runs;
    for (const Trial& trial : trials) {
        all_equal &= trial.bits_equal;
        runs += fmt::format("    {} ({}): {}\n", trial.backend, trial.renderer,
                            trial.bits_equal ? "the same bits" : "other bits");
    }
    fmt::print("tolerance: {}\n  measured by drawing again on\n{}", words_of(tolerance), runs);
    if (all_equal)
        fmt::print(
            "  All runs gave the same bits; the tolerance leaves room for another driver's rounding.\n");
    if (!trials.front().bits_equal)
        fmt::print(
            "  Two runs on {} differ, so the look is not deterministic; a tolerance can only hide that.\n",
            trials.front().backend);
}

/// The first that lets every trial pass; nullopt where none does.
std::optional<Json> measured_tolerance(const InitOptions& options, const std::string& own,
                                       std::vector<Trial>& trials) {
    for (const Json& tolerance : candidates()) {
        write_suite(options, tolerance);
        trials = trials_of(options, own);
        if (std::ranges::all_of(trials, [](const Trial& trial) { return trial.verdict == Verdict::same; }))
            return tolerance;
    }
    return std::nullopt;
}

/// Takes the suite, and the folder that was made for it, away again where no golden came of it.
class Unfinished {
public:
    explicit Unfinished(fs::path file)
        : file_(std::move(file)), made_folder_(fs::create_directories(file_.parent_path())) {}
    ~Unfinished() {
        std::error_code in_use;
        if (done_) return;
        fs::remove(file_, in_use);
        if (made_folder_) fs::remove(file_.parent_path(), in_use);
    }
    void finish() { done_ = true; }

private:
    fs::path file_;
    bool made_folder_ = false, done_ = false;
};

ExitCode init(InitOptions options) {
    const fs::path file = fs::path(options.folder) / "golden.json";
    if (fs::exists(file))
        throw CodedError(
            kCompareUsage,
            file.string() + ": is there already; add a case to it, or choose another folder with -o");
    options.golden.suite = options.folder;
    Unfinished unfinished(file);
    write_suite(options, candidates().front());
    const GoldenSetup setup = prepare_golden(options.golden);
    const GoldenApproval approval = approve_first(options, setup);
    if (approval.interrupted) return ExitCode::interrupted;
    if (approval.verdict > Verdict::warning) {
        for (const std::string& message : approval.cases.front().messages)
            std::cerr << printable_lines(message) << "\n";
        return ExitCode(int(approval.verdict));
    }
    unfinished.finish();
    fmt::print("{}\n", file.string());
    for (const fs::path& path : approval.written) fmt::print("{}\n", path.string());
    std::vector<Trial> trials;
    const auto tolerance = measured_tolerance(options, setup.context.options.render.backend, trials);
    print_choice(tolerance.value_or(candidates().back()), trials);
    if (!tolerance) {
        fmt::print(
            "  The runs differ by more than that: approve an image for each renderer (golden approve "
            "--add).\n");
        return ExitCode(int(Verdict::warning));
    }
    fmt::print("run it: {}\n", printed_command({"aftershade", "golden", "run", options.folder}));
    return ExitCode::done;
}

}  // namespace

std::function<ExitCode()> add_golden_init(CLI::App& golden) {
    auto options = std::make_shared<InitOptions>();
    auto* const verb = golden.add_subcommand(
        "init", "Write a suite of one case, approve its images and measure its tolerance by drawing again");
    verb->add_option("look", options->look, "The look's file")->required();
    verb->add_option("capture", options->capture, "The capture, as for run")->required();
    verb->add_option("-o,--output", options->folder, "Folder of the new suite")->capture_default_str();
    verb->add_option("--name", options->name, "Name of the case (default: the look's)");
    verb->add_option("--frames", options->frames, "Frames, such as 1-24 (default: the capture's)");
    verb->add_option("--outputs", options->outputs, "Roles to compare (default: color)")->delimiter(',');
    add_golden_drawing_options(*verb, options->golden);
    return [options] { return init(*options); };
}

}  // namespace aftershade::cli
