// The section "tiles" of a manifest: lists of tiles that draws are confined to.
#include <utility>

#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

using Presence = ObjectReader::Presence;

namespace {

constexpr int kMaxListedTile = 256;  // 16 of them are a work group's, whose tile is at most 4096

}  // namespace

void ManifestParser::tiles(const Node& section) {
    for (const Member& member : section.members)
        if (is_new("tile list", member)) tile_list(member);
}

void ManifestParser::tile_list(const Member& member) {
    identifier(member.key, member.key_place, "tile list");
    ObjectReader reader(member.value, "tile list '" + member.key + "'", diagnostics_);
    if (!reader.is_object()) return;
    TileListSpec list;
    list.name = member.key;
    list.place = member.key_place;
    list.folder = reading_ ? reading_->spec.folder : manifest_.folder;
    list.module = reading_ ? reading_->spec.name : "";
    list.doc = reader.text("doc", Presence::required).value_or("");
    const auto of = reader.text("of");
    const auto predicate = reader.text("predicate");
    if (of.has_value() == predicate.has_value())
        fault(member.value.place, "tile list '" + member.key +
                                      "' is 'of' a texture's channel or has a 'predicate', one of the two");
    if (of) tiles_of_texture(*member.value.find("of"), list);
    if (predicate) {
        list.predicate = *predicate;
        if (predicate->empty())
            fault(member.value.find("predicate")->place,
                  "tile list '" + member.key + "': 'predicate' names no file");
        if (const Node* tile = reader.any("tile", Presence::required))
            list.tile.number = int(integer_in(*tile, "tile", 2, kMaxListedTile));
        list.on = reader.text("on").value_or("");
        list.infers_reads = reads(member.value, reader, list.reads);
    }
    if (const Node* section = reader.object("when")) add_conditions(*section, list.when);
    reader.finish();
    manifest_.tiles.push_back(std::move(list));
}

/// The list has the texture's tiles, and is there where the texture is.
void ManifestParser::tiles_of_texture(const Node& of, TileListSpec& list) {
    const std::string label = "tile list '" + list.name + "', of";
    list.of = channel(of, label);
    if (!list.of) return;
    const TextureSpec& texture = *manifest_.find_texture(list.of->texture);
    list.tile = texture.grid.tile;
    list.when = texture.when;
    if (texture.grid.kind != GridSpec::Kind::tile)
        fault(of.place,
              label + ": '" + texture.name + "' has no 'tile': each of its texels must stand for one");
    ReadSpec read;
    read.name = texture.name;
    read.place = of.place;
    list.reads = {read};
}

}  // namespace aftershade
