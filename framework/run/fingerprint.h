// A hash of everything that an output frame's pixels depend on: equal fingerprints mean equal pixels.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "framework/effect/native/native_library.h"
#include "framework/look/look.h"
#include "framework/run/frame_files.h"
#include "framework/run/run_options.h"

namespace aftershade {

/// Hashes by what they are of, in words for messages: "look", "effect bokeh", "input gbuffer_0004.exr".
using FingerprintParts = std::map<std::string, std::string>;

/// All parts as one hash of 32 hexadecimal digits.
std::string hash_of_parts(const FingerprintParts& parts);

/// "look and effect bokeh changed": the parts that differ, at most three by name.
std::string difference_of_parts(const FingerprintParts& before, const FingerprintParts& now);

/// Inputs of the fingerprint that all frames of a run share. [refers to what the caller keeps]
struct FingerprintSource {
    const Look& look;
    const Pipeline& pipeline;
    const Sequence& sequence;
    const RunOptions& run;
    const OutputOptions& outputs;
    std::optional<std::filesystem::path> capture_document;
    std::vector<std::filesystem::path> profiles;  ///< documents of those that a frame may be read by
    std::string renderer;                         ///< GL_RENDERER and GL_VERSION
    std::filesystem::path glsl_folder;
    NativeRegistry* natives = nullptr;
};

/// The program's version, the renderer, the look's documents, the values of its steps, the files that these
/// name, its effects and plug-ins by content, the options of outputs that change pixels, capture.json except
/// its list of frames, profiles, and the decisions by the first frame. Throws
/// Error(ErrorKind::usage) for a file that cannot be read.
FingerprintParts setup_parts(const FingerprintSource& source, const CaptureReader& reader);

/// One frame's.
struct FrameFingerprint {
    std::string hash;         ///< of the setup, the frame's own inputs and `before`
    FingerprintParts inputs;  ///< by file name; "absent" for a file that would be read if it were there,
                              ///< "unreadable" for one that cannot be read
    /// For a look with history: the fingerprint of the previous frame, or kBegin.
    std::string before;
    static constexpr const char* kBegin = "begin";
};

/// The frames of one run, worked out on demand: each reads its input files whole, once. [thread-
/// safe; refers to the sequence, reader and pipeline]
class FrameFingerprints {
public:
    /// `setup` is hash_of_parts(setup_parts()). `run` is the whole run, before any frame was left out of it.
    FrameFingerprints(std::string setup, const Sequence& sequence, const CaptureReader& reader,
                      const Pipeline& pipeline, RunOptions run);

    /// The index-th frame of the run has this fingerprint. Throws Error(ErrorKind::usage) for a damaged
    /// history.
    FrameFingerprint of(std::size_t index);
    /// The frame has no pixels, so history restarts behind it.
    void mark_failed(std::size_t index);
    /// Whether the frame's history does not come from the frame before it in the run.
    bool begins_history(std::size_t index) const;
    /// The frame that stands for a missing one, with MissingFrame::hold; the frame itself otherwise.
    std::size_t shown_index(std::size_t index) const;

private:
    FrameFingerprint own(std::size_t index);
    std::string before(std::size_t index);
    const std::string& content_of(const std::filesystem::path& file);

    std::string setup_;
    const Pipeline& pipeline_;
    RunOptions run_;
    FrameFiles files_;
    bool reads_motion_ = false;
    std::map<std::size_t, FrameFingerprint> known_;
    std::set<std::size_t> failed_;
    std::map<std::filesystem::path, std::string> contents_;
    mutable std::mutex mutex_;
};

}  // namespace aftershade
