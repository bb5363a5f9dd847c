#include "framework/base/option.h"
#include "framework/capture/capture_internal.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <span>
#include <utility>

#include "framework/base/error.h"
#include "framework/capture/bare_channels.h"
#include "framework/capture/camera_metadata.h"
#include "framework/capture/camera_motion.h"
#include "framework/capture/common_names.h"
#include "framework/capture/cryptomatte.h"
#include "framework/capture/decode.h"
#include "framework/capture/layer_roles.h"
#include "framework/capture/role_file.h"
#include "framework/capture/sample_means.h"
#include "framework/capture/stored_layers.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

Window grid_of(const FrameFile& file, const FoundChannels& channels, const std::string& luminance) {
    if (!luminance.empty()) return file.window_of(luminance);
    return channels.empty() ? file.merged().data_window : file.window_of(channels[0][0]);
}

/// Engines leave 0 in the alpha of their buffers, which makes every pixel of a PNG transparent.
void read_alpha(Image& color, bool is_opaque, CaptureHeader& header) {
    if (color.channels() != 4) return;
    const std::span<float> values = color.floats();
    bool has_alpha = false, has_light = false;
    for (std::size_t i = 0; i < values.size() && (is_opaque || !has_alpha || !has_light); i += 4) {
        if (is_opaque) values[i + 3] = 1;
        has_alpha = has_alpha || values[i + 3] != 0;
        has_light = has_light || values[i] != 0 || values[i + 1] != 0 || values[i + 2] != 0;
    }
    if (has_light && !has_alpha)
        header.notes.push_back("the alpha of color is 0 everywhere, so a PNG of it is transparent; " +
                               spelled(Option::alpha, "opaque") +
                               ", or \"alpha\": \"opaque\" in capture.json, reads it as 1");
}

}  // namespace

CaptureReader::CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits)
    : CaptureReader(sequence, std::move(profiles), limits, std::make_shared<FirstFrame>()) {}

CaptureReader::CaptureReader(const Sequence& sequence, std::vector<Profile> profiles, ReadLimits limits,
                             std::shared_ptr<FirstFrame> first)
    : sequence_(sequence), profiles_(std::move(profiles)), limits_(limits), first_(std::move(first)) {}

CaptureReader::~CaptureReader() = default;

const Profile& CaptureReader::choose_profile(const ExrPart& part, CaptureHeader& header) const {
    const FirstFrame* const first = first_frame();
    if (sequence_.profile == "auto" && !first) {
        const ProfileChoice choice =
            detect_profile(profiles_, part, header.path.string(), sequence_.channels.contains(kColorRole));
        header.profile_reason = choice.reason;
        return *choice.profile;
    }
    const bool is_held = sequence_.profile == "auto";
    header.profile_reason = is_held ? first->header->profile_reason : "chosen by name";
    const std::string& id = is_held ? first->header->profile : sequence_.profile;
    if (is_held) compare_profile(part, *first->header, header);
    for (const Profile& profile : profiles_)
        if (profile.id == id) return profile;
    std::vector<std::string> ids;
    for (const Profile& profile : profiles_) ids.push_back(profile.id);
    throw Error(ErrorKind::usage,
                "no profile '" + sequence_.profile + "'; known: " + list_of_names(ids, "and"));
}

void CaptureReader::add_role(OpenFrame& open, const std::string& role, const RoleDecoding& decoding) const {
    const auto own_file = open.role_files.find(role);
    const FrameFile& file = own_file == open.role_files.end() ? *open.main : *own_file->second;
    RoleSource source;
    source.file = &file;
    source.decoding = decoding;
    auto found = find_role_channels(open, file, role, decoding);
    for (const RoleDecoding& other : decoding.otherwise)
        if (!found && (found = find_role_channels(open, file, role, other))) source.decoding = other;
    RoleDecoding luminance;
    luminance.layers = {{decoding.luminance.empty() && role == kColorRole ? "Y" : decoding.luminance}};
    const bool has_luminance = !luminance.layers[0][0].empty() && !has_x_y_z(file.merged()) &&
                               find_channels(luminance, "", file.merged());
    hold_channels(role, file, found, source.decoding, open.header);
    if (found) source.channels = std::move(*found);
    else if (has_luminance) source.luminance = luminance.layers[0][0];
    else if (own_file != open.role_files.end() && &file != &cryptomatte_file(open))
        throw Error(ErrorKind::capture, file.path().string() + ": " +
                                            no_channels_for_role(*find_role(role), file.merged(),
                                                                 sequence_.channels.contains(role)));
    else return;
    open.header.role_channels[role] =
        source.luminance.empty() ? names_of(source.channels) : std::vector{source.luminance};
    find_others(open, role, source);
    open.roles[role] = std::move(source);
}

