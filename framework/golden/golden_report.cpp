#include "framework/golden/golden_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>
#include <utility>

#include "framework/base/lfs_pointer.h"
#include "framework/base/text.h"
#include "framework/compare/comparison_report.h"

namespace aftershade {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kNameWidth = 44;

struct Counts {
    int passed = 0, warned = 0, failed = 0, skipped = 0;
};

Counts count(const GoldenSuiteResult& result) {
    Counts counts;
    for (const GoldenCaseResult& test : result.cases) {
        if (test.verdict >= Verdict::failure) ++counts.failed;
        else if (!test.skipped.empty()) ++counts.skipped;
        else if (test.verdict == Verdict::warning) ++counts.warned;
        else ++counts.passed;
    }
    return counts;
}

std::string word_of(const GoldenCaseResult& test, const char* good) {
    if (test.verdict >= Verdict::failure) return "***Failed ";
    if (!test.skipped.empty()) return "***Skipped";
    return test.verdict == Verdict::warning ? "***Warning" : "   " + std::string(good) + " ";
}

/// Why a case has its verdict, each reason once.
std::vector<std::string> reasons_of(const GoldenCaseResult& test) {
    std::vector<std::string> lines;
    if (test.verdict >= Verdict::failure || test.verdict == Verdict::warning) lines = test.messages;
    std::vector<std::pair<std::string, std::string>> images;  // names by reason, in order
    for (const GoldenImage& image : test.images) {
        if (image.verdict == Verdict::same) continue;
        for (const std::string& reason : image.reasons) {
            const auto known = std::ranges::find(images, reason, &std::pair<std::string, std::string>::first);
            if (known == images.end()) images.emplace_back(reason, image.name);
            else if (known->second != image.name) known->second += ", " + image.name;
        }
    }
    for (const auto& [reason, names] : images) lines.push_back(names + ": " + reason);
    return lines;
}

/// Whether new images could make the case pass. An approved image that was not fetched is not replaced.
bool can_approve(const GoldenCaseResult& test) {
    return std::ranges::any_of(test.images, [](const GoldenImage& image) {
        return image.verdict != Verdict::same &&
               !(image.approved && !lfs_fault(image.approved->file).empty());
    });
}

bool only_machine_changed(const GoldenCaseResult& test) {
    return std::ranges::all_of(test.images, [](const GoldenImage& image) {
        return image.verdict == Verdict::same || image.only_machine_changed;
    });
}

/// What to do about a case that new images could make pass.
std::string remedy_of(const GoldenCaseResult& test, const GoldenReportContext& context) {
    const std::string approve = approve_command(context, {&test});
    if (!only_machine_changed(test)) return "to approve: " + approve;
    return "to keep this machine's image too: " + approve + " (or widen the case's tolerance)";
}

/// "3 images differ in bits within their tolerance: only the machine differs: Mesa 25.0.7 instead of 22.3.6".
std::string note_of_tolerated(const GoldenSuiteResult& result) {
    std::map<std::string, std::size_t> counts;  // by what changed
    for (const GoldenCaseResult& test : result.cases)
        for (const GoldenImage& image : test.images)
            if (image.verdict == Verdict::same && image.approved && !image.bits_equal)
                ++counts[image.changes.empty() ? "their sidecars do not say why"
                                               : joined(image.changes, "; ", "; ")];
    std::string text;
    for (const auto& [changes, images] : counts)
        text +=
            fmt::format("{} within tolerance, but with other bits: {}\n", counted(images, "image"), changes);
    return text;
}

/// The failed cases where only the machine has changed (`of_machine`), or the others.
std::vector<const GoldenCaseResult*> cases_to_approve(const GoldenSuiteResult& result, bool of_machine) {
    std::vector<const GoldenCaseResult*> cases;
    for (const GoldenCaseResult& test : result.cases)
        if (can_approve(test) && only_machine_changed(test) == of_machine) cases.push_back(&test);
    return cases;
}

/// What an annotation shows of a case: all the errors of one that did not render, such as a shader's.
std::string snippet_of(const GoldenCaseResult& test, const std::vector<std::string>& lines) {
    constexpr std::size_t kMostLines = 8;
    if (lines.empty() || !test.images.empty()) return lines.empty() ? "" : lines.front();
    auto first =
        std::ranges::find_if(lines, [](const auto& line) { return line.find("error") != line.npos; });
    if (first == lines.end()) first = lines.begin();
    const std::span<const std::string> rest(first, lines.end());
    return joined(rest.first(std::min(rest.size(), kMostLines)), "\n", "\n");
}

std::string fault_of_orphan(const fs::path& orphan) {
    if (orphan.extension() == ".json")
        return "no case gives this golden: a sidecar without an image; remove it";
    return "no case gives this golden; remove it, or fix the case";
}

std::string junit_case(const GoldenCaseResult& test, const GoldenReportContext& context) {
    std::string text = fmt::format("    <testcase classname=\"golden\" name=\"{}\" time=\"{:.3f}\">",
                                   xml_text(test.test->name), test.seconds);
    std::vector<std::string> lines = reasons_of(test);
    if (can_approve(test)) lines.push_back(remedy_of(test, context));
    if (const std::string note = allowances_of(test); !note.empty()) lines.push_back(note);
    const std::string why = snippet_of(test, lines), all = joined(lines, "\n", "\n");
    // What no picture decides (no GL, a file that cannot be read) is an error of JUnit.
    const char* const element = test.verdict == Verdict::file_error ? "error" : "failure";
    if (test.verdict >= Verdict::failure)
        text += fmt::format("<{0} type=\"{1}\" message=\"{2}\">{3}</{0}>", element,
                            verdict_name(test.verdict), xml_text(why), xml_text(all));
    else if (!test.skipped.empty()) text += fmt::format("<skipped message=\"{}\"/>", xml_text(test.skipped));
    else if (test.verdict == Verdict::warning)
        text += fmt::format("<system-out>warning: {}</system-out>", xml_text(all));
    else if (!all.empty()) text += fmt::format("<system-out>{}</system-out>", xml_text(all));
    return text + "</testcase>\n";
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json(nullptr) : Json(text);
}

Json json_of(const ApprovedImage& approved) {
    Json json{{"file", approved.file.string()}, {"key", approved.key}, {"sidecar", nullptr}};
    if (!approved.sidecar) return json;
    json["sidecar"] = json_of(approved.sidecar->environment);
    json["sidecar"]["command"] = approved.sidecar->command;
    json["sidecar"]["look_hash"] = approved.sidecar->sources.look;
    json["sidecar"]["capture_hash"] = text_or_null(approved.sidecar->sources.capture);
    json["sidecar"]["approver"] = text_or_null(approved.sidecar->approver);
    json["sidecar"]["approved"] = text_or_null(approved.sidecar->approved);
    return json;
}

/// A mark, a number of pixels, a mark, ...
Json json_of(const AreaMap& map) {
    Json runs = Json::array();
    for (const AreaMap::Run& run : map.runs) {
        runs.push_back(run.mark);
        runs.push_back(run.pixels);
    }
    return {{"x", map.window.min_x},
            {"y", map.window.min_y},
            {"width", map.window.width()},
            {"height", map.window.height()},
            {"runs", std::move(runs)}};
}

Json json_of(const GoldenImage& image) {
    Json areas = Json::object();
    for (const auto& [layer, map] : image.areas) areas[layer] = json_of(map);
    const GoldenPictures& pictures = image.pictures;
    const Json hashes = {{"reference", text_or_null(pictures.reference_hash)},
                         {"test", text_or_null(pictures.test_hash)}};
    return {{"name", image.name},
            {"output", image.output},
            {"frame", image.frame},
            {"verdict", verdict_name(image.verdict)},
            {"reasons", image.reasons},
            {"approved", image.approved ? json_of(*image.approved) : Json(nullptr)},
            {"approved_count", image.approved_count},
            {"tier", image.exact_tier ? "bits" : "tolerance"},
            {"bits_equal", image.bits_equal},
            {"changes", image.changes},
            {"only_machine_changed", image.only_machine_changed},
            {"pictures",
             {{"reference", text_or_null(pictures.reference)},
              {"test", text_or_null(pictures.test)},
              {"difference", text_or_null(pictures.difference)},
              {"difference_scale", pictures.difference_scale},
              {"heat_map", text_or_null(pictures.heat_map)},
              {"side_by_side", text_or_null(pictures.side_by_side)},
              {"reference_exr", text_or_null(pictures.reference_exr)},
              {"test_exr", text_or_null(pictures.test_exr)}}},
            {"hashes", hashes},
            {"areas", std::move(areas)},
            {"comparison", image.comparison ? json_of(*image.comparison, image.rules) : Json(nullptr)}};
}

std::string golden_command(const std::string& verb, const GoldenReportContext& context,
                           const std::vector<std::string>& cases) {
    std::vector<std::string> words = {"aftershade", "golden", verb, context.suite->argument};
    for (const std::string& name : cases) words.insert(words.end(), {"--filter", name});
    return printed_command(words) + context.with_options;
}

Json json_of(const GoldenCaseResult& result, const GoldenReportContext& context) {
    const GoldenCase& test = *result.test;
    Json images = Json::array();
    for (const GoldenImage& image : result.images) images.push_back(json_of(image));
    return {{"name", test.name},
            {"file", test.file.string()},
            {"look", test.look.empty() ? Json(nullptr) : Json(test.look.string())},
            {"steps", test.steps.empty() ? Json(nullptr) : Json::parse(test.steps)["steps"]},
            {"capture", test.capture.string()},
            {"frames", text_or_null(test.frames)},
            {"set", test.sets},
            {"tags", test.tags},
            {"verdict", verdict_name(result.verdict)},
            {"skipped", text_or_null(result.skipped)},
            {"allowances", text_or_null(allowances_of(result))},
            {"seconds", result.seconds},
            {"messages", result.messages},
            {"look_hash", text_or_null(result.sources.look)},
            {"capture_hash", text_or_null(result.sources.capture)},
            {"command", text_or_null(result.command)},
            {"rerun", golden_command("run", context, {test.name})},
            {"approve", can_approve(result) ? Json(approve_command(context, {&result})) : Json(nullptr)},
            {"images", std::move(images)}};
}

}  // namespace

