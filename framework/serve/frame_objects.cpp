#include "framework/serve/frame_objects.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/image/role.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char *kObject = "object", *kMaterial = "material", *kAsset = "asset";

/// By the names that the specification of Cryptomatte gives its layers: crypto_material, CryptoAsset.
const char* kind_of(const std::string& cryptomatte) {
    const std::string name = lower_case(cryptomatte);
    if (name.find(kMaterial) != std::string::npos) return kMaterial;
    return name.find(kAsset) != std::string::npos ? kAsset : kObject;
}

Json entry_of(const std::string& kind, const std::string& name, std::uint32_t id) {
    Json entry = {{"kind", kind}};
    if (!name.empty()) entry["name"] = name;
    entry["id"] = id;
    return entry;
}

}  // namespace

FrameObjects::FrameObjects(const CaptureReader& reader, const Sequence& sequence, int file,
                           const Capture& whole) {
    for (const CryptomatteLayer& matte : reader.cryptomattes(file)) {
        Layer layer{kind_of(matte.name), matte.name, reader.ids_of_cryptomatte(file, matte.name), {}};
        for (std::size_t i = 0; i < matte.object_names.size(); ++i)
            layer.names[matte.object_ids[i]] = matte.object_names[i];
        layers_.push_back(std::move(layer));
    }
    std::ranges::stable_sort(layers_, std::ranges::greater(), [](const Layer& layer) { return layer.kind; });
    const bool has_objects =
        std::ranges::any_of(layers_, [](const Layer& layer) { return layer.kind == kObject; });
    const auto ids = whole.images.find(kObjectIdRole);
    if (has_objects || ids == whole.images.end()) return;
    Layer layer{kObject, "", ids->second, {}};
    for (const auto& [name, id] : sequence.objects) {
        layer.names[id] = name;
        layer.names[cryptomatte_hash(name)] = name;  // in place of the number of what the look names
    }
    layers_.insert(layers_.begin(), std::move(layer));
}

/// A name that looks find in an earlier layer.
bool FrameObjects::is_hidden(const Layer& layer, const std::string& name) const {
    return std::ranges::any_of(layers_.data(), &layer, [&](const Layer& earlier) {
        return std::ranges::any_of(earlier.names, [&](const auto& known) { return known.second == name; });
    });
}

Json FrameObjects::list(const CaptureReader& reader, int file) const {
    Json list = Json::array();
    for (const Layer& layer : layers_) {
        const auto pixels = double(std::max<std::size_t>(layer.ids.uints().size(), 1));
        std::map<std::uint32_t, double> share;
        for (const std::uint32_t id : layer.ids.uints()) share[id] += 1 / pixels;
        if (!layer.cryptomatte.empty()) {
            share.erase(0);
            // All ranks count, and not only the object that covers most of a pixel.
            for (const ObjectCoverage& object : reader.cryptomatte_coverage(file, layer.cryptomatte))
                for (const auto& [id, name] : layer.names)
                    if (name == object.name) share[id] = object.coverage_px / pixels;
        }
        std::vector<std::pair<double, std::uint32_t>> order;
        for (const auto& [id, part] : share)
            if (part > 0) order.emplace_back(part, id);
        std::ranges::sort(order, std::ranges::greater());
        for (const auto& [part, id] : order) {
            const auto known = layer.names.find(id);
            const std::string name = known == layer.names.end() ? "" : known->second;
            if (is_hidden(layer, name)) continue;
            list.push_back(entry_of(layer.kind, name, id));
            list.back()["share"] = part;
        }
    }
    std::stable_sort(list.begin(), list.end(),
                     [](const Json& a, const Json& b) { return a["share"].get<double>() > b["share"]; });
    return list;
}

Json FrameObjects::at(std::pair<int, int> place) const {
    Json list = Json::array();
    for (const Layer& layer : layers_) {
        const auto [x, y] = place;
        if (x < 0 || y < 0 || x >= layer.ids.width() || y >= layer.ids.height()) continue;
        const std::uint32_t id = layer.ids.uint_at(x, y, 0);
        if (id == 0 && !layer.cryptomatte.empty()) continue;
        const auto known = layer.names.find(id);
        const std::string name = known == layer.names.end() ? "" : known->second;
        if (!is_hidden(layer, name)) list.push_back(entry_of(layer.kind, name, id));
    }
    return list;
}

}  // namespace aftershade::serve
