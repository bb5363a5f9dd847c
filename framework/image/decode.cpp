#include "framework/image/decode.h"

#include <cmath>
#include <limits>
#include <span>

#include "framework/core/error.h"

namespace aftershade {

namespace {

/// One layer, in the role's channel order; components that the file lacks are filled with 1 (alpha).
Image read_layer(const ExrFile& file, int part, const std::vector<std::string>& names) {
    std::vector<std::string> present;
    for (const std::string& name : names)
        if (!name.empty()) present.push_back(name);
    Image stored = file.read_floats(part, present);
    if (present.size() == names.size()) return stored;

    Image filled(stored.width(), stored.height(), int(names.size()));
    const std::size_t pixels = std::size_t(stored.width()) * std::size_t(stored.height());
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        std::size_t next = 0;
        for (std::size_t c = 0; c < names.size(); ++c) {
            const bool absent = names[c].empty();
            filled.floats()[pixel * names.size() + c] =
                absent ? 1.0f : stored.floats()[pixel * present.size() + next++];
        }
    }
    return filled;
}

bool is_uint_channel(const ExrFile& file, int part, const std::string& name) {
    for (const ExrChannel& channel : file.parts()[std::size_t(part)].channels)
        if (channel.name == name) return channel.type == PixelType::uint32;
    return false;
}

}  // namespace

void decode_depth(Image& depth, const RoleDecoding& decoding) {
    for (float& z : depth.floats())
        z = z >= decoding.no_hit ? std::numeric_limits<float>::infinity() : z * decoding.scale;
}

void decode_velocity(Image& velocity, const RoleDecoding& decoding) {
    const bool reversed =
        decoding.delta == VelocityDelta::prev_minus_cur || decoding.delta == VelocityDelta::cur_minus_next;
    const float x_sign = reversed ? -1.0f : 1.0f;
    const float y_sign = decoding.y_axis_up ? -x_sign : x_sign;
    const std::span<float> values = velocity.floats();
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
        values[i] = std::isfinite(values[i]) ? values[i] * x_sign : 0.0f;
        values[i + 1] = std::isfinite(values[i + 1]) ? values[i + 1] * y_sign : 0.0f;
    }
}

Image decode_ids(const Image& stored, const std::string& context) {
    constexpr float kLargest = 4294967040.0f;  // the last float below 2^32
    Image ids(stored.width(), stored.height(), 1, ComponentType::uint32);
    const std::span<const float> values = stored.floats();
    for (std::size_t i = 0; i < values.size(); ++i) {
        const float id = values[i];
        if (!(id >= 0 && id <= kLargest) || id != std::floor(id)) {
            const std::size_t width = std::size_t(stored.width());
            throw Error(ExitCode::capture, context + ": object id " + std::to_string(id) + " at pixel (" +
                                               std::to_string(i % width) + ", " + std::to_string(i / width) +
                                               ") is not a whole number from 0 to 4294967040");
        }
        ids.uints()[i] = std::uint32_t(id);
    }
    return ids;
}

Image decode_role(const ExrFile& file, int part, const ChannelRole& role, const RoleDecoding& decoding,
                  const FoundChannels& channels) {
    if (role.type == ComponentType::uint32) {
        if (is_uint_channel(file, part, channels[0][0])) return file.read_uints(part, channels[0]);
        return decode_ids(file.read_floats(part, channels[0]), file.path().string() + ": " + channels[0][0]);
    }
    Image image = read_layer(file, part, channels[0]);
    for (std::size_t i = 1; i < channels.size(); ++i) {
        const Image layer = read_layer(file, part, channels[i]);
        for (std::size_t j = 0; j < layer.floats().size(); ++j) image.floats()[j] += layer.floats()[j];
    }
    if (role.name == "depth") decode_depth(image, decoding);
    if (role.name == "velocity" || role.name == "velocity_next") decode_velocity(image, decoding);
    return image;
}

}  // namespace aftershade
