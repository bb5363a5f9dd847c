// Which layer and which Cryptomatte of a file the roles are taken from.
#include <algorithm>
#include <set>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/capture/bare_channels.h"
#include "framework/capture/capture_internal.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/common_data.h"
#include "framework/capture/common_names.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::string_view kLayerPrefix = "{layer}.";

/// The decoding with every channel below the layer.
RoleDecoding below_layer(RoleDecoding decoding) {
    for (auto& names : decoding.layers)
        for (std::string& alternatives : names) {
            std::string prefixed;
            for (std::size_t start = 0; start <= alternatives.size();) {
                const std::size_t bar = std::min(alternatives.find('|', start), alternatives.size());
                const std::string one = alternatives.substr(start, bar - start);
                prefixed += (start > 0 ? "|" : "") +
                            (one.starts_with(kLayerPrefix) ? one : std::string(kLayerPrefix) + one);
                start = bar + 1;
            }
            alternatives = prefixed;
        }
    return decoding;
}

bool takes_layer(const RoleDecoding& decoding) {
    for (const auto& names : decoding.layers)
        for (const std::string& name : names)
            if (name.starts_with(kLayerPrefix)) return true;
    return false;
}

/// The one called `name` in the layer, else in any.
const CryptomatteLayer& named_cryptomatte(const std::vector<CryptomatteLayer>& mattes,
                                          const std::string& name, const std::string& layer,
                                          const FrameFile& file) {
    for (const CryptomatteLayer& matte : mattes)
        if (matte.name == layer + "." + name) return matte;
    return choose_cryptomatte(mattes, name, file);
}

/// Where a pixel is not one of the named objects it has its number: a look may use both. A name stands for a
/// hash, which is no smaller than 2^23, and numbers are small.
void keep_numbers(Image& hashes, const Image& numbers, std::span<const std::string> named) {
    std::set<std::uint32_t> wanted;
    for (const std::string& name : named) wanted.insert(cryptomatte_hash(name));
    for (std::size_t i = 0; i < hashes.uints().size(); ++i)
        if (!wanted.contains(hashes.uints()[i])) hashes.uints()[i] = numbers.uints()[i];
}

/// Files call the alpha by other names than the rest of the colour.
void complete_alpha(FoundChannels& color, const ExrPart& part) {
    std::vector<std::string>& names = color.front();
    if (names.size() == 4 && names[3].empty()) names[3] = find_common_alpha(part, names[0]);
}

constexpr std::string_view kNativeProfile = "native";

bool is_among(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

void require_layer_of_first(const CaptureHeader& header, const CaptureHeader& first) {
    if (is_among(header.layers, first.layer)) return;
    throw Error(ErrorKind::capture,
                header.path.string() + ": has no layer '" + first.layer + "', which the first frame, " +
                    first.path.string() + ", is read from; it has " +
                    (header.layers.empty() ? "none" : list_of_names(header.layers, "and")) +
                    " (choose a layer that every frame has with " + spelled(Option::layer) +
                    ", or 'layer' in capture.json)");
}

}  // namespace

void CaptureReader::choose_layer(OpenFrame& open) const {
    const ExrPart& part = open.main->merged();
    CaptureHeader& header = open.header;
    header.layers = find_layers(*open.profile, part);
    header.layer = sequence_.layer;
    if (sequence_.layer.empty()) {
        const FirstFrame* const first = first_frame();
        const bool is_held = first && !first->header->layer.empty();
        if (is_held) require_layer_of_first(header, *first->header);
        if (header.layers.empty()) return;
        header.layer = is_held ? first->header->layer : header.layers.front();
        if (is_held && header.layers != first->header->layers)
            header.differences.push_back("it has the layers " + list_of_names(header.layers, "and") + "; '" +
                                         header.layer + "' is read, as in " + first->header->path.string());
        else if (header.layers.size() > 1)
            header.notes.push_back("the file has the layers " + list_of_names(header.layers, "and") + "; '" +
                                   header.layer + "' is read (choose with " + spelled(Option::layer) +
                                   ", or 'layer' in capture.json)");
        return;
    }
    if (is_among(header.layers, sequence_.layer)) return;
    if (has_layer(part, sequence_.layer)) {
        open.is_foreign_layer = true;
        return;
    }
    std::vector<std::string> known = header.layers.empty() ? color_layers(part) : header.layers;
    std::erase(known, "");
    throw Error(ErrorKind::usage, header.path.string() + ": has no layer '" + sequence_.layer + "'" +
                                      (known.empty() ? std::string("; it has no layers")
                                                     : did_you_mean(sequence_.layer, known) + " (it has " +
                                                           list_of_names(known, "and") + ")"));
}