std::string approve_command(const GoldenReportContext& context,
                            const std::vector<const GoldenCaseResult*>& cases) {
    if (cases.empty()) return "";
    std::vector<std::string> names;
    bool keeps_others = false;
    for (const GoldenCaseResult* test : cases) {
        names.push_back(test->test->name);
        for (const GoldenImage& image : test->images)
            keeps_others |= image.verdict != Verdict::same && image.only_machine_changed;
    }
    // Another machine's image is not replaced where nothing but the machine has changed.
    return golden_command("approve", context, names) + (keeps_others ? " --add" : "");
}

std::string allowances_of(const GoldenCaseResult& test) {
    std::string text;
    double most_percent = -1;
    std::vector<std::string> not_judged;  // in any image
    for (const GoldenImage& image : test.images) {
        if (!image.comparison) continue;
        Comparison comparison = *image.comparison;
        for (LayerComparison& layer : comparison.layers)
            for (std::string& name : std::exchange(layer.not_judged, {}))
                if (std::ranges::find(not_judged, name) == not_judged.end())
                    not_judged.push_back(std::move(name));
        double percent = 0;
        for (const LayerComparison& layer : comparison.layers)
            percent = std::max(percent, layer.left_out_percent());
        if (percent <= most_percent) continue;
        most_percent = percent;
        text = allowances_of(comparison, image.rules);
    }
    if (not_judged.empty()) return text;
    return text + (text.empty() ? "" : "; ") + "not judged: " + joined(not_judged, ", ", ", ");
}

