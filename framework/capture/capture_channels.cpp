#include <algorithm>
#include <utility>

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/encode_role.h"
#include "framework/file/exr_loss.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// Of deep samples: what has no mean.
bool is_deep_depth(const std::string& channel) {
    const std::string name = split_channel_name(channel).component;
    return name == "z" || name == "zback";
}

}  // namespace

/// The role's image as the file stores it: one image per stored channel.
std::map<std::string, Image> CaptureReader::encode_role(const OpenFrame& open, const std::string& name,
                                                        const Image& canonical) const {
    const RoleSource& source = open.roles.at(name);
    if (source.channels.empty() || source.file != open.main.get()) return {};
    const CaptureHeader& header = open.header;
    Image image = canonical;
    Image color;
    Capture unused;
    if (source.decoding.premultiplied && open.roles.contains(kColorRole))
        color = read_role(open, kColorRole, nullptr, unused);
    DecodeContext context{header.path.string(), header.data_window, header.display_window, header.camera,
                          color.empty() ? nullptr : &color};
    Image albedo;
    if (source.decoding.times_albedo) {
        albedo = read_stored_albedo(open);
        context.albedo = &albedo;
    }
    if (kind_of_role(name) == RoleKind::light) stored_of_light(image, source.colors, header.primaries);
    const bool ids_as_uint = source.file->type_of(source.channels[0][0]) == PixelType::uint32;
    auto stored = aftershade::encode_role(name, std::move(image), source.decoding, source.channels,
                                          ids_as_uint, context);
    if (const auto added = read_added_light(open, source))
        for (std::size_t c = 0; c < source.channels[0].size(); ++c) {
            const std::span<float> values = stored.at(source.channels[0][c]).floats();
            for (std::size_t i = 0; i < values.size(); ++i)
                values[i] -= added->floats()[i * source.channels[0].size() + c];
        }
    return stored;
}

std::map<std::string, RoleDecoding> CaptureReader::decodings(int frame) const {
    if (const auto front = front_layer()) return layer_reader(*front, 0).decodings(frame);
    std::map<std::string, RoleDecoding> decodings;
    for (const auto& [role, source] : open(frame).roles) decodings[role] = source.decoding;
    return decodings;
}

std::vector<StoredChannel> CaptureReader::read_stored_channels(
    int frame, const std::map<std::string, const Image*>& changed) const {
    if (!sequence_.layers.empty())
        throw Error(ErrorKind::usage, spelled(Option::keep_channels) +
                                          " writes the channels of one file, and the capture has " +
                                          std::to_string(sequence_.layers.size()) +
                                          " layers (choose roles with " + spelled(Option::output_roles) +
                                          ")");
    const OpenFrame open = this->open(frame);
    std::map<std::string, Image> encoded;
    for (const auto& [role, image] : changed)
        if (open.roles.contains(role)) encoded.merge(encode_role(open, role, *image));

    std::vector<StoredChannel> channels;
    const Window& grid = open.header.data_window;
    std::vector<FrameFile::Request> unchanged;
    for (const ExrChannel& channel : open.main->merged().channels)
        if (!encoded.contains(channel.name))
            unchanged.push_back(
                {{channel.name},
                 channel.type == PixelType::uint32 ? ComponentType::uint32 : ComponentType::float32});
    open.main->prefetch(unchanged);
    for (const ExrChannel& channel : open.main->merged().channels) {
        StoredChannel stored{channel.name, channel.type, {}};
        const std::vector<std::string> one{channel.name};
        if (const auto replaced = encoded.find(channel.name); replaced != encoded.end())
            stored.image = std::move(replaced->second);
        else if (channel.type == PixelType::uint32) stored.image = open.main->read_uints(one, grid);
        else stored.image = open.main->read_floats(one, grid, 0, {-1, !is_deep_depth(channel.name)});
        channels.push_back(std::move(stored));
    }
    return channels;
}

/// Pictures are compressed with loss by intent. A depth, a vector or an id that lost bits is another one.
void CaptureReader::find_losses(OpenFrame& open) {
    for (const auto& [role, source] : open.roles) {
        const RoleKind kind = kind_of_role(role);
        if (kind == RoleKind::light || kind == RoleKind::display || kind == RoleKind::other) continue;
        std::vector<std::string> lost;
        std::string compression;
        for (const std::vector<std::string>& layer : source.channels)
            for (const std::string& channel : layer) {
                if (channel.empty()) continue;
                const std::string& stored = source.file->compression_of(channel);
                if (!loses_bits(stored, channel, source.file->type_of(channel))) continue;
                lost.push_back(channel);
                compression = stored;
            }
        if (lost.empty()) continue;
        const bool is_own_file = source.file != open.main.get();
        open.header.warnings.push_back(role + " is read from " + list_of_names(lost, "and") +
                                       (is_own_file ? " of the role's own file" : "") +
                                       ", stored with loss (" + compression +
                                       "): its values are not exact (write them with zip, zips or piz)");
    }
}

}  // namespace aftershade