std::optional<FoundChannels> CaptureReader::find_role_channels(const OpenFrame& open, const FrameFile& file,
                                                               const std::string& role,
                                                               const RoleDecoding& decoding) const {
    const ExrPart& part = file.merged();
    const bool is_own_file = &file != open.main.get();
    const std::string layer = is_own_file ? find_layer(*open.profile, part) : open.header.layer;
    const bool is_foreign = open.is_foreign_layer && !is_own_file;
    const bool is_named_by_user = sequence_.channels.contains(role);
    const bool may_be_bare = role == kColorRole || is_named_by_user || (is_own_file && has_one_layer(part));
    const RoleDecoding names = may_be_bare ? decoding : without_bare_names(decoding);
    if (!names.layers.empty()) {
        auto found = find_channels(is_foreign ? below_layer(names) : names, layer, part);
        const bool is_of_color = found && !is_named_by_user && is_tristimulus(part, found->front().front());
        if (found && role == kColorRole && !is_named_by_user) complete_alpha(*found, part);
        if (found && (!is_of_color || role == kColorRole)) return found;
    }
    // What capture.json says is what the user wants, and nothing else.
    if (is_named_by_user && !decoding.layers.empty()) return std::nullopt;
    if (role == kColorRole) {
        auto found = find_common_color(part, layer);
        if (found) complete_alpha(*found, part);
        return found;
    }
    if (is_own_file) return find_only_channels(*find_role(role), part);
    // Of a known producer its profile says what other data mean.
    if (role != kDepthRole && open.profile->id != kNativeProfile) return std::nullopt;
    const auto color = open.roles.find(kColorRole);
    const bool has_color =
        color != open.roles.end() && color->second.file == open.main.get() && !color->second.channels.empty();
    const bool is_only_layer = sequence_.layer.empty() && open.header.layers.size() < 2;
    return find_common_data(part, role, is_only_layer ? "" : layer,
                            has_color       ? color->second.channels[0][0]
                            : layer.empty() ? ""
                                            : layer + ".R");
}

/// A compositor's result comes as a layer of its own beside the one that it was made from. Its colour is the
/// picture, and the rest is the other layer's, if there is but one.
void CaptureReader::take_data_of_other_layer(OpenFrame& open) const {
    CaptureHeader& header = open.header;
    if (!sequence_.layer.empty() || header.layers.size() != 2) return;
    for (const auto& [role, source] : open.roles)
        if (role != kColorRole && source.file == open.main.get() && takes_layer(source.decoding)) return;
    const std::string other = header.layers[header.layer == header.layers.front() ? 1 : 0];
    const std::string first = std::exchange(header.layer, other);
    std::vector<std::string> taken;
    for (const auto& [role, decoding] : open.profile->roles) {
        if (open.roles.contains(role) || sequence_.channels.contains(role) || !takes_layer(decoding))
            continue;
        add_role(open, role, decoding);
        if (open.roles.contains(role)) taken.push_back(role);
    }
    header.layer = first;
    if (taken.empty()) return;
    header.notes = {"the layer '" + first + "' has a colour alone; " + list_of_names(taken, "and") +
                    (taken.size() == 1 ? " is" : " are") + " read from the layer '" + other +
                    "' (choose one layer for all with " + spelled(Option::layer) +
                    ", or 'layer' in capture.json)"};
}

