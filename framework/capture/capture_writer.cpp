#include "framework/capture/capture_writer.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/capture/camera_metadata.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/encode_role.h"
#include "framework/file/output_stream.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// The first alternative of "a|b?", with the layer's name put in.
std::string channel_name(std::string pattern) {
    pattern = pattern.substr(0, pattern.find('|'));
    if (pattern.ends_with('?')) pattern.pop_back();
    const std::string layer = "{layer}";
    if (const std::size_t at = pattern.find(layer); at != std::string::npos)
        pattern.replace(at, layer.size(), "ViewLayer");
    return pattern;
}

FoundChannels channel_names(const RoleDecoding& decoding, int channels) {
    FoundChannels names;
    for (const auto& layer : decoding.layers) {
        names.emplace_back();
        for (std::size_t c = 0; c < std::min(layer.size(), std::size_t(channels)); ++c)
            names.back().push_back(channel_name(layer[c]));
    }
    return names;
}

/// What makes detect_profile() choose the profile, where an attribute does.
void add_mark(const Profile& profile, std::map<std::string, ExrValue>& attributes) {
    if (profile.detect_attributes.empty()) return;
    const std::string& mark = profile.detect_attributes.front();
    const std::size_t equals = mark.find('=');
    std::string name = mark.substr(0, equals), text = "written by Aftershade";
    std::replace(name.begin(), name.end(), '*', '_');
    if (equals != std::string::npos) {
        const std::string wanted = mark.substr(equals + 1);
        const std::size_t star = wanted.find('*');
        text = star == std::string::npos ? wanted
                                         : wanted.substr(0, star) + ", " + text + wanted.substr(star + 1);
    }
    attributes.emplace(name, text);
}

bool shares_channels(const RoleDecoding& one, const RoleDecoding& other) {
    for (const auto& layer : one.layers)
        for (const std::string& name : layer)
            for (const auto& others : other.layers)
                if (std::find(others.begin(), others.end(), name) != others.end()) return true;
    return false;
}

void require_exact_ids(const std::filesystem::path& path, const Image& image, bool ids_as_uint) {
    constexpr std::uint32_t kLargestExactFloat = 1u << 24;
    if (image.type() != ComponentType::uint32 || ids_as_uint) return;
    const auto ids = image.uints();
    const auto largest = std::max_element(ids.begin(), ids.end());
    if (largest != ids.end() && *largest > kLargestExactFloat)
        throw Error(ErrorKind::output,
                    path.string() + ": object id " + std::to_string(*largest) +
                        " is above 16777216, which the profile's floats cannot hold; use native");
}

ExrWriteOptions write_options(const CaptureHeader& header, const Chromaticities& primaries,
                              const CaptureWriteOptions& options) {
    ExrWriteOptions write;
    write.data_window = header.data_window;
    write.display_window = header.display_window;
    write.pixel_aspect = header.pixel_aspect;
    write.compression = options.compression;
    write.attributes = options.attributes;
    add_attributes(header.camera, header.lights, write.attributes);
    write.attributes["chromaticities"] = std::vector<float>(primaries.begin(), primaries.end());
    if (const std::string id = color_interop_id({primaries, ColorEncoding::Curve::linear, 1}); !id.empty())
        write.attributes["colorInteropID"] = id;
    if (options.fps > 0) write.attributes["framesPerSecond"] = float(options.fps);
    return write;
}

}  // namespace

void write_deep_capture(const std::filesystem::path& path, const DeepImage& image,
                        const CaptureHeader& header, const CaptureWriteOptions& options) {
    ExrWriteOptions write = write_options(header, header.primaries, options);
    // Deep files have no other method; its level stays.
    if (const auto level = exr_compression_level(write.compression))
        write.compression = "zips:" + std::to_string(*level);
    else if (write.compression != "none" && write.compression != "rle") write.compression = "zips";
    write_deep_exr(path, image, write);
}

