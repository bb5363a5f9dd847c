// Frames of a sequence that differ in their channels, layers and attributes.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/image/image.h"

namespace aftershade::test {

/// 16 x 9 px, whose n-th channel holds n / 10.
inline void write_tenths(const std::filesystem::path& path, const std::vector<std::string>& channels,
                         const std::map<std::string, ExrValue>& attributes = {}, float pixel_aspect = 1) {
    Image image(16, 9, int(channels.size()));
    for (std::size_t i = 0; i < image.floats().size(); ++i)
        image.floats()[i] = float(i % channels.size() + 1) / 10;
    std::vector<ExrOutputChannel> stored;
    for (std::size_t c = 0; c < channels.size(); ++c)
        stored.push_back({channels[c], PixelType::float32, &image, int(c)});
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, 15, 8};
    options.pixel_aspect = pixel_aspect;
    options.attributes = attributes;
    write_exr(path, stored, options);
}

/// The colours of Blender's view layers.
inline std::vector<std::string> view_layers(const std::vector<std::string>& names) {
    std::vector<std::string> channels;
    for (const std::string& name : names)
        for (const char* end : {".Combined.R", ".Combined.G", ".Combined.B", ".Combined.A"})
            channels.push_back(name + end);
    return channels;
}

inline const std::vector<float> kAcescgPrimaries = {.713f, .293f, .165f,   .83f,
                                                    .128f, .044f, .32168f, .33767f};

}  // namespace aftershade::test