/// Passes of one file that name nothing but themselves.
void CaptureReader::note_first_of_parts(OpenFrame& open) const {
    const auto color = open.roles.find(kColorRole);
    if (!sequence_.layer.empty() || color == open.roles.end() || color->second.channels.empty() ||
        color->second.channels[0][0] != "R" || sequence_.channels.contains(kColorRole))
        return;
    if (const auto others = color->second.file->other_color_parts(); !others.empty())
        open.header.notes.push_back("color is read from the first part with R, G and B; " +
                                    list_of_names(others, "and") + (others.size() == 1 ? " has" : " have") +
                                    " them, too (choose with " + spelled(Option::layer) +
                                    ", or 'layer' in capture.json)");
}

/// Normals and positions under a name that many programs use may be in the camera's space.
void CaptureReader::note_assumed_space(OpenFrame& open) const {
    if (sequence_.profile != "auto" || open.profile->id != kNativeProfile) return;
    for (const auto& [role, source] : open.roles) {
        const RoleKind kind = kind_of_role(role);
        if ((kind != RoleKind::direction && kind != RoleKind::place) || source.file != open.main.get() ||
            sequence_.channels.contains(role) || canonical_name(source.channels[0][0]) == role + ".x")
            continue;
        open.header.notes.push_back(role + " is read from " + list_of_names(source.channels[0], "and") +
                                    " as of world space, which the file does not say");
    }
}

/// A pass in a file of its own, whose only channels are those of a picture: a colour, for all that the file
/// says.
void CaptureReader::note_data_read_as_color(OpenFrame& open) const {
    const std::string role = role_in_file_name(open.header.path.stem().string());
    const bool has_color_alone = open.roles.size() == 1 && open.roles.contains(kColorRole);
    if (role.empty() || !has_color_alone || sequence_.profile != "auto" ||
        sequence_.channels.contains(kColorRole))
        return;
    open.header.notes.push_back(
        "the file's name says " + role + ", but its channels are read as color" +
        advice("; where the picture is a file of its own, name that one as the capture, and this one with ",
               Option::role, role + "=" + open.header.path.filename().string(), ""));
}

/// The file that Cryptomattes are read from: object_id's own, if it has any, else the main one.
const FrameFile& CaptureReader::cryptomatte_file(const OpenFrame& open) const {
    const auto own = open.role_files.find(kObjectIdRole);
    return own != open.role_files.end() && !find_cryptomattes(*own->second).empty() ? *own->second
                                                                                    : *open.main;
}

std::optional<CryptomatteLayer> CaptureReader::find_cryptomatte(const OpenFrame& open,
                                                                std::span<const std::string> objects) const {
    const FrameFile& file = cryptomatte_file(open);
    std::vector<CryptomatteLayer> mattes = find_cryptomattes(file);
    if (sequence_.cryptomatte && !sequence_.cryptomatte->layer.empty())
        return named_cryptomatte(mattes, sequence_.cryptomatte->layer, open.header.layer, file);
    if (mattes.empty()) return std::nullopt;
    const auto is_elsewhere = [&](const CryptomatteLayer& matte) {
        return !matte.name.starts_with(open.header.layer + ".");
    };
    if (!open.header.layer.empty() && !std::all_of(mattes.begin(), mattes.end(), is_elsewhere))
        std::erase_if(mattes, is_elsewhere);
    return cryptomatte_with(mattes, objects, file);
}

void CaptureReader::find_cryptomatte_roles(OpenFrame& open) const {
    RoleSource source;
    source.from_cryptomatte = true;
    source.file = &cryptomatte_file(open);
    const bool is_own_file = source.file != open.main.get(), is_named = !sequence_.object_names.empty();
    if (!sequence_.cryptomatte && !is_named && !is_own_file) return;
    if (!sequence_.cryptomatte && find_cryptomattes(*source.file).empty()) return;
    if (sequence_.cryptomatte && !sequence_.cryptomatte->mask.empty()) open.roles[kMaskRole] = source;
    if (!is_named && !is_own_file && open.roles.contains(kObjectIdRole)) return;
    const auto by_number = open.roles.find(kObjectIdRole);
    if (by_number != open.roles.end() && !is_own_file) open.ids_by_number = by_number->second;
    else if (is_named)
        open.header.notes.push_back(
            "the look names objects, so object_id is read from a Cryptomatte; ids by number find nothing "
            "there");
    open.roles[kObjectIdRole] = source;
    open.header.role_channels.erase(kObjectIdRole);
}

