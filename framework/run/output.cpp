#include "framework/run/output.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/file/png_file.h"
#include "framework/image/display.h"
#include "framework/image/false_color.h"
#include "framework/image/role.h"
#include "framework/run/exr_output.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::string extension(const fs::path& path) {
    return lower_case(path.extension().string());
}

/// The share of pixels that have a component above 1, which a PNG cuts.
double share_above_1(const Image& picture) {
    std::size_t count = 0;
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            count += std::max({picture.at(x, y, 0), picture.at(x, y, 1), picture.at(x, y, 2)}) > 1;
    return double(count) / (double(picture.width()) * picture.height());
}

/// What a display shows of the frame.
Image display_picture(const FrameResult& result, const Capture& capture) {
    const auto made = result.images.find(kDisplayRole);
    const CaptureHeader& header = capture.header;
    const Image display =
        made != result.images.end()
            ? made->second
            : display_of_color(*find_image(kColorRole, result, capture),
                               result.color_encoding ? result.color_encoding->primaries : header.primaries);
    return cropped_display(display, header.data_window, result.region.value_or(header.display_window),
                           header.keeps_alpha);
}

ColorEncoding display_encoding(const FrameResult& result) {
    return result.images.contains(kDisplayRole) ? result.display_encoding : kSrgbDisplay;
}

/// 8 bits of PQ or HLG show bands.
int png_bits(const OutputOptions& options, const ColorEncoding& encoding) {
    return options.png_bits != 0 ? options.png_bits : encoding.is_hdr() ? 16 : 8;
}

PngMeaning png_meaning(const OutputOptions& options, const FrameResult& result, const Capture& capture) {
    const ColorEncoding encoding = display_encoding(result);
    return {encoding, capture.header.pixel_aspect, png_bits(options, encoding)};
}

PngText png_text(const OutputOptions& options) {
    if (options.fingerprint.empty()) return {};
    return {{kFingerprintName, options.fingerprint}};
}

fs::path tap_path(const std::string& text, const std::string& tap, int frame) {
    const FramePattern pattern(text);
    const fs::path path = pattern.path(frame);
    std::string stem = path.stem().string();
    if (pattern.has_frame()) {
        // "out_####" without the number and what joins it to what stands before.
        const std::string open = fs::path(text).stem().string();
        const auto first = std::mismatch(open.begin(), open.end(), stem.begin(), stem.end());
        const auto last = std::mismatch(open.rbegin(), open.rend(), stem.rbegin(), stem.rend());
        std::string before(open.begin(), first.first);
        std::string after(last.first.base(), open.end());
        constexpr std::string_view kJoints = "._-";
        while (!before.empty() && kJoints.find(before.back()) != std::string_view::npos) before.pop_back();
        if (before.empty()) after.erase(0, std::min(after.find_first_not_of(kJoints), after.size()));
        stem = before + after;
    }
    return path.parent_path() /
           (stem + (stem.empty() ? "" : ".") + tap + "." + FramePattern("####").path(frame) + ".exr");
}

fs::path path_of_tap(const OutputOptions& options, const std::string& tap, int frame) {
    const auto asked = options.tap_patterns.find(tap);
    const std::string beside = options.patterns.empty() ? "####.exr" : options.patterns.front();
    return asked == options.tap_patterns.end() ? tap_path(beside, tap, frame)
                                               : fs::path(FramePattern(asked->second).path(frame));
}

void write_false_color(const fs::path& path, const Image& image, const OutputOptions& options,
                       const CaptureHeader& header) {
    const FalseColor colors(std::string(kDataRole), image, header.primaries);
    Image picture(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const DisplayColor color = colors.color(x, y);
            for (int c = 0; c < 3; ++c) picture.at(x, y, c) = color[std::size_t(c)];
        }
    write_png(path, picture, png_text(options), {std::nullopt, header.pixel_aspect});
}

