#include "framework/capture/cryptomatte.h"

#include <fmt/format.h>
#include <murmurhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <functional>
#include <map>

#include "framework/base/atomic_file.h"
#include "framework/base/diagnostics.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/capture/channel_names.h"
#include "framework/capture/frame_file.h"
#include "framework/file/exr_loss.h"
#include "framework/file/object_manifest.h"

namespace aftershade {

namespace {

constexpr int kMaxRankPairs = 50;  // two ranks to a set of four channels, which two digits count

using RankChannels = std::array<std::string, 4>;

/// Empty where the file has not all four.
std::optional<RankChannels> rank_channels(const FrameFile& file, const std::string& prefix) {
    constexpr std::array kComponents = {".R", ".G", ".B", ".A"};
    RankChannels channels;
    for (std::size_t i = 0; i < channels.size(); ++i) {
        const std::string name = prefix + kComponents[i];
        for (const ExrChannel& channel : file.merged().channels)
            if (canonical_name(channel.name) == canonical_name(name)) channels[i] = channel.name;
        if (channels[i].empty()) return std::nullopt;
    }
    return channels;
}

std::vector<RankChannels> channels_of_ranks(const FrameFile& file, const std::string& name) {
    std::vector<RankChannels> ranks;
    for (int pair = 0; pair < kMaxRankPairs; ++pair) {
        const auto channels = rank_channels(file, name + (pair < 10 ? "0" : "") + std::to_string(pair));
        if (!channels) break;
        ranks.push_back(*channels);
    }
    return ranks;
}

/// id, coverage, id, coverage of two ranks.
Image read_ranks(const FrameFile& file, const RankChannels& channels, const Window& grid) {
    const std::string& compression = file.compression_of(channels[0]);
    const auto is_lost = [&](const std::string& channel) {
        return loses_bits(compression, channel, file.type_of(channel));
    };
    const bool lossy = std::any_of(channels.begin(), channels.end(), is_lost);
    if (lossy || file.type_of(channels[0]) != PixelType::float32)
        throw Error(ErrorKind::capture,
                    file.path().string() + ": the Cryptomatte ids in " + channels[0] + " are " +
                        (lossy ? "compressed with loss (" + compression + ")" : "stored as half") +
                        ", which destroys them (write them as float, zip)");
    return file.read_floats(channels, grid, 0, {-1, false});  // of deep samples what shows most
}

std::vector<std::string> names_of(std::span<const CryptomatteLayer> layers) {
    std::vector<std::string> names;
    for (const CryptomatteLayer& layer : layers) names.push_back(layer.name);
    return names;
}

/// The first object that the manifest does not have; a matte without one may have any.
std::optional<std::string> unknown_object(const CryptomatteLayer& layer,
                                          std::span<const std::string> objects) {
    const auto& known = layer.object_names;
    for (const std::string& object : objects)
        if (!known.empty() && std::find(known.begin(), known.end(), object) == known.end()) return object;
    return std::nullopt;
}

/// "; 'skin' is in the Cryptomatte ViewLayer.CryptoMaterial": where the file has the object after all.
std::string object_elsewhere(const std::string& object, const FrameFile& file) {
    for (const CryptomatteLayer& layer : find_cryptomattes(file))
        if (std::ranges::find(layer.object_names, object) != layer.object_names.end())
            return "; '" + object + "' is in the Cryptomatte " + layer.name +
                   " (read that one: \"cryptomatte\": {\"layer\": " + json_string(layer.name) +
                   "} in capture.json; one look names objects of one Cryptomatte)";
    return "";
}

[[noreturn]] void refuse_unknown_object(std::span<const CryptomatteLayer> layers, const std::string& object,
                                        const FrameFile& file) {
    std::vector<std::string> known;
    for (const CryptomatteLayer& layer : find_cryptomattes(file))
        known.insert(known.end(), layer.object_names.begin(), layer.object_names.end());
    const std::string elsewhere = object_elsewhere(object, file);
    // Where one of several has it, the first is the one that has not.
    const auto missing = elsewhere.empty() ? layers : layers.first(1);
    throw UnknownObject(
        file.path().string() + ": the Cryptomatte" + (missing.size() == 1 ? " " : "s ") +
            joined(names_of(missing), ", ") + (missing.size() == 1 ? " has" : " have") + " no object '" +
            object + "'" +
            (elsewhere.empty()
                 ? did_you_mean(object, known) + advice(" (inspect ", Option::cryptomatte, "", " lists them)")
                 : elsewhere),
        object);
}

bool says_object(const CryptomatteLayer& layer) {
    return lower_case(layer.name).find("object") != std::string::npos;
}

std::uint32_t id_bits(const Image& ranks, std::size_t pixel, std::size_t rank) {
    return std::bit_cast<std::uint32_t>(ranks.floats()[4 * pixel + 2 * rank]);
}

}  // namespace

std::vector<CryptomatteLayer> find_cryptomattes(const FrameFile& file) {
    std::vector<CryptomatteLayer> layers;
    const ExrMetadata& metadata = file.merged().metadata;
    for (const std::string& key : cryptomatte_keys(metadata)) {
        CryptomatteLayer layer;
        layer.name = metadata.text(key + "/name").value_or("");
        layer.ranks = channels_of_ranks(file, layer.name);
        if (layer.ranks.empty()) continue;
        for (const ManifestEntry& entry : read_object_manifest(file.path(), metadata, key)) {
            layer.object_names.push_back(entry.object);
            layer.object_ids.push_back(entry.id ? *entry.id : cryptomatte_hash(entry.object));
        }
        layers.push_back(std::move(layer));
    }
    return layers;
}

std::vector<std::string> declared_cryptomattes(const FrameFile& file) {
    std::vector<std::string> names;
    const ExrMetadata& metadata = file.merged().metadata;
    for (const std::string& key : cryptomatte_keys(metadata))
        names.push_back(metadata.text(key + "/name").value_or(""));
    return names;
}

const CryptomatteLayer& choose_cryptomatte(const std::vector<CryptomatteLayer>& layers,
                                           const std::string& name, const FrameFile& file) {
    std::vector<std::string> names;
    for (const CryptomatteLayer& layer : layers) {
        if (layer.name == name || layer.name.ends_with("." + name) || (name.empty() && layers.size() == 1))
            return layer;
        names.push_back(layer.name);
    }
    if (layers.empty()) throw Error(ErrorKind::capture, file.path().string() + ": has no Cryptomatte");
    throw Error(ErrorKind::capture,
                file.path().string() + ": name one of its Cryptomattes, " + list_of_names(names));
}

const CryptomatteLayer& cryptomatte_with(const std::vector<CryptomatteLayer>& layers,
                                         std::span<const std::string> objects, const FrameFile& file) {
    std::vector<const CryptomatteLayer*> fitting;
    for (const CryptomatteLayer& layer : layers)
        if (!unknown_object(layer, objects)) fitting.push_back(&layer);
    if (fitting.size() > 1 &&
        std::any_of(fitting.begin(), fitting.end(), [](auto* l) { return says_object(*l); }))
        std::erase_if(fitting, [](const CryptomatteLayer* layer) { return !says_object(*layer); });
    if (fitting.size() == 1) return *fitting.front();
    if (fitting.empty()) refuse_unknown_object(layers, *unknown_object(layers.front(), objects), file);
    throw Error(ErrorKind::capture, file.path().string() + ": name one of its Cryptomattes, " +
                                        list_of_names(names_of(layers)) +
                                        ", as \"cryptomatte\": {\"layer\": ...} in capture.json");
}

std::uint32_t cryptomatte_hash(const std::string& object) {
    std::uint32_t hash = 0;
    lmmh_x86_32(object.data(), unsigned(object.size()), 0, &hash);
    const std::uint32_t exponent = hash >> 23 & 0xff;
    return exponent == 0 || exponent == 0xff ? hash ^ 1u << 23 : hash;
}

std::uint32_t id_of_object(const CryptomatteLayer& layer, const std::string& object) {
    const auto found = std::ranges::find(layer.object_names, object);
    return found == layer.object_names.end()
               ? cryptomatte_hash(object)
               : layer.object_ids[std::size_t(found - layer.object_names.begin())];
}

std::vector<IdRange> id_ranges(std::span<const TableKey> keys) {
    std::vector<IdRange> all, joined;
    for (const TableKey& key : keys) {
        const std::uint32_t hash = key.name.empty() ? 0 : cryptomatte_hash(key.name);
        all.push_back(key.name.empty() ? IdRange{key.first, key.last} : IdRange{hash, hash});
    }
    std::ranges::sort(all, {}, &IdRange::first);
    for (const IdRange& range : all) {
        // In 64 bits, because nothing follows the last id.
        if (!joined.empty() && range.first <= std::uint64_t(joined.back().last) + 1)
            joined.back().last = std::max(joined.back().last, range.last);
        else joined.push_back(range);
    }
    return joined;
}

bool contains(std::span<const IdRange> ranges, std::uint32_t id) {
    const auto found = std::ranges::lower_bound(ranges, id, {}, &IdRange::last);
    return found != ranges.end() && found->first <= id;
}

Image cryptomatte_mask(const FrameFile& file, const CryptomatteLayer& layer,
                       const std::vector<std::string>& objects, const Window& grid) {
    if (const auto unknown = unknown_object(layer, objects))
        refuse_unknown_object(std::span(&layer, 1), *unknown, file);
    std::vector<std::uint32_t> wanted;
    for (const std::string& object : objects) wanted.push_back(id_of_object(layer, object));
    Image mask(grid.width(), grid.height(), 1);
    for (const RankChannels& channels : layer.ranks) {
        const Image ranks = read_ranks(file, channels, grid);
        for (std::size_t pixel = 0; pixel < mask.floats().size(); ++pixel)
            for (std::size_t rank = 0; rank < 2; ++rank)
                if (std::find(wanted.begin(), wanted.end(), id_bits(ranks, pixel, rank)) != wanted.end())
                    mask.floats()[pixel] += ranks.floats()[4 * pixel + 2 * rank + 1];
    }
    for (float& coverage : mask.floats()) coverage = std::clamp(coverage, 0.0f, 1.0f);
    return mask;
}

std::vector<ObjectCoverage> coverage_of_objects(const FrameFile& file, const CryptomatteLayer& layer,
                                                const Window& grid) {
    std::map<std::uint32_t, ObjectCoverage> by_id;
    for (const std::string& name : layer.object_names) by_id[id_of_object(layer, name)] = {name, 0};
    for (const RankChannels& channels : layer.ranks) {
        const Image ranks = read_ranks(file, channels, grid);
        for (std::size_t pixel = 0; pixel < ranks.floats().size() / 4; ++pixel)
            for (std::size_t rank = 0; rank < 2; ++rank)
                if (const float amount = ranks.floats()[4 * pixel + 2 * rank + 1]; amount > 0)
                    by_id[id_bits(ranks, pixel, rank)].coverage_px += double(amount);
    }
    std::vector<ObjectCoverage> objects;
    for (auto& [id, object] : by_id) {
        if (object.name.empty()) object.name = fmt::format("{:08x}", id);
        objects.push_back(std::move(object));
    }
    std::ranges::stable_sort(objects, std::ranges::greater{}, &ObjectCoverage::coverage_px);
    return objects;
}

Image cryptomatte_ids(const FrameFile& file, const CryptomatteLayer& layer, const Window& grid,
                      std::span<const std::string> named) {
    const Image ranks = read_ranks(file, layer.ranks.front(), grid);
    std::map<std::uint32_t, std::uint32_t> hashes;
    for (const std::string& object : named)
        if (const std::uint32_t id = id_of_object(layer, object); id != cryptomatte_hash(object))
            hashes[id] = cryptomatte_hash(object);
    Image ids(grid.width(), grid.height(), 1, ComponentType::uint32);
    for (std::size_t pixel = 0; pixel < ids.uints().size(); ++pixel)
        ids.uints()[pixel] = id_bits(ranks, pixel, 0);
    if (hashes.empty()) return ids;
    for (std::uint32_t& id : ids.uints())
        if (const auto hash = hashes.find(id); hash != hashes.end()) id = hash->second;
    return ids;
}

}  // namespace aftershade