void CaptureReader::find_roles(OpenFrame& open) const {
    std::set<std::string> names;  // aov:<name> too, which no table lists
    for (const auto& [name, decoding] : open.profile->roles) names.insert(name);
    for (const auto& [name, decoding] : sequence_.channels) names.insert(name);
    for (const auto& [name, file] : open.role_files) names.insert(name);
    for (const std::string& name : names) {
        const auto own = sequence_.channels.find(name);
        const auto profiled = open.profile->roles.find(name);
        if (own != sequence_.channels.end()) add_role(open, name, own->second);
        else if (profiled != open.profile->roles.end()) add_role(open, name, profiled->second);
        else add_role(open, name, RoleDecoding{});
    }
    if (!sequence_.channels.contains(kColorRole) && !names.contains(kColorRole))
        add_role(open, kColorRole, RoleDecoding{});
    take_data_of_other_layer(open);
    require_albedo(open);
    note_first_of_parts(open);
    note_assumed_space(open);
    note_data_read_as_color(open);
    find_cryptomatte_roles(open);
    compare_sources(open);
    for (const auto& [role, source] : open.roles) {
        open.header.roles.push_back(role);
        if (source.file != open.main.get() || source.channels.empty() || source.decoding.times_albedo)
            open.header.derived_roles.insert(role);
    }
    if (!deep_picture(open)) return;
    open.header.layer_count = sequence_.deep_layers;
    for (int layer = 0; layer < sequence_.deep_layers; ++layer)
        for (const auto& [role, source] : open.roles)
            if (is_deep(open, role)) open.header.layer_roles.push_back(RoleId::of_layer(layer, role));
}

CaptureReader::OpenFrame CaptureReader::open(int frame, int deep_layers) const {
    OpenFrame open;
    if (is_held_flat()) deep_layers = 1;
    open.main = open_file(sequence_.path_of(frame), "", deep_layers, open.header);
    for (const auto& [role, pattern] : sequence_.role_files) {
        auto& file = open.role_files[role];
        file = open_file(pattern.path(frame), role, deep_layers, open.header);
        require_one_picture(role, *file, *open.main);
        std::ranges::move(role_file_faults(role, *file, *open.main),
                          std::back_inserter(open.header.warnings));
    }
    const ExrPart& part = open.main->merged();
    CaptureHeader& header = open.header;
    header.frame = header.source_frame = frame;
    header.path = open.main->path();
    header.view = open.main->view();
    header.display_window = part.display_window;
    header.pixel_aspect = part.pixel_aspect;
    header.metadata = part.metadata;
    for (const ExrChannel& channel : part.channels) header.channels.push_back(channel.name);
    open.profile = &choose_profile(part, header);
    header.profile = open.profile->id;
    header.remedies = open.profile->remedies;
    choose_layer(open);
    header.camera = sequence_.camera;
    header.camera.complete_from(camera_of_metadata(part, *open.profile, sequence_.camera));
    for (std::string& fault : camera_faults(part, *open.profile, sequence_.camera))
        header.warnings.push_back(std::move(fault));
    header.lights = sequence_.lights ? *sequence_.lights : lights_of_metadata(part.metadata, header.path);
    find_roles(open);

    const auto color = open.roles.find(kColorRole);
    header.data_window = color == open.roles.end()
                             ? part.data_window
                             : grid_of(*color->second.file, color->second.channels, color->second.luminance);
    find_colors(open);
    compare_with_first(header, header.primaries);
    find_losses(open);
    return open;
}

