// Deep files whose every sample a test writes down.
#pragma once

#include "framework/file/exr_file.h"

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfDeepTiledOutputFile.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace aftershade::test {

/// Values of one sample, in the order of the channels.
using DeepValues = std::vector<float>;

/// One pixel after the other, each with its samples.
inline DeepImage deep_image(int width, const std::vector<std::string>& channels,
                            const std::vector<std::vector<DeepValues>>& pixels) {
    DeepImage image;
    image.width = width;
    image.height = int(pixels.size()) / width;
    for (const std::string& name : channels) image.channels.push_back({name});
    image.first.push_back(0);
    for (const std::vector<DeepValues>& samples : pixels) {
        for (const DeepValues& sample : samples)
            for (std::size_t c = 0; c < channels.size(); ++c) image.channels[c].floats.push_back(sample[c]);
        image.first.push_back(image.first.back() + std::uint32_t(samples.size()));
    }
    return image;
}

struct DeepFileOptions {
    int tile = 0;  ///< side of tiles; 0: scan lines
    Imf::Compression compression = Imf::ZIPS_COMPRESSION;
    int min_x = 0, min_y = 0;  ///< of the data window
};

inline void write_deep(const std::filesystem::path& path, const DeepImage& image,
                       const DeepFileOptions& options = {}) {
    const Imath::Box2i window({options.min_x, options.min_y},
                              {options.min_x + image.width - 1, options.min_y + image.height - 1});
    Imf::Header header(window, window);
    header.setType(options.tile > 0 ? Imf::DEEPTILE : Imf::DEEPSCANLINE);
    header.compression() = options.compression;
    if (options.tile > 0)
        header.setTileDescription(Imf::TileDescription(unsigned(options.tile), unsigned(options.tile)));
    const std::size_t width = std::size_t(image.width);
    const std::ptrdiff_t origin = options.min_x + std::ptrdiff_t(options.min_y) * image.width;
    std::vector<std::uint32_t> counts;
    for (std::size_t i = 0; i + 1 < image.first.size(); ++i)
        counts.push_back(image.first[i + 1] - image.first[i]);
    Imf::DeepFrameBuffer frame;
    frame.insertSampleCountSlice(
        Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data() - origin), 4, 4 * width));
    std::vector<std::vector<const char*>> pointers(image.channels.size());
    for (std::size_t c = 0; c < image.channels.size(); ++c) {
        const DeepImage::Channel& channel = image.channels[c];
        const bool is_uint = !channel.uints.empty();
        const Imf::PixelType type = is_uint ? Imf::UINT : Imf::FLOAT;
        header.channels().insert(channel.name, Imf::Channel(type));
        for (std::size_t i = 0; i < counts.size(); ++i)
            pointers[c].push_back((is_uint ? reinterpret_cast<const char*>(channel.uints.data())
                                           : reinterpret_cast<const char*>(channel.floats.data())) +
                                  4 * image.first[i]);
        frame.insert(channel.name, Imf::DeepSlice(type, reinterpret_cast<char*>(pointers[c].data() - origin),
                                                  sizeof(char*), sizeof(char*) * width, 4));
    }
    if (options.tile > 0) {
        Imf::DeepTiledOutputFile file(path.c_str(), header);
        file.setFrameBuffer(frame);
        file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
        return;
    }
    Imf::DeepScanLineOutputFile file(path.c_str(), header);
    file.setFrameBuffer(frame);
    file.writePixels(image.height);
}

}  // namespace aftershade::test