std::vector<std::string> write_capture(const std::filesystem::path& path, const Capture& capture,
                                       const Profile& profile, const CaptureWriteOptions& options) {
    const CaptureHeader& header = capture.header;
    const auto color = capture.images.find(kColorRole);
    DecodeContext context{path.string(), header.data_window, header.display_window, header.camera,
                          color == capture.images.end() ? nullptr : &color->second};
    const Chromaticities primaries =
        profile.color_space == "auto" ? header.primaries : *color_space_primaries(profile.color_space);
    const auto as_stored = [&](Image image) {
        if (primaries != header.primaries)
            convert_colors(image, conversion_matrix(header.primaries, primaries));
        return image;
    };
    Image albedo;
    if (const auto known = capture.images.find(kAlbedoRole); known != capture.images.end())
        albedo = as_stored(known->second);
    if (!albedo.empty()) context.albedo = &albedo;
    std::vector<std::string> left_out;
    std::map<std::string, Image> stored;
    const auto colors = profile.roles.find(std::string(kColorRole));
    for (const auto& [role, image] : capture.images) {
        const auto found = profile.roles.find(role.name());
        // Of producers with a file for each role several have the channels of color, which one file cannot
        // hold.
        const bool shares_colors = role != kColorRole && found != profile.roles.end() &&
                                   colors != profile.roles.end() &&
                                   shares_channels(found->second, colors->second);
        const bool lacks_albedo =
            found != profile.roles.end() && found->second.times_albedo && albedo.empty();
        if (found == profile.roles.end() || found->second.layers.empty() || shares_colors || lacks_albedo) {
            left_out.push_back(role.name());
            continue;
        }
        Image encoded = kind_of_role(role) == RoleKind::light ? as_stored(image) : image;
        // A producer that is not ours stores ids as floats, as every one of them does.
        const bool ids_as_uint = profile.id == "native";
        require_exact_ids(path, image, ids_as_uint);
        stored.merge(encode_role(role.name(), std::move(encoded), found->second,
                                 channel_names(found->second, image.channels()), ids_as_uint, context));
    }
    if (stored.empty())
        throw Error(ErrorKind::output,
                    path.string() + ": the profile '" + profile.id + "' stores none of the roles");
    std::vector<ExrOutputChannel> channels;
    for (const auto& [name, image] : stored)
        channels.push_back({name,
                            image.type() == ComponentType::uint32 ? PixelType::uint32 : PixelType::float32,
                            &image, 0});
    ExrWriteOptions write = write_options(header, primaries, options);
    add_mark(profile, write.attributes);
    write_exr(path, channels, write);
    return left_out;
}

void write_capture_document(const std::filesystem::path& path, const CaptureDocument& document) {
    nlohmann::ordered_json json = {{"aftershade", 1}, {"frames", document.frames}};
    std::string range;
    for (const int frame : document.frame_numbers)
        range += (range.empty() ? "" : ",") + std::to_string(frame);
    const auto& numbers = document.frame_numbers;
    const bool dense = numbers.size() > 2 && numbers.back() - numbers.front() + 1 == int(numbers.size()) &&
                       std::is_sorted(numbers.begin(), numbers.end());
    json["range"] = dense ? std::to_string(numbers.front()) + "-" + std::to_string(numbers.back()) : range;
    json["fps"] = document.fps;
    json["profile"] = document.profile;
    if (!document.camera.empty()) json["camera"] = document.camera;
    if (!document.lens_model.empty()) json["camera"]["lens_model"] = document.lens_model;
    if (!document.lights.empty())
        json["lights"] = nlohmann::ordered_json::parse(format_lights(document.lights));
    if (!document.layers_behind.empty()) json["layers"] = {nlohmann::ordered_json::object()};
    for (const std::string& frames : document.layers_behind) json["layers"].push_back({{"frames", frames}});
    if (!document.objects.empty()) json["objects"] = document.objects;
    json["cuts"] = document.cuts;
    json["subframes"] = document.subframes;
    const std::string text = json.dump(2) + "\n";
    OutputStream out(path);
    out.write(text.data(), text.size());
    out.commit();
}

}  // namespace aftershade