bool CaptureReader::has_frame(int frame) const {
    for (std::size_t i = 0; i < sequence_.layers.size(); ++i) {
        const Sequence own = sequence_of_layer(sequence_, i);
        if (!layer_reader(own, i).has_frame(frame)) return false;
    }
    if (!sequence_.layers.empty()) return true;
    std::error_code unreadable;
    const auto exists = [&](const auto& role_file) {
        return std::filesystem::exists(role_file.second.path(frame), unreadable);
    };
    return std::filesystem::exists(sequence_.path_of(frame), unreadable) &&
           std::all_of(sequence_.role_files.begin(), sequence_.role_files.end(), exists);
}

CaptureHeader CaptureReader::read_header(int frame) const {
    return sequence_.layers.empty() ? open(frame).header : read_layered_header(frame);
}

void CaptureReader::read_motion(const OpenFrame& open, const std::string& role, Image& velocity,
                                const Image* color, Capture& capture) const {
    const CaptureHeader& header = open.header;
    const RoleSource& source = open.roles.at(role);
    const DecodeContext context{
        header.path.string(), header.data_window, header.display_window, header.camera, color, exr_threads()};
    const std::vector<std::size_t> missing = decode_velocity(velocity, source.decoding, context);
    if (find_role(role)->to_next || missing.empty()) return;
    const auto& cuts = sequence_.cuts;
    const bool begins_shot =
        header.frame % sequence_.subframes == 0 &&
        std::find(cuts.begin(), cuts.end(), header.frame / sequence_.subframes) != cuts.end();
    capture.pixels_without_motion = missing.size();
    const std::filesystem::path before = sequence_.path_of(header.frame - sequence_.subframes);
    std::error_code unreadable;
    if (begins_shot || !open.roles.contains(kDepthRole) || !sequence_.files.has_frame() ||
        !std::filesystem::exists(before, unreadable))
        return;
    const FrameFile previous(before, limits_, sequence_.view);
    if (previous.view() != open.main->view()) return;  // another camera
    const Camera camera = camera_of_metadata(previous.merged(), *open.profile, sequence_.camera);
    if (!knows_motion(header.camera, camera)) return;
    const Image depth = read_role(open, kDepthRole, nullptr, capture);
    fill_camera_velocity(velocity, missing, depth, header.data_window, header.display_window, header.camera,
                         camera);
    capture.motion_from_camera = true;
}

Image CaptureReader::read_ids(const RoleSource& source, const Window& grid, int layer) const {
    const FrameFile& file = *source.file;
    const DeepRead how{layer, false};
    if (file.type_of(source.channels[0][0]) == PixelType::uint32)
        return file.read_uints(source.channels[0], grid, how);
    return decode_ids(file.read_floats(source.channels[0], grid, 0, how),
                      file.path().string() + ": " + source.channels[0][0], exr_threads());
}

namespace {

bool has_negative(const Image& image) {
    float least = 0;
    for (const float value : image.floats()) least = std::min(least, value);
    return least < 0;
}

}  // namespace

