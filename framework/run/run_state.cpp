#include "framework/run/run_state.h"

#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/capture/frame_range.h"

namespace aftershade {

namespace fs = std::filesystem;

RunState run_state(const std::string& pattern) {
    const fs::path path = FramePattern(pattern).with("#");
    const std::string name = path.filename().string();
    constexpr std::size_t kDigits = 16;  // one of 2^64: a folder's outputs do not meet
    return {path.has_parent_path() ? path.parent_path() : fs::path("."), name,
            content_hash(name).substr(0, kDigits)};
}

void make_state_folder(const RunState& state) {
    std::error_code failure;
    fs::create_directories(state.folder, failure);
    try {
        make_folder_below(state.folder, ".aftershade");
    } catch (const Error& error) {
        throw Error(ErrorKind::output, std::string(error.what()) +
                                           " (runs of several frames keep their journal "
                                           "there; " +
                                           spelled(Option::no_journal) + " does without)");
    }
}

}  // namespace aftershade
