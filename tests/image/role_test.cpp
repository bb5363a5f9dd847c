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

TEST(RoleId, SaysTheLayerInItsName) {
    const RoleId back("layer12:aov:mist");
    EXPECT_EQ(back.layer(), 12);
    EXPECT_EQ(back.of_any_layer(), "aov:mist");
    EXPECT_EQ(back, RoleId::of_layer(12, "aov:mist"));
    EXPECT_EQ(find_role(back)->native_channels[0], "layer12.mist.R");
    for (const char* whole :
         {"color", "aov:layer1", "layer:color", "layer-1:color", "layer1 :color", "layer1"}) {
        EXPECT_EQ(RoleId(whole).layer(), -1) << whole;
        EXPECT_EQ(RoleId(whole).of_any_layer(), whole);
    }
    EXPECT_FALSE(find_role("layer1:colour")) << "a layer of no role";
}

TEST(RoleId, OfACoverageIsMadeOfObjectsAlone) {
    const std::vector<TableKey> objects = {{3, 7, ""}, {0, 0, "3"}};
    const RoleId role = RoleId::coverage(objects);
    EXPECT_EQ(role.objects(), objects);
    EXPECT_EQ(find_role(role)->kind, RoleKind::coverage);
    EXPECT_NE(role, RoleId::coverage(std::vector<TableKey>{{3, 7, ""}, {3, 3, ""}})) << "a name is no number";
    EXPECT_FALSE(find_role(role.name())) << "no document can name it";
}

TEST(Role, NamesShareNoChannel) {
    std::set<std::string> seen;
    for (const ChannelRole& role : channel_roles())
        for (const std::string& channel : role.native_channels)
            EXPECT_TRUE(seen.insert(channel).second) << channel;
}

}  // namespace
}  // namespace aftershade
