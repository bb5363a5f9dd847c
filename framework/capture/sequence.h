// Which frames there are, where they lie and how they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/capture/deep_layers.h"
#include "framework/capture/frame_range.h"
#include "framework/capture/light.h"
#include "framework/capture/profile.h"
#include "framework/image/camera.h"

namespace aftershade {

/// "cryptomatte": {"layer": "CryptoObject", "mask": ["Suzanne"]} of a capture.json.
struct CryptomatteChoice {
    std::string layer;              ///< "" for the only one
    std::vector<std::string> mask;  ///< objects whose coverage is the role `mask`; empty: none
};

/// One of "layers" of a capture.json: what it has of its own. The rest is the capture's; but who has files
/// has them all.
struct LayerSource {
    std::optional<FramePattern> files;
    std::map<std::string, FramePattern> role_files;
    std::map<std::string, RoleDecoding> channels;  ///< instead of the capture's, by role
    std::optional<std::string> profile, view, layer;
    std::optional<bool> alpha_is_opaque;
    bool is_held_out = false;  ///< what lies in front of it is cut out of it
};

/// Ordered captures. Made from a capture.json, a bare EXR file, a pattern of files, or a folder of them.
struct Sequence {
    std::vector<int> frames;       ///< in the order to be run
    bool frames_declared = false;  ///< by a capture.json's range or a bare file, not by what lies on disk
    /// All frames of the capture, even where only some are run. The first readable one decides how all are
    /// read (CaptureReader). If empty, `frames` has them all.
    std::vector<int> whole;
    FramePattern files{""};                          ///< absolute, or relative to the working directory
    std::map<std::string, FramePattern> role_files;  ///< roles that lie in files of their own
    std::map<std::string, RoleDecoding> channels;    ///< of capture.json, instead of the profile's
    std::string profile = "auto";
    std::string color_space = "auto";      ///< of the stored colours; auto: the profile's
    std::string view;                      ///< of multi-view files; "" for the default
    std::string layer;                     ///< of files with several layers; "" for the first
    bool alpha_is_opaque = false;          ///< the stored alpha of color means nothing: it is read as 1
    int deep_layers = kDefaultDeepLayers;  ///< most layers that deep pixels are reduced to
    std::vector<LayerSource> layers;       ///< front to back; empty: the files hold one picture
    double fps = 24;
    int subframes = 1;  ///< a frame is this many captures: the files subframes * frame + 0 .. subframes - 1
    Camera camera;      ///< of capture.json
    std::optional<std::vector<CaptureLight>> lights;  ///< of capture.json
    std::vector<int> cuts;                            ///< frames that begin a shot
    std::optional<CryptomatteChoice> cryptomatte;
    std::map<std::string, std::uint32_t> objects;  ///< of capture.json: names of the numbers in object_id
    /// Objects that the role object_id is requested for by name: it is read from the Cryptomatte that has
    /// them, or their numbers become the names' hashes.
    std::vector<std::string> object_names;

    /// The number in the name of a frame's file, by which a CaptureReader reads it.
    int file_number(int frame, int subframe = 0) const { return frame * subframes + subframe; }
    std::filesystem::path path_of(int file) const { return files.path(file); }
};

/// One layer as a sequence of its own.
Sequence sequence_of_layer(const Sequence& sequence, std::size_t layer);

/// The capture.json that CAPTURE of the command line names, by itself or by its folder.
std::optional<std::filesystem::path> capture_document(const std::string& argument);

/// `argument` is CAPTURE of the command line. Faults of capture.json go to `diagnostics`; a file, pattern or
/// folder that holds nothing is Error(ErrorKind::capture).
std::optional<Sequence> open_sequence(const std::string& argument, Diagnostics& diagnostics);

/// Every file that reading the sequence may open, whether it is there or not: those of its frames with their
/// sub-frames, roles and neighbours, and any other file on disk that matches its patterns.
std::vector<std::filesystem::path> files_of_sequence(const Sequence& sequence);

/// Adds "depth=z.####.exr" of Option::role.
void add_role_file(Sequence& sequence, const std::string& text, Diagnostics& diagnostics);

/// Frames that a list leaves out between its first and its last.
struct FrameGaps {
    int step = 1;              ///< of three frames or more: the largest that reaches each of them
    std::int64_t count = 0;    ///< of frames that are missing at this step
    std::vector<int> missing;  ///< empty where there are more than a hundred thousand
    std::vector<int> whole;    ///< the list with them; empty where `missing` is
};
/// `frames` are sorted.
FrameGaps find_gaps(std::span<const int> frames);

/// Frames that exist for a pattern, sorted.
std::vector<int> find_frames(const FramePattern& pattern);

/// Throws Error(ErrorKind::capture) where the disk has none of the sequence's frames: each would fail by
/// itself.
void require_some_file(const Sequence& sequence);

}  // namespace aftershade