std::string line_of(const GoldenCaseResult& test, int done, int all, const char* good) {
    std::string name = test.test->name + " ";
    name.resize(std::max(name.size(), kNameWidth), '.');
    const int digits = int(std::to_string(all).size());
    const std::string note = test.skipped.empty() ? allowances_of(test) : test.skipped;
    return fmt::format("{:>{}}/{} {} {} {:7.2f} s{}", done, digits, all, name, word_of(test, good),
                       test.seconds, note.empty() ? "" : "  (" + note + ")");
}

std::string summary_of(const GoldenSuiteResult& result, const GoldenReportContext& context) {
    std::string text;
    for (const bool failures : {false, true})
        for (const GoldenCaseResult& test : result.cases) {
            if (test.verdict == Verdict::same || (test.verdict >= Verdict::failure) != failures) continue;
            text += fmt::format("\n{} {}: {}\n", failures ? "FAILED" : "WARNING", test.test->name,
                                verdict_name(test.verdict));
            for (const std::string& line : reasons_of(test)) text += "    " + line + "\n";
            if (can_approve(test)) text += "    " + remedy_of(test, context) + "\n";
        }
    for (const fs::path& orphan : result.orphans)
        text += fmt::format("\nFAILED {}: {}\n", printable(orphan.string()), fault_of_orphan(orphan));
    if (const auto cases = cases_to_approve(result, false); cases.size() > 1)
        text += "\nto approve all: " + approve_command(context, cases) + "\n";
    if (const auto cases = cases_to_approve(result, true); cases.size() > 1)
        text += "\nto keep this machine's images of all: " + approve_command(context, cases) + "\n";
    if (const std::string note = note_of_tolerated(result); !note.empty()) text += "\n" + note;
    const Counts counts = count(result);
    return text +
           fmt::format("\n{} passed, {} with warnings, {} failed, {} skipped{}, {} in {:.2f} s: {}\n",
                       counts.passed, counts.warned, counts.failed, counts.skipped,
                       result.orphans.empty() ? "" : ", " + counted(result.orphans.size(), "orphaned golden"),
                       counted(result.cases.size(), "case"), result.seconds,
                       result.interrupted ? "interrupted" : verdict_name(result.verdict));
}

