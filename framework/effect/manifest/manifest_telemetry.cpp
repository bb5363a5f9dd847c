// The section "telemetry" of effect.json: numbers out of textures.
#include <algorithm>

#include "framework/base/text.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace {

constexpr std::string_view kChannels = "rgba";

std::string list_of_textures(const EffectManifest& manifest, std::vector<std::string>& known) {
    for (const TextureSpec& texture : manifest.textures)
        if (texture.layers == 1 && !gpu::is_integer(texture.format)) known.push_back(texture.name);
    return list_of_names(known, "and");
}

}  // namespace

void ManifestParser::telemetry(const Reader& document) {
    for (const Reader::Named& declared : document.named("telemetry")) statistic(declared);
}

std::optional<TextureChannel> ManifestParser::channel(const Reader& reader, const std::string& key,
                                                      const std::string& thing) {
    const Place& place = reader.place(key);
    const std::string text = reader.text(key), label = thing + ", " + key;
    const std::size_t dot = text.rfind('.');
    const std::string name = text.substr(0, dot),
                      letter = dot == std::string::npos ? "" : text.substr(dot + 1);
    std::vector<std::string> known;
    const std::string list = list_of_textures(manifest_, known);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
        fault(place, label + ": '" + name + "' is not a texture of the effect with one layer of floats" +
                         did_you_mean(name, known) + " (known: " + list + ")");
        return std::nullopt;
    }
    const int channels = gpu::channel_count(manifest_.find_texture(name)->format);
    const std::size_t at = letter.size() == 1 ? kChannels.find(letter[0]) : std::string_view::npos;
    if (at == std::string_view::npos || int(at) >= channels) {
        fault(place, label + ": '" + text + "' must end in a channel of '" + name + "', one of " +
                         std::string(kChannels.substr(0, std::size_t(channels))) + ": \"" + name + ".r\"");
        return std::nullopt;
    }
    return TextureChannel{name, int(at)};
}

void ManifestParser::statistic(const Reader::Named& declared) {
    const Reader& reader = declared.reader;
    TelemetrySpec spec;
    spec.name = declared.member->key;
    spec.place = declared.member->key_place;
    const std::string thing = "statistic '" + spec.name + "'";
    const auto of = reader.has("of") ? channel(reader, "of", thing) : std::nullopt;
    if (of) spec.of = *of;
    if (reader.has("where")) spec.where = channel(reader, "where", thing);
    if (of && spec.where &&
        !(manifest_.find_texture(of->texture)->grid == manifest_.find_texture(spec.where->texture)->grid))
        fault(reader.place("where"),
              thing + ", where: '" + spec.where->texture + "' has not the size of '" + of->texture + "'");
    spec.squared = reader.boolean("squared");
    if (const std::vector<double> bins = reader.numbers("bins"); bins.size() == 3) {
        spec.from = bins[0];
        spec.to = bins[1];
        spec.bins = int(bins[2]);
    }
    spec.doc = reader.text("doc");
    manifest_.telemetry.push_back(std::move(spec));
}

}  // namespace aftershade
