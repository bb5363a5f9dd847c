#include "framework/golden/capture_hash.h"

#include <optional>

#include "framework/base/content_hash.h"
#include "framework/base/data_path.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/sequence.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

void add_frame(const Sequence& sequence, int frame, std::set<fs::path>& files) {
    for (std::size_t layer = 0; layer < sequence.layers.size(); ++layer)
        add_frame(sequence_of_layer(sequence, layer), frame, files);
    if (!sequence.layers.empty()) return;
    for (int subframe = 0; subframe < sequence.subframes; ++subframe) {
        const int number = sequence.file_number(frame, subframe);
        if (!sequence.files.text().empty()) files.insert(sequence.path_of(number));
        for (const auto& [role, pattern] : sequence.role_files) files.insert(pattern.path(number));
    }
}

/// The documents of profiles that the sequence names, of all where it leaves the choice to its files.
void add_profiles(const Sequence& sequence, std::set<fs::path>& files) {
    const fs::path folder = data_path() / "profiles";
    std::set<std::string> names{sequence.profile};
    for (const LayerSource& layer : sequence.layers) names.insert(layer.profile.value_or(sequence.profile));
    for (const auto& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".json" &&
            (names.contains("auto") || names.contains(entry.path().stem().string())))
            files.insert(entry.path());
}

/// The files of frame `only`, else those of all frames and their neighbours.
std::set<fs::path> files_of(const GoldenCase& test, std::optional<int> only) {
    Diagnostics faults;
    const std::optional<Sequence> sequence = open_sequence(test.capture.string(), faults);
    if (!sequence || faults.has_errors()) return {};
    std::set<fs::path> files;
    if (const auto document = capture_document(test.capture.string())) files.insert(*document);
    const auto chosen = only ? std::vector{*only} : parse_frame_range(test.frames);
    const int reach = only ? 0 : kMostFrameOffset;
    for (const int frame : chosen ? *chosen : sequence->frames)
        for (int away = -reach; away <= reach; ++away) add_frame(*sequence, frame + away, files);
    if (!sequence->whole.empty()) add_frame(*sequence, sequence->whole.front(), files);  // it decides for all
    add_profiles(*sequence, files);
    return files;
}

}  // namespace

std::set<fs::path> capture_files(const GoldenCase& test, int frame) {
    try {
        return files_of(test, frame);
    } catch (const std::exception&) {
        return {};  // the worker reports it
    }
}

std::string CaptureHasher::hash(const GoldenCase& test) {
    const std::scoped_lock lock(mutex_);
    try {
        std::string text;
        for (const fs::path& file : files_of(test, std::nullopt)) text += content_of(file) + "\n";
        return text.empty() ? "" : content_hash(text);
    } catch (const std::exception&) {
        return "";  // the worker tells it
    }
}

const std::string& CaptureHasher::content_of(const fs::path& file) {
    const auto known = contents_.find(file);
    if (known != contents_.end()) return known->second;
    // A neighbour need not be there.
    return contents_[file] = fs::exists(file) ? file_content(file).hash : "absent";
}

}  // namespace aftershade
