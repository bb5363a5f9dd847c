#include "framework/run/exr_output.h"

#include <algorithm>
#include <deque>
#include <set>
#include <utility>

#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/capture/camera_metadata.h"
#include "framework/file/exr_loss.h"
#include "framework/image/role.h"
#include "framework/image/window.h"

namespace aftershade {

namespace {

/// Channels and, where they are not the result's or the capture's, the images behind them.
struct ExrContent {
    std::vector<ExrOutputChannel> channels;
    std::deque<Image> images;               // its elements stay where they are
    std::map<const Image*, float> outside;  // beyond the data window; 0 for those that are not here
    std::set<std::string> pictures;         // channels that may lose bits
};

/// What an AOV holds is for the user to know.
bool is_picture_role(const std::string& role) {
    const RoleKind kind = kind_of_role(role);
    return kind == RoleKind::light || kind == RoleKind::display || kind == RoleKind::other;
}

void add_role(ExrContent& content, const ChannelRole& role, const Image& image, PixelType color_type) {
    content.outside[&image] = role.outside;
    const PixelType type = role.pixel_type == PixelType::half ? color_type : role.pixel_type;
    const bool is_picture = is_picture_role(role.name);
    // An AOV may have fewer channels than its role.
    for (int c = 0; c < std::min(role.channels, image.channels()); ++c) {
        const std::string& name = role.native_channels[std::size_t(c)];
        content.channels.push_back({name, type, &image, c});
        if (is_picture) content.pictures.insert(name);
    }
}

/// Roles of which a step made another image than the capture's.
std::map<std::string, const Image*> changed_roles(const FrameResult& result) {
    std::map<std::string, const Image*> changed;
    for (const auto& [role, image] : result.images) changed[role] = &image;
    return changed;
}

void add_stored_channels(ExrContent& content, const FrameResult& result, const Capture& capture,
                         const CaptureReader& reader) {
    for (StoredChannel& stored :
         reader.read_stored_channels(capture.header.source_frame, changed_roles(result))) {
        content.images.push_back(std::move(stored.image));
        content.channels.push_back({stored.name, stored.type, &content.images.back(), 0});
    }
    for (const auto& [role, image] : result.images)
        if (const auto names = capture.header.role_channels.find(role);
            names != capture.header.role_channels.end() && is_picture_role(role))
            content.pictures.insert(names->second.begin(), names->second.end());
}

/// Makes room for a role's native names: what a step or another file says goes before what the main file
/// stores.
void drop_channels(ExrContent& content, const std::vector<std::string>& names) {
    std::erase_if(content.channels, [&](const ExrOutputChannel& channel) {
        return std::find(names.begin(), names.end(), channel.name) != names.end();
    });
}

void crop(ExrContent& content, const Window& from, const Window& to) {
    std::map<const Image*, const Image*> cropped;
    for (ExrOutputChannel& channel : content.channels) {
        const Image*& image = cropped[channel.image];
        if (!image) {
            content.images.push_back(
                place_in_window(*channel.image, from, to, content.outside[channel.image]));
            image = &content.images.back();
        }
        channel.image = image;
    }
}

bool is_id_channel(const ExrOutputChannel& channel, const CaptureHeader& header) {
    const auto holds = [&](const auto& role) {
        return kind_of_role(role.first) == RoleKind::id &&
               std::find(role.second.begin(), role.second.end(), channel.name) != role.second.end();
    };
    const bool is_role = std::any_of(header.role_channels.begin(), header.role_channels.end(), holds);
    return is_role || channel.type == PixelType::uint32 || channel.name.find("Crypto") != std::string::npos;
}

/// Of colours that a step has converted. An unknown id counts before the file's chromaticities, which say no
/// curve.
void name_converted_space(ExrWriteOptions& write, const ColorEncoding& color) {
    write.left_behind = color_space_attributes();
    const std::string id = color_interop_id(color);
    write.attributes["colorInteropID"] = id.empty() ? "unknown" : id;
    if (color.is_color())
        write.attributes["chromaticities"] =
            std::vector<float>(color.primaries.begin(), color.primaries.end());
    else write.left_behind.emplace_back("chromaticities");
}

/// An attribute of the input's pixels is not always true of the output's: kept channels stay as they are
/// stored, and all others are light. Where the space is assumed, nothing is added to what the file says.
void name_color_space(ExrWriteOptions& write, const OutputOptions& options, const CaptureHeader& header,
                      const std::optional<ColorEncoding>& color) {
    if (color && !options.keep_channels) return name_converted_space(write, *color);
    const ColorEncoding light{header.primaries, ColorEncoding::Curve::linear, 1};
    const ColorEncoding& written = options.keep_channels ? header.stored_colors.encoding : light;
    // A file without the attribute is Rec. 709, so colours of other primaries must say so.
    if (written.primaries != stored_primaries(header.metadata))
        write.attributes["chromaticities"] =
            std::vector<float>(written.primaries.begin(), written.primaries.end());
    const bool has_light =
        options.keep_channels || std::ranges::any_of(options.roles, [](const std::string& role) {
            return kind_of_role(role) == RoleKind::light;
        });
    if (!header.stored_colors.is_known()) return;
    write.left_behind = color_space_attributes();
    if (const std::string id = color_interop_id(written); has_light && !id.empty())
        write.attributes["colorInteropID"] = id;
}

/// A user who chooses a lossy compression accepts the loss in pictures. A run must not alter data, or
/// channels that are kept bit for bit: the next id is another object.
void refuse_lossy_data(const std::filesystem::path& path, const ExrContent& content,
                       const CaptureHeader& header, const OutputOptions& options) {
    for (const ExrOutputChannel& channel : content.channels) {
        if (!loses_bits(options.compression, channel.name, channel.type)) continue;
        const bool is_id = is_id_channel(channel, header);
        if (!is_id && content.pictures.contains(channel.name)) continue;
        throw Error(ErrorKind::output,
                    path.string() + ": the compression " + options.compression +
                        " loses bits of the channel '" + channel.name + "', which " +
                        (is_id                   ? std::string("holds ids")
                         : options.keep_channels ? spelled(Option::keep_channels) + " keeps bit for bit"
                                                 : "holds data") +
                        " (choose zip, zips, piz, rle or none)");
    }
}

/// A file names one space, and the channels that are kept stay in the capture's.
void refuse_kept_beside_converted(const FrameResult& result, const Capture& capture,
                                  const OutputOptions& options) {
    const std::string own = color_interop_id({capture.header.primaries, ColorEncoding::Curve::linear, 1});
    if (!options.keep_channels || !result.color_encoding ||
        (!own.empty() && color_interop_id(*result.color_encoding) == own))
        return;
    throw Error(ErrorKind::output, capture.header.path.string() + ": " + spelled(Option::keep_channels) +
                                       " keeps channels in the capture's color space, and the look converts "
                                       "'color' to another, but a file names one space: convert back at the "
                                       "end of the look, or write without " +
                                       spelled(Option::keep_channels));
}

std::string overflow_text(const std::filesystem::path& path, const OutputOptions& options, int frame,
                          const std::vector<HalfOverflow>& overflows) {
    if (overflows.empty()) return "";
    std::size_t values = 0;
    std::vector<std::string> channels;
    for (const HalfOverflow& overflow : overflows) {
        values += overflow.values;
        channels.push_back(overflow.channel);
    }
    return "frame " + std::to_string(frame) + ": " + path.string() + ": " + std::to_string(values) +
           (values == 1 ? " value" : " values") + " of " + list_of_names(channels, "and") +
           " above 65504, the largest half, became infinite (write floats: " +
           spelled(Option::pixel_type, "float") +
           (options.keep_channels ? " without " + spelled(Option::keep_channels) : "") +
           "; or lower the exposure)";
}

}  // namespace

const Image* find_image(const std::string& role, const FrameResult& result, const Capture& capture) {
    if (const auto made = result.images.find(role); made != result.images.end()) return &made->second;
    if (const auto captured = capture.images.find(role); captured != capture.images.end())
        return &captured->second;
    return nullptr;
}

ExrWriteOptions exr_write_options(const OutputOptions& options, const CaptureHeader& header,
                                  const std::optional<ColorEncoding>& color) {
    ExrWriteOptions write;
    write.data_window = header.data_window;
    write.display_window = header.display_window;
    write.pixel_aspect = header.pixel_aspect;
    write.compression = options.compression;
    write.carry_over = header.metadata;
    write.attributes["aftershade/look"] = options.look;
    write.attributes["aftershade/renderer"] = options.renderer;
    if (!options.fingerprint.empty()) write.attributes[kFingerprintName] = options.fingerprint;
    write.attributes["aftershade/profile"] = header.profile;
    write.attributes["aftershade/channels"] = std::string(options.keep_channels ? "kept" : "native");
    write.attributes["aftershade/frame"] = header.frame;
    add_attributes(header.camera, header.lights, write.attributes);
    name_color_space(write, options, header, color);
    return write;
}

namespace {

std::string roles_there(const std::vector<std::string>& roles) {
    return roles.empty() ? "" : "; the capture has " + list_of_names(roles, "and");
}

}  // namespace

std::string write_exr_output(const std::filesystem::path& path, const OutputOptions& options,
                             const FrameResult& result, const Capture& capture, const CaptureReader& reader) {
    refuse_kept_beside_converted(result, capture, options);
    ExrContent content;
    const auto& source_channels = capture.header.role_channels;
    if (options.keep_channels) add_stored_channels(content, result, capture, reader);
    for (const std::string& name : options.roles) {
        const bool is_kept = source_channels.contains(name) && !capture.header.derived_roles.contains(name);
        if (options.keep_channels && is_kept) continue;
        const Image* image = find_image(name, result, capture);
        if (!image)
            throw Error(ErrorKind::capture,
                        capture.header.path.string() + ": the role '" + name +
                            "', requested in the output, is in neither the capture nor the look" +
                            roles_there(capture.header.roles));
        drop_channels(content, find_role(name)->native_channels);
        add_role(content, *find_role(name), *image, options.color_type);
    }
    const bool has_color = std::ranges::find(options.roles, kColorRole) != options.roles.end();
    ExrWriteOptions write =
        exr_write_options(options, capture.header, has_color ? result.color_encoding : std::nullopt);
    refuse_lossy_data(path, content, capture.header, options);
    if (options.crop_to_display) {
        crop(content, write.data_window, write.display_window);
        write.data_window = write.display_window;
    }
    return overflow_text(path, options, capture.header.frame, write_exr(path, content.channels, write));
}

}  // namespace aftershade
