#include <algorithm>
#include <set>
#include <utility>

#include "framework/image/capture_internal.h"
#include "framework/image/decode.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// One float channel of an interleaved image.
Image component_of(const Image& image, int component) {
    Image plane(image.width(), image.height(), 1);
    const std::size_t channels = std::size_t(image.channels());
    for (std::size_t i = 0; i < plane.floats().size(); ++i)
        plane.floats()[i] = image.floats()[i * channels + std::size_t(component)];
    return plane;
}

Image floats_of_ids(const Image& ids) {
    Image floats(ids.width(), ids.height(), 1);
    std::transform(ids.uints().begin(), ids.uints().end(), floats.floats().begin(),
                   [](auto id) { return float(id); });
    return floats;
}

}  // namespace

bool is_color_role(const std::string& role) {
    static const std::set<std::string> roles = {"color", "irradiance", "albedo", "specular", "emission"};
    return roles.contains(role);
}

/// The role's image as the file stores it: one image per stored channel.
std::map<std::string, Image> CaptureReader::encode_role(const OpenFrame& open, const std::string& name,
                                                        const Image& canonical) const {
    std::map<std::string, Image> stored;
    const RoleSource& source = open.roles.at(name);
    if (source.channels.empty() || source.file != open.main.get()) return stored;
    const CaptureHeader& header = open.header;
    if (find_role(name)->type == ComponentType::uint32) {
        const std::string& channel = source.channels[0][0];
        const bool as_uint = source.file->type_of(channel) == PixelType::uint32;
        stored.emplace(channel, as_uint ? canonical : floats_of_ids(canonical));
        return stored;
    }
    Image image = canonical;
    Image color;
    Capture unused;
    if (source.decoding.premultiplied && open.roles.contains("color"))
        color = read_role(open, "color", nullptr, unused);
    const DecodeContext context{header.path.string(), header.data_window, header.display_window,
                                header.camera, color.empty() ? nullptr : &color};
    if (is_color_role(name) && open.stored_primaries != header.primaries)
        convert_colors(image, conversion_matrix(header.primaries, open.stored_primaries));
    if (name == "depth") encode_depth(image, source.decoding, context);
    if (name == "velocity" || name == "velocity_next") encode_velocity(image, source.decoding, context);
    // A sum of layers cannot be taken apart again: the first holds all of it.
    for (std::size_t layer = 0; layer < source.channels.size(); ++layer)
        for (std::size_t c = 0; c < source.channels[layer].size(); ++c)
            if (const std::string& channel = source.channels[layer][c]; !channel.empty())
                stored.emplace(channel, layer == 0 ? component_of(image, int(c))
                                                   : Image(image.width(), image.height(), 1));
    return stored;
}

std::map<std::string, RoleDecoding> CaptureReader::decodings(int frame) const {
    std::map<std::string, RoleDecoding> decodings;
    for (const auto& [role, source] : open(frame).roles) decodings[role] = source.decoding;
    return decodings;
}

std::vector<StoredChannel> CaptureReader::read_stored_channels(
    int frame, const std::map<std::string, const Image*>& changed) const {
    const OpenFrame open = this->open(frame);
    std::map<std::string, Image> encoded;
    for (const auto& [role, image] : changed)
        if (open.roles.contains(role)) encoded.merge(encode_role(open, role, *image));

    std::vector<StoredChannel> channels;
    const Window& grid = open.header.data_window;
    for (const ExrChannel& channel : open.main->merged().channels) {
        StoredChannel stored{channel.name, channel.type, {}};
        const std::vector<std::string> one{channel.name};
        if (const auto replaced = encoded.find(channel.name); replaced != encoded.end())
            stored.image = std::move(replaced->second);
        else if (channel.type == PixelType::uint32) stored.image = open.main->read_uints(one, grid);
        else stored.image = open.main->read_floats(one, grid, 0);
        channels.push_back(std::move(stored));
    }
    return channels;
}

}  // namespace aftershade
