// The capture that the page shows: the one that the command names, or one below it that was dropped on the
// page.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"

namespace aftershade::serve {

struct ServedCapture {
    std::string name;  ///< CAPTURE of the command line
    Sequence sequence;
    CaptureHeader header;  ///< of the first frame
};

/// [any thread]
class ServedCaptures {
public:
    using Open = std::function<ServedCapture(const std::string& name)>;
    /// Only what lies in the folders of the first one's frames, or below, can take its place.
    ServedCaptures(ServedCapture first, Open open);

    std::shared_ptr<const ServedCapture> now() const;
    /// Takes what a page dropped: browsers tell the name of a file or a folder, and a file's size, but not
    /// where it lies. Links are not followed. Throws Refusal where there is none of the name, or several.
    void take(const std::string& name, std::optional<std::uint64_t> bytes);

private:
    std::vector<std::filesystem::path> found(const std::string& name,
                                             std::optional<std::uint64_t> bytes) const;

    std::vector<std::filesystem::path> folders_;
    Open open_;
    mutable std::mutex mutex_;  // of what follows
    std::shared_ptr<const ServedCapture> now_;
};

/// Folders of the frames of a sequence.
std::vector<std::filesystem::path> folders_of(const Sequence& sequence);

}  // namespace aftershade::serve
