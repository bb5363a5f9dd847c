#include "framework/run/checkpoints.h"

#include <unistd.h>

#include <algorithm>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/capture/frame_range.h"
#include "framework/render/history_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kName = "####.history";

}  // namespace

Checkpoints::Checkpoints(const RunState& state, std::vector<int> frames)
    : base_(state.folder), name_(state.checkpoints()), frames_(std::move(frames)) {
    for (std::size_t i = 0; i < frames_.size(); ++i) places_[frames_[i]] = i;
}

fs::path Checkpoints::file(int frame) const {
    return base_ / name_of(frame);
}

std::string Checkpoints::name_of(int frame) const {
    return name_ + "/" + FramePattern(kName).path(frame);
}

bool Checkpoints::holds(int frame, const std::string& fingerprint) const {
    std::string fault;
    if (!open_file_below(base_, name_of(frame), fault)) return false;
    try {
        return read_history(file(frame)).fingerprint == fingerprint;
    } catch (const Error&) {
        return false;  // damaged: an older one, or none, does instead
    }
}

fs::path Checkpoints::writable(int frame) const {
    try {
        make_folder_below(base_, name_);
        return path_below(base_, name_of(frame));
    } catch (const Error& error) {
        throw Error(ErrorKind::output,
                    std::string(error.what()) + " (" + spelled(Option::checkpoint, "0") + " runs without)");
    }
}

fs::path Checkpoints::folder() const {
    try {
        return path_below(base_, name_);
    } catch (const Error&) {
        return {};  // what stands behind a link is not ours
    }
}

std::vector<std::size_t> Checkpoints::saved() const {
    const FramePattern name(kName);
    std::vector<std::size_t> places;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder(), failure))
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
    if (folder().empty()) return;
    std::error_code failure;
    for (const std::size_t place : saved()) fs::remove(file(frames_[place]), failure);
    // What kills left; what other workers are writing stays.
    remove_stale_temporaries(folder());
    // The folders go where nothing of another run is in them.
    rmdir((base_ / name_).c_str());
    rmdir((base_ / name_).parent_path().c_str());
}

}  // namespace aftershade
