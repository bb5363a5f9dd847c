#include "framework/capture/encode_role.h"

#include <algorithm>

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

std::map<std::string, Image> encode_role(const std::string& role, Image image, const RoleDecoding& decoding,
                                         const FoundChannels& channels, bool ids_as_uint,
                                         const DecodeContext& context) {
    std::map<std::string, Image> stored;
    const ChannelRole contract = *find_role(role);
    if (contract.type == ComponentType::uint32) {
        stored.emplace(channels[0][0], ids_as_uint ? std::move(image) : floats_of_ids(image));
        return stored;
    }
    if (contract.kind == RoleKind::distance) encode_depth(image, decoding, context);
    if (contract.kind == RoleKind::motion) encode_velocity(image, decoding, context);
    if (role == kIrradianceRole && decoding.scale != 1)
        for (float& value : image.floats()) value /= decoding.scale;
    if (decoding.times_albedo) multiply_by_albedo(image, *context.albedo, float(decoding.albedo_floor));
    for (std::size_t layer = 0; layer < channels.size(); ++layer)
        for (std::size_t c = 0; c < channels[layer].size(); ++c)
            if (const std::string& channel = channels[layer][c]; !channel.empty())
                stored.emplace(channel, layer == 0 ? component_of(image, int(c))
                                                   : Image(image.width(), image.height(), 1));
    return stored;
}

}  // namespace aftershade
