// Objects that looks name: their share of each pixel, and their names where files have numbers.
#include <algorithm>
#include <map>

#include "framework/base/error.h"
#include "framework/capture/capture_internal.h"
#include "framework/image/role.h"

namespace aftershade {

Image CaptureReader::read_coverage(const OpenFrame& open, const RoleId& role) const {
    const Window& grid = open.header.data_window;
    const std::vector<TableKey>& objects = role.objects();
    std::vector<std::string> names;
    std::vector<TableKey> ids;
    std::vector<TableKey> wanted = objects;
    for (const TableKey& key : objects) {
        const auto known = sequence_.objects.find(key.name);
        if (key.name.empty()) ids.push_back(key);
        else if (known == sequence_.objects.end()) names.push_back(key.name);
        // By its number too: object_id has hashes only of what parameters name.
        else ids.insert(ids.end(), {{known->second, known->second, ""}, key});
    }
    wanted.insert(wanted.end(), ids.begin(), ids.end());
    const auto matte = names.empty() && !ids.empty() && !sequence_.objects.empty()
                           ? std::nullopt
                           : find_cryptomatte(open, names);
    Image mask(grid.width(), grid.height(), 1);
    if (matte) mask = cryptomatte_mask(cryptomatte_file(open), *matte, names, grid);
    if ((matte && ids.empty()) || (matte && !open.roles.contains(kObjectIdRole))) return mask;
    Image object_id;
    Capture unused;
    if (open.ids_by_number) object_id = read_ids(*open.ids_by_number, grid);
    else if (open.roles.contains(kObjectIdRole)) object_id = read_role(open, kObjectIdRole, nullptr, unused);
    if (!matte && !names.empty()) require_names(open, object_id, names);
    if (object_id.empty()) return mask;
    const std::vector<IdRange> ranges = id_ranges(matte ? ids : wanted);
    for (std::size_t i = 0; i < mask.floats().size(); ++i)
        if (contains(ranges, object_id.uints()[i])) mask.floats()[i] = 1;
    return mask;
}

/// Numbers of objects that the look names, as the hashes that it looks for.
void CaptureReader::name_numbers(Image& ids) const {
    std::map<std::uint32_t, std::uint32_t> hashes;
    for (const std::string& name : sequence_.object_names)
        if (const auto known = sequence_.objects.find(name); known != sequence_.objects.end())
            hashes[known->second] = cryptomatte_hash(name);
    if (hashes.empty()) return;
    for (std::uint32_t& id : ids.uints())
        if (const auto hash = hashes.find(id); hash != hashes.end()) id = hash->second;
}

/// A name stands for a hash, and no hash is below 2^23: its exponent is never 0.
void CaptureReader::require_names(const OpenFrame& open, const Image& ids,
                                  std::span<const std::string> names) const {
    constexpr std::uint32_t kSmallestHash = 1u << 23;
    const auto is_known = [&](const std::string& name) { return sequence_.objects.contains(name); };
    const auto unknown = std::ranges::find_if_not(names, is_known);
    if (unknown == names.end()) return;
    const auto source = open.roles.find(kObjectIdRole);
    if (!sequence_.objects.empty() && source != open.roles.end() && !source->second.from_cryptomatte) {
        std::vector<std::string> known;
        for (const auto& [name, id] : sequence_.objects) known.push_back(name);
        throw UnknownObject(open.header.path.string() + ": the look names the object '" + *unknown +
                                "', but \"objects\" of capture.json has no such name" +
                                did_you_mean(*unknown, known) + " (it has " + list_of_names(known, "and") +
                                ")",
                            *unknown);
    }
    std::string instead = "the file has neither a Cryptomatte nor the role object_id";
    if (source != open.roles.end()) {
        const RoleSource& found = source->second;
        if (found.from_cryptomatte) return;
        const auto values = ids.uints();
        const bool has_hash =
            std::any_of(values.begin(), values.end(), [](std::uint32_t id) { return id >= kSmallestHash; });
        const bool is_empty =
            std::all_of(values.begin(), values.end(), [](std::uint32_t id) { return id == 0; });
        const std::string& channel = found.channels[0][0];
        if (has_hash || (is_empty && found.file->type_of(channel) == PixelType::uint32)) return;
        instead =
            "object_id is read from " + channel + ", which holds numbers, and the file has no Cryptomatte";
    }
    const std::vector<std::string> declared = declared_cryptomattes(cryptomatte_file(open));
    std::string remedy = "render a Cryptomatte of objects, or name the object by its number";
    if (!declared.empty()) {
        instead += "; its header declares " + list_of_names(declared, "and") +
                   ", whose channels are not in the file";
        remedy =
            "write multilayer EXR, or name the file with the Cryptomatte as \"files\": "
            "{\"object_id\": ...} in capture.json";
    }
    throw UnknownObject(open.header.path.string() + ": the look names the object '" + *unknown + "', but " +
                            instead + " (" + remedy + ")",
                        *unknown);
}

}  // namespace aftershade
