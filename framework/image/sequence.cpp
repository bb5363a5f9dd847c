#include "framework/image/sequence.h"

#include <algorithm>

#include "framework/core/document.h"
#include "framework/core/error.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::vector<int> read_cuts(ObjectReader& reader, Diagnostics& diagnostics) {
    std::vector<int> cuts;
    const Node* list = reader.array("cuts");
    if (!list) return cuts;
    for (const Node& item : list->items) {
        if (item.kind == Node::Kind::integer) cuts.push_back(int(item.integer));
        else diagnostics.error(item.place, "'cuts' holds frame numbers, not " + std::string(kind_name(item.kind)));
    }
    return cuts;
}

std::optional<Sequence> read_capture_document(const fs::path& path, Diagnostics& diagnostics) {
    using Presence = ObjectReader::Presence;
    const auto node = read_document(path, diagnostics);
    if (!node) return std::nullopt;
    const int errors_before = diagnostics.error_count();

    ObjectReader reader(*node, "the capture", diagnostics);
    check_document_version(reader, *node, diagnostics);
    reader.text("$schema");
    Sequence sequence;
    if (const auto frames = reader.text("frames", Presence::required))
        sequence.files = FramePattern((path.parent_path() / *frames).string());
    if (const auto range = reader.text("range")) {
        const auto numbers = parse_frame_range(*range);
        if (numbers) sequence.frames = *numbers;
        else diagnostics.error(node->find("range")->place, "'" + *range + "' is not a frame range such as \"1-100x2,120\"");
    }
    if (const auto fps = reader.number("fps")) {
        sequence.fps = *fps;
        if (*fps <= 0) diagnostics.error(node->find("fps")->place, "'fps' must be above 0");
    }
    sequence.profile = reader.text("profile").value_or("auto");
    if (const Node* camera = reader.object("camera")) sequence.camera = parse_camera(*camera, diagnostics);
    sequence.cuts = read_cuts(reader, diagnostics);
    reader.finish();
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return sequence;
}

void find_missing_range(Sequence& sequence, const std::string& argument) {
    if (!sequence.frames.empty()) return;
    if (sequence.files.has_frame()) {
        sequence.frames = find_frames(sequence.files);
        if (sequence.frames.empty())
            throw Error(ExitCode::capture, argument + ": no file fits the pattern " + sequence.files.text());
        return;
    }
    const fs::path file = sequence.files.text();
    sequence.frames = {frame_in_name(file.stem().string()).value_or(1)};
}

}  // namespace

std::vector<int> find_frames(const FramePattern& pattern) {
    const fs::path folder = fs::path(pattern.text()).parent_path();
    const std::string prefix = folder.empty() ? "" : (folder / "").string();
    std::vector<int> frames;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, failure))
        if (const auto frame = pattern.match(prefix + entry.path().filename().string())) frames.push_back(*frame);
    std::sort(frames.begin(), frames.end());
    return frames;
}

std::optional<Sequence> open_sequence(const std::string& argument, Diagnostics& diagnostics) {
    const fs::path path = argument;
    Sequence sequence;
    if (path.extension() == ".json") {
        if (!fs::exists(path)) throw Error(ExitCode::capture, argument + ": no such file");
        auto read = read_capture_document(path, diagnostics);
        if (!read) return std::nullopt;
        sequence = std::move(*read);
    } else {
        sequence.files = FramePattern(argument);
    }
    find_missing_range(sequence, argument);
    return sequence;
}

}  // namespace aftershade
