#include "cli/inspect_sheet.h"

#include <filesystem>
#include <iostream>
#include <optional>
#include <vector>

#include "cli/capture_options.h"
#include "framework/file/png_file.h"
#include "framework/image/display.h"
#include "framework/image/role.h"
#include "framework/inspect/contact_sheet.h"
#include "framework/look/pipeline.h"

namespace aftershade::cli {

namespace {

/// Grey becomes three equal channels, and its alpha the fourth.
Image as_rgb(Image picture) {
    if (picture.channels() > 2) return picture;
    Image rgb(picture.width(), picture.height(), picture.channels() + 2);
    for (int y = 0; y < picture.height(); ++y)
        for (int x = 0; x < picture.width(); ++x)
            for (int c = 0; c < rgb.channels(); ++c) rgb.at(x, y, c) = picture.at(x, y, c < 3 ? 0 : 1);
    return rgb;
}

Image read_display(const Sequence& sequence, const CaptureReader& reader, int frame) {
    const int file = sequence.file_number(frame);
    if (const auto path = sequence.path_of(file); path.extension() == ".png") {
        PngColor color;
        Image picture = as_rgb(read_png(path, &color));
        if (color.encoding && *color.encoding != kSrgbDisplay)
            encode_display_as_srgb(picture, *color.encoding);
        return picture;
    }
    Capture capture = reader.read(file, std::vector{std::string(kColorRole)});
    const CaptureHeader& header = capture.header;
    print_differences(header);
    if (!capture.images.contains(kColorRole))
        throw missing_roles({{"a thumbnail", kColorRole}}, header, &reader);
    return cropped_display(display_of_color(std::move(capture.images.at(kColorRole)), header.primaries),
                           header.data_window, header.display_window);
}

struct MissingThumbnail {
    int frame = 0;
    std::string why;
};

}  // namespace

ExitCode write_frame_sheet(const std::string& path, int columns, const Sequence& sequence,
                           const CaptureReader& reader) {
    const auto count = sequence.frames.size();
    if (count > std::size_t(kMostSheetFrames))
        throw Error(ErrorKind::usage, "--contact-sheet: " + std::to_string(count) + " frames, the limit is " +
                                          std::to_string(kMostSheetFrames) +
                                          "; choose some, such as --frames 1-5000x10");
    const std::string title = std::filesystem::path(sequence.files.text()).filename().string();
    std::optional<FrameSheet> sheet;
    std::vector<MissingThumbnail> missing;  // before the first that can be read, which has the size
    bool is_whole = true;
    for (const int frame : sequence.frames) {
        try {
            const Image display = read_display(sequence, reader, frame);
            if (!sheet) {
                sheet.emplace(title, int(count), columns, display.width(), display.height());
                for (const auto& [number, why] : missing) sheet->add_missing(number, why);
            }
            sheet->add(frame, display);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::capture) throw;
            is_whole = false;
            std::cerr << "aftershade: error: " << error.what() << "\n";
            const bool exists = std::filesystem::exists(sequence.path_of(sequence.file_number(frame)));
            const std::string why = exists ? "unreadable" : "missing";
            if (sheet) sheet->add_missing(frame, why);
            else missing.push_back({frame, why});
        }
    }
    if (!sheet)
        throw Error(ErrorKind::capture, title + ": no frame can be read, so there is no contact sheet");
    write_png(path, sheet->picture());
    std::cerr << "contact sheet: " << path << "\n";
    return is_whole ? ExitCode::done : ExitCode::partial;
}

}  // namespace aftershade::cli
