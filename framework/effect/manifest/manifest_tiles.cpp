// The section "tiles" of a manifest: lists of tiles that draws are confined to.
#include <utility>

#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

void ManifestParser::tiles(const Reader& document) {
    for (const Reader::Named& declared : document.named("tiles"))
        if (is_new("tile list", *declared.member)) tile_list(declared);
}

void ManifestParser::tile_list(const Reader::Named& declared) {
    const Reader& reader = declared.reader;
    TileListSpec list;
    list.name = declared.member->key;
    list.place = declared.member->key_place;
    list.folder = reading_ ? reading_->spec.folder : manifest_.folder;
    list.module = reading_ ? reading_->spec.name : "";
    list.doc = reader.text("doc");
    if (reader.has("of")) tiles_of_texture(reader, list);
    if (reader.node().find("predicate")) {
        list.predicate = reader.text("predicate");
        if (reader.has("tile")) list.tile.number = int(reader.integer("tile"));
        list.on = reader.text("on");
        list.infers_reads = read_reads(reader, list.reads);
    }
    add_conditions(reader, list.when);
    manifest_.tiles.push_back(std::move(list));
}

/// The list has the texture's tiles, and is there where the texture is.
void ManifestParser::tiles_of_texture(const Reader& reader, TileListSpec& list) {
    const std::string thing = "tile list '" + list.name + "'";
    list.of = channel(reader, "of", thing);
    if (!list.of) return;
    const TextureSpec& texture = *manifest_.find_texture(list.of->texture);
    list.tile = texture.grid.tile;
    list.when = texture.when;
    const Place& place = reader.place("of");
    if (texture.grid.kind != GridSpec::Kind::tile)
        fault(place,
              thing + ", of: '" + texture.name + "' has no 'tile': each of its texels must stand for one");
    ReadSpec read;
    read.name = texture.name;
    read.place = place;
    list.reads = {read};
}

}  // namespace aftershade
