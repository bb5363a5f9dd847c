// The section "telemetry" of effect.json: numbers out of textures.
#include <algorithm>

#include "framework/core/text.h"
#include "framework/core/units.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr std::string_view kChannels = "rgba";
constexpr int kMaxBins = 1024;

std::string list_of_textures(const EffectManifest& manifest, std::vector<std::string>& known) {
    for (const TextureSpec& texture : manifest.textures)
        if (texture.layers == 1 && !gpu::is_integer(texture.format)) known.push_back(texture.name);
    return list_of_names(known, "and");
}

}  // namespace

void ManifestParser::telemetry(const Node& section) {
    for (const Member& member : section.members) statistic(member);
}

std::optional<TextureChannel> ManifestParser::channel(const Node& node, const std::string& label) {
    const std::size_t dot = node.string.rfind('.');
    const std::string name = node.string.substr(0, dot),
                      letter = dot == std::string::npos ? "" : node.string.substr(dot + 1);
    std::vector<std::string> known;
    const std::string list = list_of_textures(manifest_, known);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
        fault(node.place, label + ": '" + name + "' is not a texture of the effect with one layer of floats" +
                              did_you_mean(name, known) + " (known: " + list + ")");
        return std::nullopt;
    }
    const int channels = gpu::channel_count(manifest_.find_texture(name)->format);
    const std::size_t place = letter.size() == 1 ? kChannels.find(letter[0]) : std::string_view::npos;
    if (place == std::string_view::npos || int(place) >= channels) {
        fault(node.place, label + ": '" + node.string + "' must end in a channel of '" + name + "', one of " +
                              std::string(kChannels.substr(0, std::size_t(channels))) + ": \"" + name +
                              ".r\"");
        return std::nullopt;
    }
    return TextureChannel{name, int(place)};
}

void ManifestParser::histogram(const Node& node, TelemetrySpec& spec) {
    bool numbers = node.items.size() == 3;
    for (const Node& item : node.items) numbers = numbers && item.is_number();
    if (!numbers) {
        fault(node.place, "'bins' is [from, to, count], three numbers: [0, 64, 8]");
        return;
    }
    spec.from = node.items[0].number;
    spec.to = node.items[1].number;
    const double count = node.items[2].number;
    if (spec.from >= spec.to)
        fault(node.place, "'bins' must go up: its second number is not above its first");
    if (count < 1 || count > kMaxBins || count != double(int(count)))
        fault(node.items[2].place, "'bins' has " + format_number(count) + " bins, but an integer from 1 to " +
                                       std::to_string(kMaxBins) + " is needed");
    else spec.bins = int(count);
}

void ManifestParser::statistic(const Member& member) {
    identifier(member.key, member.key_place, "statistic");
    ObjectReader reader(member.value, "statistic '" + member.key + "'", diagnostics_);
    if (!reader.is_object()) return;
    TelemetrySpec spec;
    spec.name = member.key;
    spec.place = member.key_place;
    const std::string label = "statistic '" + member.key + "'";
    const bool named = reader.text("of", Presence::required).has_value();
    const auto of = named ? channel(*member.value.find("of"), label + ", of") : std::nullopt;
    if (of) spec.of = *of;
    if (reader.text("where")) spec.where = channel(*member.value.find("where"), label + ", where");
    if (of && spec.where &&
        !(manifest_.find_texture(of->texture)->grid == manifest_.find_texture(spec.where->texture)->grid))
        fault(member.value.find("where")->place,
              label + ": '" + spec.where->texture + "' has not the size of '" + of->texture + "'");
    spec.squared = reader.boolean("squared").value_or(false);
    if (const Node* bins = reader.array("bins")) histogram(*bins, spec);
    spec.doc = reader.text("doc").value_or("");
    reader.finish();
    manifest_.telemetry.push_back(std::move(spec));
}

}  // namespace aftershade