void write_tap(const fs::path& path, const Image& image, const OutputOptions& options,
               const CaptureHeader& header) {
    constexpr std::string_view kNames = "RGBA";
    const bool is_uint = image.type() == ComponentType::uint32;
    std::vector<ExrOutputChannel> channels;
    for (int c = 0; c < image.channels(); ++c) {
        const std::string name = image.channels() == 1 ? "Y" : std::string(1, kNames[std::size_t(c)]);
        channels.push_back({name, is_uint ? PixelType::uint32 : PixelType::float32, &image, c});
    }
    ExrWriteOptions write = exr_write_options(options, header);
    // Its channels are called as those of pictures, and may be data.
    if (is_lossy_compression(write.compression)) write.compression = "zip";
    // A texture of another size than the working grid has windows of its own.
    if (image.width() != header.data_window.width() || image.height() != header.data_window.height())
        write.data_window = write.display_window = {0, 0, image.width() - 1, image.height() - 1};
    write_exr(path, channels, write);
}

/// A file name that was written down.
struct OutputName {
    Place place;
    std::string text;
    bool is_telemetry = false;
};

std::vector<OutputName> all_names(const OutputOptions& options) {
    std::vector<OutputName> names;
    for (const std::string& text : options.patterns)
        names.push_back({option_place(Option::output, text), text});
    for (const auto& [tap, text] : options.tap_patterns)
        names.push_back({option_place(Option::tap, tap + "=" + text), text});
    if (!options.telemetry.empty())
        names.push_back({option_place(Option::telemetry, options.telemetry), options.telemetry, true});
    return names;
}

/// Of the kinds that only a command of one's own makes.
bool is_film(const std::string& type) {
    return type == ".avi" || type == ".mxf" || type == ".mpg" || type == ".m4v" || type == ".gif";
}

}  // namespace

void prepare_output_folders(const OutputOptions& options, const Sequence& sequence) {
    std::set<fs::path> folders;
    for (const auto& [place, text, is_telemetry] : all_names(options))
        for (const int frame : sequence.frames) {
            const fs::path file = FramePattern(text).path(frame);
            if (folders.insert(file.parent_path()).second) prepare_output_folder(file);
        }
}

void check_outputs(const OutputOptions& options, const Sequence& sequence, InputFiles& inputs,
                   Diagnostics& diagnostics) {
    if (options.patterns.empty() && !options.stream_format)
        diagnostics.error(option_place(Option::output), "no output; name at least one file, such as " +
                                                            spelled(Option::output, "out_####.exr"));
    for (const auto& [place, text, is_telemetry] : all_names(options)) {
        const FramePattern pattern(text);
        const std::string type = extension(text);
        if (is_telemetry ? type != ".json" : type != ".exr" && type != ".png")
            diagnostics.error(place,
                              "the format '" + type + "' is not known; " +
                                  (is_telemetry ? "telemetry ends in .json" : "outputs end in .exr or .png") +
                                  (is_film(type) ? "; for a film, " + spelled(Option::output, "-") + " " +
                                                       spelled(Option::print_ffmpeg) +
                                                       " prints the command that gives the frames to ffmpeg"
                                                 : ""));
        if (sequence.frames.size() > 1 && !pattern.has_frame())
            diagnostics.error(place, std::to_string(sequence.frames.size()) +
                                         " frames cannot share one file; write the number as #### or %04d");
        for (const int frame : sequence.frames)
            if (!inputs.check_output(place, pattern.path(frame), diagnostics) || !pattern.has_frame()) break;
    }
    for (const std::string& tap : std::set<std::string>(options.taps.begin(), options.taps.end()))
        for (const int frame : sequence.frames)
            if (!options.patterns.empty() && !options.tap_patterns.contains(tap) &&
                !inputs.check_output(option_place(Option::tap, tap), path_of_tap(options, tap, frame),
                                     diagnostics))
                break;
    const auto& known = exr_compression_names();
    if (std::find(known.begin(), known.end(), options.compression) == known.end() &&
        !exr_compression_level(options.compression))
        diagnostics.error(
            option_place(Option::compression, options.compression),
            "must be one of " + list_of_names(known) + ", or zip or zips with a level, as zip:1");
    std::set<std::string> roles;
    for (const std::string& role : options.roles) {
        const Place place = option_place(Option::output_roles, role);
        if (!find_role(role)) diagnostics.error(place, "not a role" + did_you_mean(role, role_names()));
        if (!roles.insert(role).second) diagnostics.error(place, "this role is named twice");
    }
}

