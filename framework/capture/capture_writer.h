// Captures as files, under the conventions of any producer that a profile describes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "framework/capture/light.h"
#include "framework/file/exr_file.h"

namespace aftershade {

struct CaptureWriteOptions {
    std::string compression = "zip";  ///< a lossless one, for the sake of ids
    double fps = 0;                   ///< attribute framesPerSecond; 0: none
    std::map<std::string, ExrValue> attributes{};
};

/// Writes one frame of floats by rename: every role of `capture.images` that the profile can store, under the
/// profile's channel names and in its units; of a sum of layers the first holds all and the others 0.
/// "{layer}" becomes "ViewLayer". With it go the attribute by which the profile is detected, the camera
/// (aftershade/camera/..., OpenEXR's own names, both matrices), aftershade/jitter_px, aftershade/lights and
/// chromaticities. Returns the roles that the profile has no way to store. Throws Error(ErrorKind::output).
std::vector<std::string> write_capture(const std::filesystem::path& path, const Capture& capture,
                                       const Profile& profile, const CaptureWriteOptions& options);

/// Writes one deep frame with the native channels that `image` has, and the same attributes as
/// write_capture() of the profile native. Compression other than none and rle becomes zips. Throws
/// Error(ErrorKind::output).
void write_deep_capture(const std::filesystem::path& path, const DeepImage& image,
                        const CaptureHeader& header, const CaptureWriteOptions& options);

/// The capture.json of a sequence. Its camera and lights override those of the frames' headers, so they hold
/// only values that are the same in all frames.
struct CaptureDocument {
    std::string frames = "gbuffer_####.exr";
    std::vector<int> frame_numbers;
    double fps = 24;
    std::string profile = "native";
    std::map<std::string, double> camera;  ///< by field, in the field's unit
    std::string lens_model;
    std::vector<CaptureLight> lights;
    std::map<std::string, unsigned> objects;  ///< numbers in object_id
    std::vector<int> cuts;
    int subframes = 1;
    std::vector<std::string> layers_behind;  ///< patterns; `frames` are the first layer's
};

/// By rename. Throws Error(ErrorKind::output).
void write_capture_document(const std::filesystem::path& path, const CaptureDocument& document);

}  // namespace aftershade
