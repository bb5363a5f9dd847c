// Small captures whose every stored value a test writes down, with the profile that reads them.
#pragma once

#include <deque>
#include <map>
#include <string>
#include <vector>

#include "framework/capture/capture.h"
#include "tests/documents.h"
#include "tests/file/image_files.h"

namespace aftershade::test {

/// One stored channel, row by row.
struct StoredChannel {
    std::string name;
    std::vector<float> values;
    PixelType type = PixelType::float32;
};

inline void write_channels(const std::filesystem::path& path, int width,
                           const std::vector<StoredChannel>& channels,
                           std::map<std::string, ExrValue> attributes = {}) {
    const int height = int(channels.front().values.size()) / width;
    std::deque<Image> images;  // the channels point at them
    std::vector<ExrOutputChannel> stored;
    for (const StoredChannel& channel : channels) {
        const bool is_uint = channel.type == PixelType::uint32;
        Image& image =
            images.emplace_back(width, height, 1, is_uint ? ComponentType::uint32 : ComponentType::float32);
        for (std::size_t i = 0; i < channel.values.size(); ++i) {
            if (is_uint) image.uints()[i] = std::uint32_t(channel.values[i]);
            else image.floats()[i] = channel.values[i];
        }
        stored.push_back({channel.name, channel.type, &image, 0});
    }
    ExrWriteOptions options;
    options.data_window = options.display_window = {0, 0, width - 1, height - 1};
    options.attributes = std::move(attributes);
    write_exr(path, stored, options);
}

inline Profile profile_from(const std::string& json) {
    Diagnostics diagnostics;
    const auto profile = parse_profile(parsed(json), diagnostics);
    EXPECT_EQ(lines_of(diagnostics), Lines{}) << json;
    return profile.value_or(Profile{});
}

/// A profile "t" that names `roles` beside the color R, G, B.
inline Profile profile_of_roles(const std::string& roles) {
    return profile_from(
        R"({"aftershade": 1, "id": "t", "summary": ".", "detect": {"channels": ["R", "G", "B"]},
        "roles": {"color": {"channels": ["R", "G", "B", "A?"]})" +
        (roles.empty() ? "" : ", " + roles) + "}}");
}

inline Sequence sequence_of(const std::filesystem::path& file, const std::string& profile) {
    Sequence sequence;
    sequence.files = FramePattern(file.string());
    sequence.frames = {1};
    sequence.profile = profile;
    return sequence;
}

inline Image read_role(const std::string& role, const Profile& profile,
                       const std::vector<StoredChannel>& channels, int width = 0) {
    const TemporaryFolder folder;
    const int pixels = int(channels.front().values.size());
    write_channels(folder / "f.exr", width > 0 ? width : pixels, channels);
    const Sequence sequence = sequence_of(folder / "f.exr", profile.id);
    const CaptureReader reader(sequence, {profile}, {});
    const std::vector<std::string> roles = {role};
    return reader.read(1, roles).images.at(role);
}

/// The role of a file of one row, or of rows of `width`, that has R, G, B = 0 beside `channels`, read through
/// a profile that says `declaration` of it.
inline Image decoded(const std::string& role, const std::string& declaration,
                     std::vector<StoredChannel> channels, int width = 0) {
    const std::size_t pixels = channels.front().values.size();
    for (const char* name : {"R", "G", "B"})
        channels.push_back({name, std::vector<float>(pixels), PixelType::half});
    return read_role(role, profile_of_roles("\"" + role + "\": " + declaration), channels, width);
}

}  // namespace aftershade::test
