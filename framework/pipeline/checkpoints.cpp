#include "framework/pipeline/checkpoints.h"

#include <algorithm>
#include <utility>

#include "framework/capture/frame_range.h"
#include "framework/core/error.h"
#include "framework/pipeline/history_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "####.history";

}  // namespace

Checkpoints::Checkpoints(const RunState& state, std::vector<int> frames)
    : folder_(state.checkpoints()), frames_(std::move(frames)) {
    for (std::size_t i = 0; i < frames_.size(); ++i) places_[frames_[i]] = i;
}

fs::path Checkpoints::file(int frame) const {
    return folder_ / FramePattern(kName).path(frame);
}

bool Checkpoints::holds(int frame, const std::string& fingerprint) const {
    std::error_code unreadable;
    if (!fs::exists(file(frame), unreadable)) return false;
    try {
        return read_history(file(frame)).fingerprint == fingerprint;
    } catch (const Error&) {
        return false;  // damaged: an older one, or none, does instead
    }
}

void Checkpoints::make_folder() const {
    std::error_code failure;
    fs::create_directories(folder_, failure);
    if (failure)
        throw Error(ExitCode::output, folder_.string() + ": cannot be made: " + failure.message() +
                                          " (--checkpoint 0 runs without)");
}

std::vector<std::size_t> Checkpoints::saved() const {
    const FramePattern name(kName);
    std::vector<std::size_t> places;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder_, failure))
        if (const auto frame = name.match(entry.path().filename().string()))
            if (const auto place = places_.find(*frame); place != places_.end())
                places.push_back(place->second);
    std::sort(places.rbegin(), places.rend());
    return places;
}

void Checkpoints::drop_old() const {
    // Two: the latest may have been saved before its frame's files were in place.
    constexpr std::size_t kKept = 2;
    const std::vector<std::size_t> places = saved();
    std::error_code failure;
    for (std::size_t i = kKept; i < places.size(); ++i) fs::remove(file(frames_[places[i]]), failure);
}

void Checkpoints::drop_all() const {
    std::error_code failure;
    for (const std::size_t place : saved()) fs::remove(file(frames_[place]), failure);
    // What kills left of some that were being written: ".0010.history.<pid>-<n>.tmp".
    const FramePattern name(kName);
    std::vector<fs::path> torn;
    for (const auto& entry : fs::directory_iterator(folder_, failure)) {
        const std::string text = entry.path().filename().string();
        const std::size_t end = text.find(".history.");
        if (!text.starts_with('.') || !text.ends_with(".tmp") || end == std::string::npos) continue;
        const auto frame = name.match(text.substr(1, end - 1) + ".history");
        if (frame && places_.contains(*frame)) torn.push_back(entry.path());
    }
    for (const fs::path& path : torn) fs::remove(path, failure);
    // The folders go where nothing of another run is in them.
    fs::remove(folder_, failure);
    fs::remove(folder_.parent_path(), failure);
}

}  // namespace aftershade
