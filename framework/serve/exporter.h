// Writes the frames of a look as files, beside the page's pictures: images or a video.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// One run of the program.
struct ExportJob {
    std::filesystem::path look;         ///< its text as edited, in a file of the job's own
    std::filesystem::path look_folder;  ///< files that the look names begin here
    std::string capture;
    std::filesystem::path output;    ///< pattern or video
    std::vector<std::string> files;  ///< that the look may name, with links followed
    std::vector<int> frames;
};

/// Runs the job in a process of its own until `cancel`, and calls `frame_done` after each frame. Returns why
/// nothing whole was written; "" where all was.
using RunExport = std::function<std::string(const ExportJob& job, const std::function<void()>& frame_done,
                                            const std::atomic<bool>& cancel)>;

/// What is to be exported.
struct ExportRequest {
    std::string name;    ///< of the file, or of the images' folder, in the look's folder
    std::string format;  ///< "png", "exr", "mp4", "mov"
    std::string text;    ///< the look's
    std::vector<std::string> files;
    std::filesystem::path look_folder;
    std::string capture;
    std::vector<int> frames;
};

/// One export at a time. What it writes appears whole, under its name, or not at all: until then it lies in a
/// hidden folder beside, which is removed. [any thread]
class Exporter {
public:
    explicit Exporter(RunExport run) : run_(std::move(run)) {}
    /// Cancels.
    ~Exporter();
    Exporter(const Exporter&) = delete;
    Exporter& operator=(const Exporter&) = delete;

    /// Throws Refusal where one runs, for a name that is not one or is taken, and for a video without ffmpeg;
    /// and Error(ErrorKind::output) where the folder takes no file. Removes what a killed program left of an
    /// export.
    void start(const ExportRequest& request);
    void cancel() { cancel_ = true; }
    /// {"runs", "name", "done", "frames", "written": the path, "fault"}
    nlohmann::ordered_json state() const;

private:
    void work(const ExportJob& job, const std::string& text, const std::filesystem::path& folder,
              const std::filesystem::path& target);

    const RunExport run_;
    std::atomic<bool> cancel_ = false;
    std::thread thread_;  // of the last export

    mutable std::mutex mutex_;  // of what follows
    bool runs_ = false;
    std::string name_, written_, fault_;
    std::size_t done_ = 0, frames_ = 0;
};

}  // namespace aftershade::serve
