// Files for the image tests: a folder that goes away, patterns, captures.
#pragma once

#include "framework/base/error.h"
#include "framework/file/exr_file.h"
#include "framework/image/image.h"
#include "tests/real_captures.h"
#include "tests/temporary_folder.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace aftershade::test {

/// Exactly representable in half.
inline float pattern(int x, int y, int channel) {
    return float((x * 7 + y * 13 + channel * 5) % 256) / 8.0f - 4.0f;
}

inline Image pattern_image(int width, int height, int channels) {
    Image image(width, height, channels);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            for (int c = 0; c < channels; ++c) image.at(x, y, c) = pattern(x, y, c);
        }
    }
    return image;
}

/// The message of the Error that `work` throws; the test fails where it throws none or one of another code.
template <class Work>
std::string error_of(ErrorKind code, Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(int(error.kind()), int(code)) << error.what();
        return error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << "another exception: " << error.what();
        return {};
    }
    ADD_FAILURE() << "no error";
    return {};
}

/// A grey PNG of 16 bits, 4 x 1 px: 0, 1, 256, 65535. Made by Python's zlib and struct.
inline std::string wide_png() {
    constexpr unsigned char bytes[] = {
        0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
        0x52, 0x00, 0x00, 0x00, 0x04, 0x00, 0x00, 0x00, 0x01, 0x10, 0x00, 0x00, 0x00, 0x00, 0x8c,
        0xc7, 0x8c, 0x52, 0x00, 0x00, 0x00, 0x11, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60,
        0x60, 0x60, 0x60, 0x64, 0x64, 0xf8, 0xff, 0x1f, 0x00, 0x03, 0x0f, 0x02, 0x01, 0x8e, 0x60,
        0xe4, 0xa5, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
    return {std::begin(bytes), std::end(bytes)};
}

template <class Work>
std::string capture_error(Work&& work) {
    return error_of(ErrorKind::capture, work);
}

inline std::vector<std::string> channel_names(const ExrPart& part) {
    std::vector<std::string> names;
    for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
    return names;
}

}  // namespace aftershade::test
