#include "framework/image/role.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace aftershade {
namespace {

TEST(Role, TableIsThatOfTheConventions) {
    struct Row {
        std::string name;
        int channels;
        bool filterable;
        std::vector<std::string> native;
        PixelType stored;
    };
    // docs/conventions.md, "Roles".
    const std::vector<Row> rows = {
        {"color", 4, true, {"R", "G", "B", "A"}, PixelType::half},
        {"depth", 1, false, {"Z"}, PixelType::float32},
        {"velocity", 2, false, {"velocity.X", "velocity.Y"}, PixelType::float32},
        {"velocity_next", 2, false, {"velocity_next.X", "velocity_next.Y"}, PixelType::float32},
        {"irradiance", 3, true, {"irradiance.R", "irradiance.G", "irradiance.B"}, PixelType::half},
        {"albedo", 3, true, {"albedo.R", "albedo.G", "albedo.B"}, PixelType::half},
        {"specular", 3, true, {"specular.R", "specular.G", "specular.B"}, PixelType::half},
        {"emission", 3, true, {"emission.R", "emission.G", "emission.B"}, PixelType::half},
        {"normal", 3, true, {"normal.X", "normal.Y", "normal.Z"}, PixelType::float32},
        {"position", 3, false, {"position.X", "position.Y", "position.Z"}, PixelType::float32},
        {"object_id", 1, false, {"object_id.I"}, PixelType::uint32},
        {"mask", 1, true, {"mask.V"}, PixelType::half},
        {"display", 4, true, {"display.R", "display.G", "display.B", "display.A"}, PixelType::half},
    };
    ASSERT_EQ(channel_roles().size(), rows.size());
    for (const Row& row : rows) {
        const auto role = find_role(row.name);
        ASSERT_TRUE(role.has_value()) << row.name;
        EXPECT_EQ(role->channels, row.channels) << row.name;
        EXPECT_EQ(role->filterable, row.filterable) << row.name;
        EXPECT_EQ(role->native_channels, row.native) << row.name;
        EXPECT_EQ(role->pixel_type, row.stored) << row.name;
        const bool is_id = row.name == "object_id";
        EXPECT_EQ(role->type, is_id ? ComponentType::uint32 : ComponentType::float32) << row.name;
        if (row.name == "depth") EXPECT_TRUE(std::isinf(role->outside) && role->outside > 0);
        else EXPECT_EQ(role->outside, 0.0f) << row.name;
    }
}

TEST(Role, OfAnUnknownNameIsNone) {
    for (const char* name : {"", "colour", "Color", "Z", "aov:", "aov"})
        EXPECT_FALSE(find_role(name).has_value()) << name;
    EXPECT_EQ(role_names().size(), channel_roles().size());
}

TEST(Role, OfAnAovHasItsOwnChannels) {
    const auto role = find_role("aov:mist");
    ASSERT_TRUE(role.has_value());
    EXPECT_EQ(role->name, "aov:mist");
    EXPECT_EQ(role->native_channels, (std::vector<std::string>{"mist.R", "mist.G", "mist.B", "mist.A"}));
}

TEST(Role, NamesShareNoChannel) {
    std::set<std::string> seen;
    for (const ChannelRole& role : channel_roles())
        for (const std::string& channel : role.native_channels)
            EXPECT_TRUE(seen.insert(channel).second) << channel;
}

}  // namespace
}  // namespace aftershade
