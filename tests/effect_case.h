// The cases of effects, effects/<id>/cases/<case>.json: a few steps over a capture, and the images that they
// shall give.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <half.h>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"
#include "framework/core/units.h"
#include "framework/image/frame_range.h"
#include "framework/image/image.h"

namespace aftershade::test {

/// Of one image against its golden. Differences are absolute, of any channel.
struct CaseTolerance {
    double fail = 0;          ///< a pixel fails above this
    double fail_percent = 0;  ///< of the pixels, which may fail
    double hard_fail = 0;     ///< no pixel may differ by more
};

struct EffectCase {
    std::filesystem::path file;
    std::filesystem::path capture;  ///< a capture.json, absolute
    std::vector<int> frames;
    std::string look;                  ///< the steps, as the text of a look
    std::vector<std::string> outputs;  ///< roles
    CaseTolerance tolerance;
    std::vector<std::string> tags;

    std::string name() const { return file.stem().string(); }
    /// Beside the case: <case>.<output>.<frame>.exr, frames of four digits.
    std::filesystem::path golden(const std::string& output, int frame) const {
        return file.parent_path() / FramePattern(name() + "." + output + ".####.exr").path(frame);
    }
};

/// A node as JSON. Places are lost: faults inside the steps carry the lines of this text.
inline std::string to_json(const Node& node) {
    std::string text;
    switch (node.kind) {
        case Node::Kind::null: return "null";
        case Node::Kind::boolean: return node.boolean ? "true" : "false";
        case Node::Kind::integer: return std::to_string(node.integer);
        case Node::Kind::number: return format_number(node.number);
        case Node::Kind::string:
            for (const char c : node.string)
                text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
            return '"' + text + '"';
        case Node::Kind::array:
            for (const Node& item : node.items) text += (text.empty() ? "" : ", ") + to_json(item);
            return "[" + text + "]";
        case Node::Kind::object:
            for (const Member& member : node.members)
                text += (text.empty() ? "\"" : ", \"") + member.key + "\": " + to_json(member.value);
            return "{" + text + "}";
    }
    return text;
}

inline CaseTolerance parse_tolerance(const Node& node, Diagnostics& diagnostics) {
    using Presence = ObjectReader::Presence;
    ObjectReader reader(node, "the tolerance", diagnostics);
    CaseTolerance tolerance;
    tolerance.fail = reader.number("fail", Presence::required).value_or(0);
    tolerance.fail_percent = reader.number("fail_percent", Presence::required).value_or(0);
    tolerance.hard_fail = reader.number("hard_fail", Presence::required).value_or(0);
    reader.finish();
    if (tolerance.fail < 0 || tolerance.hard_fail < tolerance.fail)
        diagnostics.error(node.place, "'fail' must be at least 0 and 'hard_fail' at least 'fail'");
    if (tolerance.fail_percent < 0 || tolerance.fail_percent > 100)
        diagnostics.error(node.place, "'fail_percent' must be from 0 to 100");
    return tolerance;
}

/// Faults go to `diagnostics`; nullopt after any. `root` is what the capture's path is relative to.
inline std::optional<EffectCase> parse_case(const Node& node, const std::filesystem::path& file,
                                            const std::filesystem::path& root, Diagnostics& diagnostics) {
    using Presence = ObjectReader::Presence;
    const int errors_before = diagnostics.error_count();
    ObjectReader reader(node, "the case", diagnostics);
    EffectCase result;
    result.file = file;
    check_document_version(reader, node, diagnostics);
    reader.text("$schema");
    if (const auto capture = reader.text("capture", Presence::required)) {
        result.capture = root / *capture;
        if (!std::filesystem::is_regular_file(result.capture))
            diagnostics.error(node.find("capture")->place, "no file " + result.capture.string());
    }
    if (const auto range = reader.text("frames", Presence::required)) {
        result.frames = parse_frame_range(*range).value_or(std::vector<int>{});
        if (result.frames.empty())
            diagnostics.error(node.find("frames")->place, "'" + *range + "' is no range of frames");
    }
    if (const Node* steps = reader.array("steps", Presence::required))
        result.look = R"({"aftershade": 1, "steps": )" + to_json(*steps) + "}";
    result.outputs = reader.texts("outputs");
    if (result.outputs.empty()) diagnostics.error(node.place, "'outputs' must name a role");
    if (const Node* tolerance = reader.object("tolerance", Presence::required))
        result.tolerance = parse_tolerance(*tolerance, diagnostics);
    result.tags = reader.texts("tags");
    reader.finish();
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return result;
}

/// The cases of one effect's folder, sorted by name.
inline std::vector<EffectCase> read_cases(const std::filesystem::path& effect_folder,
                                          const std::filesystem::path& root, Diagnostics& diagnostics) {
    std::vector<std::filesystem::path> files;
    if (std::filesystem::is_directory(effect_folder / "cases"))
        for (const auto& entry : std::filesystem::directory_iterator(effect_folder / "cases")) {
            // <case>.<output>.<frame>.json is a golden's sidecar.
            const std::string stem = entry.path().stem().string();
            if (entry.path().extension() == ".json" && stem.find('.') == std::string::npos)
                files.push_back(entry.path());
        }
    std::sort(files.begin(), files.end());
    std::vector<EffectCase> cases;
    for (const auto& file : files)
        if (const auto node = read_document(file, diagnostics))
            if (auto parsed = parse_case(*node, file, root, diagnostics)) cases.push_back(std::move(*parsed));
    return cases;
}

/// What a golden keeps of an image: halves.
inline Image rounded_to_half(const Image& image) {
    Image result = image;
    for (float& value : result.floats()) value = float(half(value));
    return result;
}

/// What is wrong with `image` by the case's tolerance; "" where nothing is. Both must have one size.
inline std::string difference(const Image& golden, const Image& image, const CaseTolerance& tolerance) {
    if (golden.width() != image.width() || golden.height() != image.height() ||
        golden.channels() != image.channels())
        return "has another size or other channels than its golden";
    std::size_t failed = 0;
    double most = 0;
    int most_x = 0, most_y = 0;
    for (int y = 0; y < golden.height(); ++y)
        for (int x = 0; x < golden.width(); ++x) {
            double worst = 0;
            for (int c = 0; c < golden.channels(); ++c) {
                const float expected = golden.at(x, y, c), got = image.at(x, y, c);
                const bool same = expected == got || (std::isnan(expected) && std::isnan(got));
                const double apart = same ? 0 : std::abs(double(expected) - double(got));
                worst = std::max(worst, std::isnan(apart) ? INFINITY : apart);
            }
            failed += worst > tolerance.fail;
            if (worst <= most) continue;
            most = worst;
            most_x = x;
            most_y = y;
        }
    const double percent = 100.0 * double(failed) / (double(golden.width()) * double(golden.height()));
    std::ostringstream text;
    if (percent > tolerance.fail_percent)
        text << percent << " % of the pixels differ by more than " << tolerance.fail << ", "
             << tolerance.fail_percent << " % may; ";
    if (percent > tolerance.fail_percent || most > tolerance.hard_fail)
        text << "the most, " << most << ", at (" << most_x << ", " << most_y << "); hard_fail is "
             << tolerance.hard_fail;
    return text.str();
}

}  // namespace aftershade::test
