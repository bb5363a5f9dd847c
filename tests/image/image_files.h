// Files for the image tests: a folder that goes away, patterns, captures.
#pragma once

#include "framework/core/error.h"
#include "framework/image/exr_file.h"
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
std::string error_of(ExitCode code, Work&& work) {
    try {
        work();
    } catch (const Error& error) {
        EXPECT_EQ(int(error.exit_code()), int(code)) << error.what();
        return error.what();
    } catch (const std::exception& error) {
        ADD_FAILURE() << "another exception: " << error.what();
        return {};
    }
    ADD_FAILURE() << "no error";
    return {};
}

template <class Work>
std::string capture_error(Work&& work) {
    return error_of(ExitCode::capture, work);
}

inline std::vector<std::string> channel_names(const ExrPart& part) {
    std::vector<std::string> names;
    for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
    return names;
}

}  // namespace aftershade::test