std::string junit_of(const GoldenSuiteResult& result, const GoldenReportContext& context) {
    const Counts counts = count(result);
    const std::size_t tests = result.cases.size() + result.orphans.size();
    const auto errors =
        std::size_t(std::ranges::count(result.cases, Verdict::file_error, &GoldenCaseResult::verdict));
    const std::size_t failures = std::size_t(counts.failed) + result.orphans.size() - errors;
    std::string text = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
    const std::string sums = fmt::format("tests=\"{}\" failures=\"{}\" errors=\"{}\" time=\"{:.3f}\"", tests,
                                         failures, errors, result.seconds);
    // Jenkins' schema of these files knows `skipped` of a testsuite alone.
    text += "<testsuites " + sums + ">\n";
    text +=
        fmt::format("  <testsuite name=\"{}\" {} skipped=\"{}\" timestamp=\"{}\">\n    <properties>\n",
                    xml_text(context.suite->argument), sums, counts.skipped, result.started.substr(0, 19));
    const auto property = [&](const char* name, const std::string& value) {
        text += fmt::format("      <property name=\"{}\" value=\"{}\"/>\n", name, xml_text(value));
    };
    const GoldenEnvironment& environment = context.options.environment;
    property("backend", environment.backend);
    property("renderer", environment.renderer);
    property("version", environment.version);
    property("cpu", environment.cpu);
    property("commit", context.commit);
    text += "    </properties>\n";
    for (const GoldenCaseResult& test : result.cases) text += junit_case(test, context);
    for (const fs::path& orphan : result.orphans)
        text += fmt::format(
            "    <testcase classname=\"golden.orphan\" name=\"{0}\"><failure type=\"failure\" "
            "message=\"{1}\">{0}</failure></testcase>\n",
            xml_text(orphan.string()), xml_text(fault_of_orphan(orphan)));
    return text + "  </testsuite>\n</testsuites>\n";
}

Json json_of(const GoldenSuiteResult& result, const GoldenReportContext& context) {
    const Counts counts = count(result);
    Json environment = json_of(context.options.environment);
    environment["key"] = context.options.environment.key();
    environment["threads"] = std::thread::hardware_concurrency();
    environment["jobs"] = context.options.jobs;
    environment["commit"] = text_or_null(context.commit);
    environment["aftershade"] = context.options.program;
    Json cases = Json::array(), orphans = Json::array();
    for (const GoldenCaseResult& test : result.cases) cases.push_back(json_of(test, context));
    for (const fs::path& orphan : result.orphans) orphans.push_back(orphan.string());
    return {{"aftershade", 1},
            {"suite", context.suite->argument},
            {"document", fs::absolute(context.suite->file).lexically_normal().string()},
            {"verdict", verdict_name(result.verdict)},
            {"exit_code", int(result.verdict)},
            {"interrupted", result.interrupted},
            {"started", result.started},
            {"seconds", result.seconds},
            {"counts",
             {{"cases", result.cases.size()},
              {"passed", counts.passed},
              {"warned", counts.warned},
              {"failed", counts.failed},
              {"skipped", counts.skipped},
              {"orphans", result.orphans.size()}}},
            {"filters", context.options.filters},
            {"approve", text_or_null(approve_command(context, cases_to_approve(result, false)))},
            {"approve_machine", text_or_null(approve_command(context, cases_to_approve(result, true)))},
            {"environment", std::move(environment)},
            {"cases", std::move(cases)},
            {"orphans", std::move(orphans)}};
}

std::string early_junit_of(const GoldenEarlyEnd& end) {
    const std::string sums = "tests=\"1\" failures=\"0\" errors=\"1\" time=\"0\"";
    return fmt::format(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites {0}>\n  <testsuite name=\"{1}\" {0} "
        "skipped=\"0\">\n"
        "    <testcase classname=\"golden\" name=\"run\" time=\"0\"><error type=\"exit code {2}\" "
        "message=\"{3}\">{3}"
        "</error></testcase>\n  </testsuite>\n</testsuites>\n",
        sums, xml_text(end.suite), end.exit_code, xml_text(end.message));
}

Json early_json_of(const GoldenEarlyEnd& end) {
    return {{"aftershade", 1},          {"suite", end.suite},
            {"verdict", "ended early"}, {"exit_code", end.exit_code},
            {"error", end.message},     {"cases", Json::array()},
            {"orphans", Json::array()}};
}

std::string early_page_of(const GoldenEarlyEnd& end) {
    return fmt::format(
        "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{0}: ended "
        "early</title></head>\n"
        "<body><h1>{0}: the run ended early</h1>\n<pre>{1}</pre>\n<p>Exit code {2}. No case was "
        "judged.</p></body></html>\n",
        xml_text(end.suite), xml_text(end.message), end.exit_code);
}

}  // namespace aftershade
