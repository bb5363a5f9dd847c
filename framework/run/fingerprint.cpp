#include "framework/run/fingerprint.h"

#include <algorithm>
#include <utility>

#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/image/role.h"
#include "framework/render/history_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kAbsent = "absent";

}  // namespace

std::string hash_of_parts(const FingerprintParts& parts) {
    std::string text;
    for (const auto& [name, hash] : parts) text += name + "\n" + hash + "\n";
    return content_hash(text);
}

std::string difference_of_parts(const FingerprintParts& before, const FingerprintParts& now) {
    std::vector<std::string> names;
    for (const auto& [name, hash] : now)
        if (const auto old = before.find(name); old == before.end() || old->second != hash)
            names.push_back(name);
    for (const auto& [name, hash] : before)
        if (!now.contains(name)) names.push_back(name);
    if (names.empty()) return "";
    constexpr std::size_t kMost = 3;
    if (names.size() > kMost) {
        const std::size_t more = names.size() - (kMost - 1);
        names.resize(kMost - 1);
        names.push_back(std::to_string(more) + " more");
    }
    return joined(names, " and ") + " changed";
}

FrameFingerprints::FrameFingerprints(std::string setup, const Sequence& sequence, const CaptureReader& reader,
                                     const Pipeline& pipeline, RunOptions run)
    : setup_(std::move(setup)),
      pipeline_(pipeline),
      run_(std::move(run)),
      files_(sequence, reader, pipeline) {
    for (const RoleId& role : pipeline.capture_roles())
        reads_motion_ = reads_motion_ || kind_of_role(role) == RoleKind::motion;
    for (const int offset : pipeline.neighbour_offsets())
        for (const RoleId& role : pipeline.neighbour_roles(offset))
            reads_motion_ = reads_motion_ || kind_of_role(role) == RoleKind::motion;
}

std::size_t FrameFingerprints::shown_index(std::size_t index) const {
    if (run_.missing != MissingFrame::hold) return index;
    for (std::size_t i = index + 1; i-- > 0;)
        if (!files_.is_missing(run_.frames[i])) return i;
    return index;
}

bool FrameFingerprints::begins_history(std::size_t index) const {
    if (index == 0 || files_.begins_shot(run_.frames[index])) return true;
    if (run_.frames[index] != run_.frames[index - 1] + 1) return true;
    if (files_.is_missing(run_.frames[index - 1]) && shown_index(index - 1) == index - 1) return true;
    const std::lock_guard guard(mutex_);
    return failed_.contains(index - 1);
}

void FrameFingerprints::mark_failed(std::size_t index) {
    const std::lock_guard guard(mutex_);
    failed_.insert(index);
    known_.erase(known_.upper_bound(index), known_.end());
}

const std::string& FrameFingerprints::content_of(const fs::path& file) {
    const auto [found, is_new] = contents_.try_emplace(file);
    std::error_code unreadable;
    if (!is_new) return found->second;
    found->second = kAbsent;
    try {
        if (fs::exists(file, unreadable)) found->second = file_content(file).hash;
    } catch (const Error&) {
        found->second = "unreadable";  // reading the frame reports it
    }
    return found->second;
}

FrameFingerprint FrameFingerprints::own(std::size_t index) {
    const int frame = run_.frames[index];
    FrameFingerprint result;
    // Names are for messages: what a file is read as counts, not how it is called.
    std::string text = setup_ + "\nframe " + std::to_string(frame) + "\n";
    if (files_.begins_shot(frame)) text += "begins a shot\n";
    const std::lock_guard guard(mutex_);
    for (const FrameFiles::Input& input : files_.inputs(run_.frames[shown_index(index)], reads_motion_)) {
        const std::string& hash = content_of(input.path);
        text += input.role + " " + std::to_string(input.number) + " " + hash + "\n";
        std::string name = "input " + input.path.filename().string();
        if (const auto same = result.inputs.find(name); same != result.inputs.end() && same->second != hash)
            name = "input " + input.path.string();
        result.inputs[name] = hash;
    }
    result.hash = content_hash(text);
    return result;
}

std::string FrameFingerprints::before(std::size_t index) {
    if (!begins_history(index)) return of(index - 1).hash;
    if (index > 0 || run_.history_in.empty()) return FrameFingerprint::kBegin;
    const SavedHistory history = read_history(run_.history_in);
    return history.fingerprint.empty() ? file_content(run_.history_in).hash : history.fingerprint;
}

FrameFingerprint FrameFingerprints::of(std::size_t index) {
    const auto known = [&](std::size_t i) -> std::optional<FrameFingerprint> {
        const std::lock_guard guard(mutex_);
        const auto found = known_.find(i);
        return found == known_.end() ? std::nullopt : std::optional(found->second);
    };
    // From the last one that is known: a chain may be too long to follow by recursion.
    std::size_t first = index;
    while (pipeline_.has_history() && !known(first) && !begins_history(first)) --first;
    for (std::size_t i = first; i <= index; ++i) {
        if (known(i)) continue;
        FrameFingerprint one = own(i);
        if (pipeline_.has_history()) {
            one.before = before(i);
            one.hash = content_hash(one.hash + "\nbefore " + one.before);
        }
        const std::lock_guard guard(mutex_);
        known_[i] = std::move(one);
    }
    return *known(index);
}

}  // namespace aftershade