Image CaptureReader::read_role(const OpenFrame& open, const std::string& name, const Image* color,
                               Capture& capture) const {
    const CaptureHeader& header = open.header;
    const ChannelRole role = *find_role(name);
    const RoleSource& source = open.roles.at(name);
    const FrameFile& file = *source.file;
    if (source.from_cryptomatte) return read_cryptomatte_role(open, role.kind);
    if (role.type == ComponentType::uint32) {
        Image ids = read_ids(source, header.data_window, open.layer);
        warn_of_others(open, name, ids, capture);
        if (name == kObjectIdRole) name_numbers(ids);
        return ids;
    }
    // A stored value beyond the data window is none: it gets the role's value after decoding, except where
    // decoding itself turns it into that.
    const float outside = role.kind == RoleKind::distance ? source.decoding.no_hit : role.outside;
    const DeepRead how{open.layer, is_blended(role.kind)};
    Image image = source.luminance.empty()
                      ? read_layers(file, source.channels, header.data_window, outside, how)
                      : file.read_luminance_chroma(source.luminance, header.data_window);
    // Decoding makes "no hit" and "no motion" of NaN, so it is looked for in what the file stores.
    if (role.kind == RoleKind::distance || role.kind == RoleKind::motion)
        if (const NonFinitePixels found = find_non_finite(image, true, exr_threads()); found.nan > 0)
            capture.non_finite[name] = found;
    warn_of_others(open, name, image, capture);
    if (is_unit_in_doubt(open, name, image)) warn_of_unit(open, name, image, capture);
    if (std::string fault = range_fault(name, image, source.decoding); !fault.empty())
        capture.header.warnings.push_back(std::move(fault));
    if (source.decoding.is_mean) repair_means(image);
    if (role.kind == RoleKind::distance) {
        decode_depth(image, source.decoding,
                     {file.path().string(), header.data_window, header.display_window, header.camera, nullptr,
                      exr_threads()});
        // Without figures, so that a sequence says it once.
        if (has_negative(image))
            capture.header.warnings.push_back(
                name +
                " is negative in places, and nothing is seen behind the camera: if the file stores -z, set "
                "\"scale\": -1 next to the role's channels in capture.json");
    }
    if (role.kind == RoleKind::motion) read_motion(open, name, image, color, capture);
    if (name == kIrradianceRole) finish_irradiance(open, source, image, capture);
    if (role.kind == RoleKind::light)
        light_of_stored(image, source.colors, header.primaries, file.path().string());
    return image;
}

void CaptureReader::prefetch(const OpenFrame& open, std::span<const RoleId> roles) const {
    std::map<const FrameFile*, std::vector<FrameFile::Request>> requests;
    for (const RoleId& role : with_parts_of_irradiance(open, roles)) {
        const auto found = open.roles.find(role.name());
        if (found == open.roles.end()) continue;
        const RoleSource& source = found->second;
        if (source.from_cryptomatte || !source.luminance.empty()) continue;
        const bool reads_uints = find_role(role)->type == ComponentType::uint32 &&
                                 source.file->type_of(source.channels[0][0]) == PixelType::uint32;
        const ComponentType type = reads_uints ? ComponentType::uint32 : ComponentType::float32;
        for (const std::vector<std::string>& layer : source.channels)
            requests[source.file].push_back({present_of(layer), type});
        for (const FoundChannels& other : source.others)
            requests[source.file].push_back({present_of(other[0]), type});
    }
    for (const auto& [file, wanted] : requests) file->prefetch(wanted);
}

void CaptureReader::read_images(OpenFrame& open, std::span<const RoleId> roles, Capture& capture) const {
    const auto wants = [&](const std::string& role) {
        return open.roles.contains(role) && std::find(roles.begin(), roles.end(), role) != roles.end();
    };
    const auto is_premultiplied = [&](const auto& entry) {
        return entry.second.decoding.premultiplied && wants(entry.first);
    };
    Image color;
    const bool needs_color = std::any_of(open.roles.begin(), open.roles.end(), is_premultiplied);
    if (open.roles.contains(kColorRole) && (wants(kColorRole) || needs_color))
        color = read_role(open, kColorRole, nullptr, capture);
    for (const auto& [role, source] : open.roles)
        if (role != kColorRole && wants(role))
            capture.images[role] = read_role(open, role, color.empty() ? nullptr : &color, capture);
    read_alpha(color, sequence_.alpha_is_opaque, capture.header);
    if (wants(kColorRole)) capture.images[kColorRole] = std::move(color);
}

Capture CaptureReader::read(int frame, std::span<const RoleId> roles) const {
    if (!sequence_.layers.empty()) return read_layered(frame, roles);
    OpenFrame open = this->open(frame, std::min(asked_layers(roles), sequence_.deep_layers));
    Capture capture;
    prefetch(open, roles_of_any_layer(roles));
    compare_roles(open.header, roles);
    capture.header = open.header;
    read_images(open, roles, capture);
    for (const RoleId& role : roles)
        if (role.is_coverage()) capture.images[role] = read_coverage(open, role);
    if (const auto ids = capture.images.find(kObjectIdRole);
        ids != capture.images.end() && !sequence_.object_names.empty())
        require_names(open, ids->second, sequence_.object_names);
    read_deep_layers(open, roles, capture);
    return capture;
}

}  // namespace aftershade
