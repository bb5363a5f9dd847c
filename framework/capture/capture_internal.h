// Shared by the sources of CaptureReader; no other file includes it.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/capture/frame_file.h"

namespace aftershade {

/// Where one role's pixels lie and how they are decoded.
struct CaptureReader::RoleSource {
    const FrameFile* file = nullptr;
    RoleDecoding decoding;
    FoundChannels channels;  // empty for luminance and Cryptomatte
    /// Further channels that go by the role's names, where the file's names alone choose.
    std::vector<FoundChannels> others{};
    std::string luminance{};  // the Y channel that stands for color
    bool from_cryptomatte = false;
    StoredColors colors;  // of light
};

struct CaptureReader::OpenFrame {
    std::unique_ptr<FrameFile> main;
    std::map<std::string, std::unique_ptr<FrameFile>> role_files;
    const Profile* profile = nullptr;
    bool is_foreign_layer = false;  // the user chose a layer that the profile does not list
    std::map<std::string, RoleSource> roles;
    /// object_id as the file stores it, where a Cryptomatte has taken its place.
    std::optional<RoleSource> ids_by_number;
    int layer = -1;  ///< of deep parts, that roles are read of; -1: the whole picture
    CaptureHeader header;
};

/// Decisions of a run's first frame for the other frames.
struct CaptureReader::FirstFrame {
    std::once_flag once;
    std::optional<CaptureHeader> header;            ///< nullopt where none can be read, or there is but one
    std::map<std::string, std::string> views;       ///< by role, of files of their own; "" for the main file
    std::map<std::string, FoundChannels> channels;  ///< by role
    std::map<std::string, RoleDecoding> decodings;  ///< likewise
    std::map<std::string, std::string> sources;     ///< by role, in words
    bool has_alpha = false;
    bool has_followers = false;  ///< there are other frames, beside further sub-frames of this one
    std::once_flag layers_once;
    std::vector<std::shared_ptr<FirstFrame>> layers;  ///< of a capture with layers
};

}  // namespace aftershade
