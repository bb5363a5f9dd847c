// The tile lists of a manifest, and the passes over them.
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace {

/// Tiles lie on what they are of, and on targets, by the scales of both.
bool has_scale(const EffectManifest& manifest, const std::string& name) {
    const TextureSpec* texture = manifest.find_texture(name);
    return !texture || texture->grid.kind == GridSpec::Kind::scale;
}

void check_grid(const EffectManifest& manifest, const TileListSpec& list, Diagnostics& diagnostics) {
    if (!has_scale(manifest, list.on))
        diagnostics.error(list.place, "the tile list '" + list.name + "' is on '" + list.on +
                                          "', which has no 'scale' of the working grid");
}

/// Each texel of the target belongs to one tile; "" where all is well.
std::string fault_of_target(const EffectManifest& manifest, const TileListSpec& list,
                            const WriteSpec& write) {
    constexpr const char* kScale = "have a 'scale' of the working grid";
    const TextureSpec* texture = manifest.find_texture(write.name);
    if (!texture) return "";
    const GridSpec& grid = texture->grid;
    if (grid.kind == GridSpec::Kind::size || write.level.is_of_pass) return kScale;
    const bool is_fixed = list.tile.param.empty() && list.on.empty();
    if (grid.kind == GridSpec::Kind::scale && write.level.number == 0) return "";
    if (!is_fixed)
        return std::string(kScale) + ", and be its level 0: the list's tile is not a fixed number of px";
    if (grid.kind == GridSpec::Kind::scale)
        return list.tile.number % (1 << write.level.number) == 0
                   ? ""
                   : "be of a level whose texels divide the list's tile of " +
                         std::to_string(list.tile.number) + " px";
    return grid.tile.param.empty() && list.tile.number % grid.tile.number == 0
               ? ""
               : std::string(kScale) + ", or a 'tile' that divides the list's of " +
                     std::to_string(list.tile.number) + " px";
}

void check_over(const EffectManifest& manifest, const PassSpec& pass, Diagnostics& diagnostics) {
    const std::string label = label_of(manifest, pass) + ": ";
    std::vector<std::string> lists;
    for (const TileListSpec& list : manifest.tiles) lists.push_back(list.name);
    const TileListSpec* list = manifest.tile_list_of(pass);
    if (!list)
        diagnostics.error(pass.place, label + "runs over '" + *pass.over() + "', which is not a tile list" +
                                          did_you_mean(*pass.over(), lists));
    for (const WriteSpec& write : pass.writes)
        if (const std::string fault = list ? fault_of_target(manifest, *list, write) : ""; !fault.empty())
            diagnostics.error(write.place, label + "runs over tiles, so what it writes, '" + write.name +
                                               "', must " + fault);
}

}  // namespace

void check_tiles(const EffectManifest& manifest, Diagnostics& diagnostics) {
    for (const TileListSpec& list : manifest.tiles) {
        check_grid(manifest, list, diagnostics);
        const auto runs_over = [&](const PassSpec& pass) { return pass.over() && *pass.over() == list.name; };
        if (std::none_of(manifest.passes.begin(), manifest.passes.end(), runs_over))
            diagnostics.error(list.place, "no pass runs over the tile list '" + list.name + "'");
    }
    for (const PassSpec& pass : manifest.passes)
        if (pass.over()) check_over(manifest, pass, diagnostics);
}

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
