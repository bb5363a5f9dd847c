#include "framework/capture/cryptomatte.h"

#include <murmurhash.h>

#include <algorithm>
#include <bit>
#include <nlohmann/json.hpp>

#include "framework/core/diagnostics.h"
#include "framework/core/error.h"

namespace aftershade {

namespace {

constexpr int kMaxRankPairs = 3;  // six ranks, two to a set of four channels

bool has_channel(const FrameFile& file, const std::string& name) {
    const auto& channels = file.merged().channels;
    return std::any_of(channels.begin(), channels.end(), [&](const ExrChannel& c) { return c.name == name; });
}

/// Names in the manifest, {"object": "hex", ...}; a manifest that is damaged counts as none: it is only a
/// help.
std::vector<std::string> manifest_names(const std::optional<std::string>& manifest) {
    std::vector<std::string> names;
    const auto parsed = nlohmann::json::parse(manifest.value_or("{}"), nullptr, false);
    if (parsed.is_object())
        for (const auto& [name, hash] : parsed.items()) names.push_back(name);
    return names;
}

std::vector<std::string> rank_prefixes(const FrameFile& file, const std::string& name) {
    std::vector<std::string> ranks;
    for (int pair = 0; pair < kMaxRankPairs; ++pair) {
        const std::string prefix = name + "0" + std::to_string(pair);
        if (!has_channel(file, prefix + ".R") || !has_channel(file, prefix + ".A")) break;
        ranks.push_back(prefix);
    }
    return ranks;
}

/// id, coverage, id, coverage of two ranks.
Image read_ranks(const FrameFile& file, const std::string& prefix, const Window& grid) {
    const std::vector<std::string> channels = {prefix + ".R", prefix + ".G", prefix + ".B", prefix + ".A"};
    const std::string& compression = file.merged().compression;
    const bool lossy = is_lossy_compression(compression);
    if (lossy || file.type_of(channels[0]) != PixelType::float32)
        throw Error(ExitCode::capture,
                    file.path().string() + ": the Cryptomatte ids in " + channels[0] + " are " +
                        (lossy ? "compressed with loss (" + compression + ")" : "stored as half") +
                        ", which destroys them (write them as float, zip)");
    return file.read_floats(channels, grid, 0);
}

std::uint32_t id_bits(const Image& ranks, std::size_t pixel, std::size_t rank) {
    return std::bit_cast<std::uint32_t>(ranks.floats()[4 * pixel + 2 * rank]);
}

}  // namespace

std::vector<CryptomatteLayer> find_cryptomattes(const FrameFile& file) {
    constexpr std::string_view kHead = "cryptomatte/", kName = "/name";
    std::vector<CryptomatteLayer> layers;
    const ExrMetadata& metadata = file.merged().metadata;
    for (const std::string& attribute : metadata.names()) {
        if (!attribute.starts_with(kHead) || !attribute.ends_with(kName)) continue;
        CryptomatteLayer layer;
        layer.name = metadata.text(attribute).value_or("");
        layer.ranks = rank_prefixes(file, layer.name);
        const std::string base = attribute.substr(0, attribute.size() - kName.size());
        layer.object_names = manifest_names(metadata.text(base + "/manifest"));
        if (!layer.ranks.empty()) layers.push_back(std::move(layer));
    }
    return layers;
}

const CryptomatteLayer& choose_cryptomatte(const std::vector<CryptomatteLayer>& layers,
                                           const std::string& name, const FrameFile& file) {
    std::vector<std::string> names;
    for (const CryptomatteLayer& layer : layers) {
        if (layer.name == name || layer.name.ends_with("." + name) || (name.empty() && layers.size() == 1))
            return layer;
        names.push_back(layer.name);
    }
    if (layers.empty()) throw Error(ExitCode::capture, file.path().string() + ": has no Cryptomatte");
    throw Error(ExitCode::capture,
                file.path().string() + ": name one of its Cryptomattes, " + list_of_names(names));
}

std::uint32_t cryptomatte_hash(const std::string& object) {
    std::uint32_t hash = 0;
    lmmh_x86_32(object.data(), unsigned(object.size()), 0, &hash);
    const std::uint32_t exponent = hash >> 23 & 0xff;
    return exponent == 0 || exponent == 0xff ? hash ^ 1u << 23 : hash;
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
    std::vector<std::uint32_t> wanted;
    for (const std::string& object : objects) {
        const auto& known = layer.object_names;
        if (!known.empty() && std::find(known.begin(), known.end(), object) == known.end())
            throw Error(ExitCode::capture, file.path().string() + ": the Cryptomatte " + layer.name +
                                               " has no object '" + object + "'" +
                                               did_you_mean(object, known));
        wanted.push_back(cryptomatte_hash(object));
    }
    Image mask(grid.width(), grid.height(), 1);
    for (const std::string& prefix : layer.ranks) {
        const Image ranks = read_ranks(file, prefix, grid);
        for (std::size_t pixel = 0; pixel < mask.floats().size(); ++pixel)
            for (std::size_t rank = 0; rank < 2; ++rank)
                if (std::find(wanted.begin(), wanted.end(), id_bits(ranks, pixel, rank)) != wanted.end())
                    mask.floats()[pixel] += ranks.floats()[4 * pixel + 2 * rank + 1];
    }
    for (float& coverage : mask.floats()) coverage = std::clamp(coverage, 0.0f, 1.0f);
    return mask;
}

Image cryptomatte_ids(const FrameFile& file, const CryptomatteLayer& layer, const Window& grid) {
    const Image ranks = read_ranks(file, layer.ranks.front(), grid);
    Image ids(grid.width(), grid.height(), 1, ComponentType::uint32);
    for (std::size_t pixel = 0; pixel < ids.uints().size(); ++pixel)
        ids.uints()[pixel] = id_bits(ranks, pixel, 0);
    return ids;
}

}  // namespace aftershade