std::vector<std::string> wanted_roles(const OutputOptions& options, bool makes_display) {
    const std::vector<std::string> shown = makes_display ? std::vector<std::string>{kDisplayRole}
                                                         : std::vector<std::string>{kDisplayRole, kColorRole};
    if (options.keep_channels) return role_names();
    std::vector<std::string> roles;
    for (const std::string& pattern : options.patterns) {
        if (extension(pattern) == ".exr")
            roles.insert(roles.end(), options.roles.begin(), options.roles.end());
        else roles.insert(roles.end(), shown.begin(), shown.end());
    }
    if (options.stream_format) roles.insert(roles.end(), shown.begin(), shown.end());
    std::sort(roles.begin(), roles.end());
    roles.erase(std::unique(roles.begin(), roles.end()), roles.end());
    return roles;
}

std::vector<std::string> roles_written_as_halfs(const OutputOptions& options) {
    const auto is_exr = [](const std::string& pattern) { return extension(pattern) == ".exr"; };
    if (options.stream_format || options.keep_channels || options.color_type != PixelType::half ||
        !std::ranges::all_of(options.patterns, is_exr))
        return {};
    std::vector<std::string> roles;
    for (const std::string& role : options.roles)
        if (find_role(role)->pixel_type == PixelType::half) roles.push_back(role);
    return roles;
}

std::vector<fs::path> output_files(const OutputOptions& options, const std::vector<Tap>& taps, int frame) {
    std::vector<fs::path> files;
    for (const std::string& text : options.patterns) files.emplace_back(FramePattern(text).path(frame));
    std::set<std::string> names;
    for (const Tap& tap : taps) names.insert(tap.text());
    for (const std::string& name : names) files.push_back(path_of_tap(options, name, frame));
    if (!options.telemetry.empty()) files.emplace_back(FramePattern(options.telemetry).path(frame));
    return files;
}

std::string encode_display(const std::string& name, const OutputOptions& options, const FrameResult& result,
                           const Capture& capture) {
    return encode_png(name, display_picture(result, capture), png_text(options),
                      png_meaning(options, result, capture));
}

WrittenFiles write_outputs(const OutputOptions& options, const FrameResult& result, const Capture& capture,
                           const CaptureReader& reader) {
    WrittenFiles written;
    const int frame = capture.header.frame;
    for (const std::string& text : options.patterns) {
        const fs::path path = FramePattern(text).path(frame);
        if (extension(path) != ".exr") {
            const Image picture = display_picture(result, capture);
            if (!result.images.contains(kDisplayRole)) written.share_cut = share_above_1(picture);
            write_png(path, picture, png_text(options), png_meaning(options, result, capture));
        } else if (auto lost = write_exr_output(path, options, result, capture, reader); !lost.empty())
            written.warnings.push_back(std::move(lost));
        written.paths.push_back(path);
    }
    if (options.stream)
        options.stream->write(frame, display_picture(result, capture), display_encoding(result));
    for (const auto& [tap, image] : result.taps) {
        const fs::path path = path_of_tap(options, tap, frame);
        if (!options.tap_patterns.contains(tap)) path_below(path.parent_path(), path.filename());
        if (extension(path) == ".png") write_false_color(path, image, options, capture.header);
        else write_tap(path, image, options, capture.header);
        written.paths.push_back(path);
    }
    if (result.telemetry && !options.telemetry.empty()) {
        written.paths.emplace_back(FramePattern(options.telemetry).path(frame));
        write_text_file(written.paths.back(), telemetry_json(*result.telemetry));
    }
    return written;
}

}  // namespace aftershade
