#include "framework/serve/served_capture.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/serve/http_message.h"

namespace aftershade::serve {

namespace fs = std::filesystem;

std::vector<fs::path> folders_of(const Sequence& sequence) {
    std::vector<fs::path> folders;
    for (const int frame : sequence.frames) {
        fs::path folder = sequence.path_of(sequence.file_number(frame)).parent_path();
        if (std::ranges::find(folders, folder) == folders.end()) folders.push_back(std::move(folder));
    }
    return folders;
}

ServedCaptures::ServedCaptures(ServedCapture first, Open open)
    : folders_(folders_of(first.sequence)),
      open_(std::move(open)),
      now_(std::make_shared<const ServedCapture>(std::move(first))) {}

std::shared_ptr<const ServedCapture> ServedCaptures::now() const {
    const std::lock_guard lock(mutex_);
    return now_;
}

std::vector<fs::path> ServedCaptures::found(const std::string& name,
                                            std::optional<std::uint64_t> bytes) const {
    constexpr int kDeepest = 4, kMostEntries = 20'000;  // a drop answers within a second on a slow disk, too
    std::vector<fs::path> places;
    std::error_code failure;
    int entries = 0;
    for (const fs::path& folder : folders_) {
        const fs::path start = folder.empty() ? "." : folder;
        if (!bytes && fs::weakly_canonical(start, failure).filename() == name) places.push_back(start);
        fs::recursive_directory_iterator at(start, fs::directory_options::skip_permission_denied, failure);
        for (; !failure && at != fs::recursive_directory_iterator(); at.increment(failure)) {
            if (++entries > kMostEntries) return places;
            if (at.depth() >= kDeepest) at.disable_recursion_pending();
            const fs::file_status status = at->symlink_status(failure);
            if (at->path().filename() != name) continue;
            const bool is_it = bytes ? fs::is_regular_file(status) && at->file_size(failure) == *bytes
                                     : fs::is_directory(status);
            if (is_it) places.push_back(at->path());
        }
    }
    return places;
}

void ServedCaptures::take(const std::string& name, std::optional<std::uint64_t> bytes) {
    const std::vector<fs::path> places = found(name, bytes);
    std::vector<std::string> texts;
    for (const fs::path& folder : folders_) texts.push_back(fs::absolute(folder).lexically_normal().string());
    if (places.empty())
        throw Refusal{403, "'" + name + "' is not in " + list_of_names(texts) +
                               " or below, where this server may read; start `aftershade serve` with it"};
    if (places.size() > 1) {
        texts.clear();
        for (const fs::path& place : places) texts.push_back(place.string());
        throw Refusal{409, "'" + name + "' may be " + list_of_names(texts) +
                               "; start `aftershade serve` with the one you mean"};
    }
    auto taken = std::make_shared<const ServedCapture>(open_(places.front().string()));
    const std::lock_guard lock(mutex_);
    now_ = std::move(taken);
}

}  // namespace aftershade::serve