Image CaptureReader::read_cryptomatte_role(const OpenFrame& open, RoleKind kind) const {
    static const std::vector<std::string> kNoNames;
    const bool is_mask = kind == RoleKind::coverage;
    const auto& objects = is_mask ? sequence_.cryptomatte->mask : sequence_.object_names;
    const FrameFile& file = cryptomatte_file(open);
    const auto matte = find_cryptomatte(open, objects);
    if (!matte) throw Error(ErrorKind::capture, file.path().string() + ": has no Cryptomatte");
    const Window& grid = open.header.data_window;
    if (is_mask) return cryptomatte_mask(file, *matte, objects, grid);
    Image ids = cryptomatte_ids(file, *matte, grid, objects);
    if (!open.ids_by_number) return ids;
    try {
        keep_numbers(ids, read_ids(*open.ids_by_number, grid), objects);
    } catch (const Error&) {
        // Numbers that were averaged name nothing; a look of names alone does without them.
    }
    return ids;
}

RoleElsewhere CaptureReader::find_elsewhere(const CaptureHeader& header, const std::string& role) const {
    const auto has_role = [&](const Sequence& other) {
        try {
            const CaptureHeader found =
                CaptureReader(other, profiles_, limits_, nullptr).read_header(header.source_frame);
            return is_among(found.roles, role) && is_among(found.roles, kColorRole);
        } catch (const Error&) {
            return false;
        }
    };
    RoleElsewhere elsewhere;
    Sequence other = sequence_;
    for (const Profile& profile : profiles_) {
        other.profile = profile.id;
        if (profile.id != header.profile && has_role(other)) elsewhere.profiles.push_back(profile.id);
    }
    other = sequence_;
    for (const std::string& layer : header.layers) {
        other.layer = layer;
        if (layer != header.layer && has_role(other)) elsewhere.layers.push_back(layer);
    }
    return elsewhere;
}

std::vector<CryptomatteLayer> CaptureReader::cryptomattes(int frame) const {
    if (const auto front = front_layer()) return layer_reader(*front, 0).cryptomattes(frame);
    const OpenFrame open = this->open(frame);
    return find_cryptomattes(cryptomatte_file(open));
}

std::string CaptureReader::cryptomatte_name(int frame, const std::string& name) const {
    if (const auto front = front_layer()) return layer_reader(*front, 0).cryptomatte_name(frame, name);
    const OpenFrame open = this->open(frame);
    const FrameFile& file = cryptomatte_file(open);
    const std::vector<CryptomatteLayer> mattes = find_cryptomattes(file);
    if (!name.empty()) return named_cryptomatte(mattes, name, open.header.layer, file).name;
    const auto matte = find_cryptomatte(open, {});
    if (!matte) throw Error(ErrorKind::capture, file.path().string() + ": has no Cryptomatte");
    return matte->name;
}

Image CaptureReader::ids_of_cryptomatte(int frame, const std::string& name) const {
    if (const auto front = front_layer()) return layer_reader(*front, 0).ids_of_cryptomatte(frame, name);
    const OpenFrame open = this->open(frame);
    const FrameFile& file = cryptomatte_file(open);
    const std::vector<CryptomatteLayer> mattes = find_cryptomattes(file);
    return cryptomatte_ids(file, choose_cryptomatte(mattes, name, file), open.header.data_window);
}

std::vector<ObjectCoverage> CaptureReader::cryptomatte_coverage(int frame, const std::string& name) const {
    if (const auto front = front_layer()) return layer_reader(*front, 0).cryptomatte_coverage(frame, name);
    const OpenFrame open = this->open(frame);
    const FrameFile& file = cryptomatte_file(open);
    const std::vector<CryptomatteLayer> mattes = find_cryptomattes(file);
    return coverage_of_objects(file, choose_cryptomatte(mattes, name, file), open.header.data_window);
}

}  // namespace aftershade
