#include "framework/serve/truths.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/option.h"
#include "framework/compare/flip.h"
#include "framework/compare/metrics.h"
#include "framework/file/exr_file.h"
#include "framework/file/stored_colors.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"
#include "framework/serve/http_message.h"

namespace aftershade::serve {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "truth_", kEnd = ".exr";

struct TruthName {
    std::string name;
    int frame = 0;
};

/// "truth_lens_shutter_0004.exr" is of "lens+shutter" and frame 4.
std::optional<TruthName> truth_name(const std::string& file) {
    if (!file.starts_with(kBegin) || !file.ends_with(kEnd)) return std::nullopt;
    const std::string middle = file.substr(kBegin.size(), file.size() - kBegin.size() - kEnd.size());
    const std::size_t at = middle.rfind('_');
    if (at == std::string::npos || at == 0) return std::nullopt;
    TruthName truth{middle.substr(0, at)};
    const char* end = middle.data() + middle.size();
    const auto [stopped, failure] = std::from_chars(middle.data() + at + 1, end, truth.frame);
    if (failure != std::errc() || stopped != end) return std::nullopt;
    std::ranges::replace(truth.name, '_', '+');
    return truth;
}

fs::path folder_of(const Sequence& sequence, int frame) {
    return sequence.path_of(sequence.file_number(frame, sequence.subframes / 2)).parent_path();
}

/// By name, of the frames in a folder.
std::map<int, std::map<std::string, fs::path>> truths_in(const fs::path& folder) {
    std::map<int, std::map<std::string, fs::path>> truths;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, failure)) {
        const auto truth = truth_name(entry.path().filename().string());
        if (truth && entry.symlink_status(failure).type() == fs::file_type::regular)
            truths[truth->frame].emplace(truth->name, entry.path());
    }
    return truths;
}

Image rgb_of(const Image& image) {
    Image rgb(image.width(), image.height(), 3);
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x)
            for (int c = 0; c < 3; ++c) rgb.at(x, y, c) = image.at(x, y, std::min(c, image.channels() - 1));
    return rgb;
}

}  // namespace

std::map<int, std::vector<std::string>> truths_of(const Sequence& sequence) {
    std::set<fs::path> folders;
    for (const int frame : sequence.frames) folders.insert(folder_of(sequence, frame));
    std::map<int, std::vector<std::string>> names;
    for (const fs::path& folder : folders)
        for (const auto& [frame, truths] : truths_in(folder))
            if (std::ranges::find(sequence.frames, frame) != sequence.frames.end() &&
                folder_of(sequence, frame) == folder)
                for (const auto& [name, path] : truths) names[frame].push_back(name);
    return names;
}

Capture read_truth(const Sequence& sequence, int frame, const std::string& name, const CaptureHeader& header,
                   const ReadLimits& limits) {
    const auto truths = truths_in(folder_of(sequence, frame));
    const auto of_frame = truths.find(frame);
    if (of_frame == truths.end() || !of_frame->second.contains(name))
        throw Refusal{404,
                      fmt::format("frame {} has no truth '{}' beside it (`aftershade render {}` writes one)",
                                  frame, name, spelled(Option::truth, name))};
    const ExrFile file(of_frame->second.at(name), limits);
    Capture truth;
    truth.header = header;
    Image color = file.read_floats(0, std::vector<std::string>{"R", "G", "B"});
    const ExrMetadata& metadata = file.parts().front().metadata;
    if (const StoredColors stored = stored_colors(metadata, metadata); stored.is_known())
        light_of_stored(color, stored, header.primaries, of_frame->second.at(name).string());
    const Window& window = header.data_window;
    if (color.width() != window.width() || color.height() != window.height())
        throw Refusal{409,
                      fmt::format("the truth '{}' of frame {} has {}x{} px, the capture {}x{}", name, frame,
                                  color.width(), color.height(), window.width(), window.height())};
    Image& opaque = truth.images.emplace(kColorRole, Image(color.width(), color.height(), 4)).first->second;
    for (int y = 0; y < color.height(); ++y)
        for (int x = 0; x < color.width(); ++x) {
            for (int c = 0; c < 3; ++c) opaque.at(x, y, c) = color.at(x, y, c);
            opaque.at(x, y, 3) = 1;
        }
    return truth;
}

Image absolute_difference(const Image& truth, const Image& test) {
    Image apart(truth.width(), truth.height(), 4);
    for (int y = 0; y < truth.height(); ++y)
        for (int x = 0; x < truth.width(); ++x) {
            for (int c = 0; c < 3; ++c)
                apart.at(x, y, c) =
                    std::abs(test.at(x, y, std::min(c, test.channels() - 1)) - truth.at(x, y, c));
            apart.at(x, y, 3) = 1;
        }
    return apart;
}

nlohmann::ordered_json metrics_json(const std::string& name, const Capture& truth, const Image& color) {
    Image reference = rgb_of(truth.images.at(kColorRole)), test = rgb_of(color);
    if (const Chromaticities& primaries = truth.header.primaries; primaries != kRec709)
        for (Image* image : {&reference, &test})
            convert_colors(*image, conversion_matrix(primaries, kRec709));
    const double psnr_db = display_psnr_db(reference, test);
    nlohmann::ordered_json json = {{"truth", name}};
    if (std::isfinite(psnr_db)) json["psnr_db"] = psnr_db;
    else json["psnr_db"] = psnr_db > 0 ? "inf" : "-inf";
    json["flip"] = ldr_flip(reference, test).mean;
    return json;
}

}  // namespace aftershade::serve
