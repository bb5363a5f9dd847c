#include "framework/batch/capture_hash.h"

#include "framework/capture/frame_range.h"
#include "framework/capture/sequence.h"
#include "framework/core/content_hash.h"
#include "framework/core/diagnostics.h"
#include "framework/core/error.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

void add_frame(const Sequence& sequence, int frame, std::vector<fs::path>& files) {
    for (std::size_t layer = 0; layer < sequence.layers.size(); ++layer)
        add_frame(sequence_of_layer(sequence, layer), frame, files);
    if (!sequence.layers.empty()) return;
    for (int subframe = 0; subframe < sequence.subframes; ++subframe) {
        const int number = sequence.file_number(frame, subframe);
        if (!sequence.files.text().empty()) files.push_back(sequence.path_of(number));
        for (const auto& [role, pattern] : sequence.role_files) files.push_back(pattern.path(number));
    }
}

std::vector<fs::path> files_of(const GoldenCase& test) {
    Diagnostics faults;
    const std::optional<Sequence> sequence = open_sequence(test.capture.string(), faults);
    if (!sequence || faults.has_errors()) return {};
    std::vector<fs::path> files;
    if (const auto document = capture_document(test.capture.string())) files.push_back(*document);
    const auto chosen = parse_frame_range(test.frames);
    for (const int frame : chosen ? *chosen : sequence->frames) add_frame(*sequence, frame, files);
    return files;
}

}  // namespace

std::string CaptureHasher::hash(const GoldenCase& test) {
    try {
        std::string text;
        for (const fs::path& file : files_of(test)) text += content_of(file);
        return text.empty() ? "" : content_hash(text);
    } catch (const Error&) {
        return "";  // the worker tells it
    }
}

const std::string& CaptureHasher::content_of(const fs::path& file) {
    const auto known = contents_.find(file);
    if (known != contents_.end()) return known->second;
    return contents_[file] = file_content(file).hash;
}

}  // namespace aftershade
