#include "framework/effect/manifest/manifest_expand.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "framework/base/data_path.h"
#include "framework/effect/manifest/manifest_grammar.h"
#include "framework/effect/manifest/manifest_groups.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace {

void append(std::vector<WhenSpec>& conditions, const std::vector<WhenSpec>& more) {
    conditions.insert(conditions.end(), more.begin(), more.end());
}

/// One work group takes 16 x 16 tiles: glsl/host/list_tiles.comp.
constexpr int kTilesOfAGroup = 16;

class TileListWriter {
public:
    TileListWriter(EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {}

    /// Buffers first: passes count by them.
    void write() {
        for (const TileListSpec& list : manifest_.tiles)
            if (is_used(list)) add_buffers(list);
        std::vector<PassSpec> passes;
        for (PassSpec& pass : manifest_.passes) {
            if (const TileListSpec* list = manifest_.tile_list_of(pass)) {
                const auto fills = [&](const PassSpec& other) {
                    return other.lists() && *other.lists() == list->name;
                };
                if (std::none_of(passes.begin(), passes.end(), fills)) passes.push_back(listing_pass(*list));
                confine(pass, *list);
            }
            passes.push_back(std::move(pass));
        }
        manifest_.passes = std::move(passes);
    }

private:
    bool is_used(const TileListSpec& list) const {
        return std::any_of(manifest_.passes.begin(), manifest_.passes.end(),
                           [&](const PassSpec& pass) { return manifest_.tile_list_of(pass) == &list; });
    }

    void add_buffers(const TileListSpec& list) {
        for (const std::string& name : {list.runs(), list.args()})
            if (manifest_.find_buffer(name))
                diagnostics_.error(list.place, "the tile list '" + list.name + "' needs the name '" + name +
                                                   "' for a buffer of its own, but one is declared already");
        BufferSpec runs;
        runs.name = list.runs();
        runs.element = "uvec4";
        runs.grid = tiles_of(list);
        runs.place = list.place;
        BufferSpec args;
        args.name = list.args();
        args.element = "uint";
        args.count.number = 4;
        args.clear = {4, 0, 0, 0};  // the corners of a quad
        args.indirect = true;
        args.place = list.place;
        manifest_.buffers.push_back(std::move(runs));
        manifest_.buffers.push_back(std::move(args));
    }

    /// A place for each tile, in tiles of the working grid.
    GridSpec tiles_of(const TileListSpec& list) const {
        GridSpec grid;
        grid.kind = GridSpec::Kind::tile;
        grid.tile = list.tile;
        const TextureSpec* on = manifest_.find_texture(list.on);
        if (on && on->grid.kind == GridSpec::Kind::scale)
            grid.tile.number = std::max(1, int(std::floor(list.tile.number / on->grid.scale)));
        if (on) std::copy_n(on->grid.room, 2, grid.room);
        return grid;
    }

    static PassSpec listing_pass(const TileListSpec& list) {
        PassSpec pass;
        pass.name = list.name;
        pass.folder = list.folder;
        pass.module = list.module;
        pass.shader = list.predicate;
        pass.reads = list.reads;
        pass.infers_reads = list.infers_reads;
        pass.when = list.when;
        pass.buffers = {access(list.runs(), AccessSpec::Kind::write, list.place),
                        access(list.args(), AccessSpec::Kind::atomic, list.place)};
        DispatchSpec dispatch;
        dispatch.tile.number = kTilesOfAGroup * (list.of ? 1 : list.tile.number);
        dispatch.over = list.of ? list.of->texture : list.on;
        pass.work = ComputeSpec{dispatch, list.name};
        pass.place = list.place;
        return pass;
    }

    static void confine(PassSpec& pass, const TileListSpec& list) {
        pass.draw()->instances.emplace().indirect = list.args();
        // At kTileRunsBinding.
        pass.buffers.insert(pass.buffers.begin(), access(list.runs(), AccessSpec::Kind::read, pass.place));
        append(pass.when, list.when);
    }

    static AccessSpec access(const std::string& name, AccessSpec::Kind kind, const Place& place) {
        AccessSpec access;
        access.name = name;
        access.kind = kind;
        access.place = place;
        return access;
    }

    EffectManifest& manifest_;
    Diagnostics& diagnostics_;
};

/// A texture is there or not for all its uses at once.
void hand_down_conditions(EffectManifest& manifest) {
    const auto hand_down = [&](auto& uses) {
        for (auto& use : uses)
            if (const TextureSpec* texture = manifest.find_texture(use.name)) append(use.when, texture->when);
    };
    for (PassSpec& pass : manifest.passes) {
        hand_down(pass.reads);
        hand_down(pass.writes);
        hand_down(pass.images);
    }
}

}  // namespace

bool write_out(EffectManifest& manifest, const std::filesystem::path& glsl_folder, Diagnostics& diagnostics) {
    TileListWriter(manifest, diagnostics).write();
    if (!infer_uses(manifest, glsl_folder, diagnostics)) return false;
    hand_down_conditions(manifest);
    if (!manifest.reach && is_pointwise(manifest))
        manifest.counts_from_part = counts_from_part(manifest, glsl_folder);
    return true;
}

namespace fs = std::filesystem;

namespace {

constexpr const char* kModuleFile = "module.json";

std::vector<std::string> module_names(const fs::path& glsl_folder) {
    std::vector<std::string> names;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(glsl_folder, failure))
        if (fs::is_regular_file(entry.path() / kModuleFile, failure))
            names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

void ManifestParser::modules(const Reader& document, const fs::path& glsl_folder) {
    const Node* names = document.find("modules");
    if (!names || names->items.empty()) return;
    const fs::path folder = glsl_folder.empty() ? data_path() / "glsl" : glsl_folder;
    for (const Node& item : names->items)
        if (item.is_string()) module(item, folder);
}

void ManifestParser::module(const Node& item, const fs::path& glsl_folder) {
    const std::vector<std::string> known = module_names(glsl_folder);
    if (std::find(known.begin(), known.end(), item.string) == known.end()) {
        fault(item.place, "no module '" + item.string + "' in " + glsl_folder.string() +
                              did_you_mean(item.string, known));
        lacks_modules_ = true;
        return;
    }
    const auto same = [&](const Module& other) { return other.spec.name == item.string; };
    if (std::any_of(modules_.begin(), modules_.end(), same)) return;
    const fs::path folder = glsl_folder / item.string;
    auto document = read_document(folder / kModuleFile, diagnostics_);
    const int errors_before = diagnostics_.error_count();
    if (document) document = without_groups(std::move(*document), diagnostics_);
    if (!document || diagnostics_.error_count() > errors_before) {
        lacks_modules_ = true;
        return;
    }
    modules_.push_back({{item.string, "", folder}, std::move(*document)});
    Module& module = modules_.back();
    grammar::check(module.document, module_block(), diagnostics_);
    const Reader reader(module.document, module_block());
    module.spec.summary = reader.text("summary");
    if (const Node* before = reader.find("before"))
        for (const Node& other : before->items) {
            if (!other.is_string()) continue;
            if (!fs::is_regular_file(glsl_folder / other.string / kModuleFile))
                fault(other.place, "no module '" + other.string + "' in " + glsl_folder.string());
            module.spec.before.push_back(other.string);
        }
    const Node* name = module.document.find("module");
    if (name && name->is_string() && name->string != module.spec.name)
        fault(name->place,
              "the module '" + name->string + "' is not the name of its folder, '" + module.spec.name + "'");
    manifest_.modules.push_back(module.spec);
}

void ManifestParser::declarations(const Reader& effect, SectionReader section_reader) {
    for (const Module& module : modules_) {
        reading_ = &module;
        (this->*section_reader)(Reader(module.document, module_block()));
    }
    reading_ = nullptr;
    (this->*section_reader)(effect);
}

bool ManifestParser::is_new(const std::string& thing, const Member& member) {
    const std::string name = thing + " '" + member.key + "'";
    const Declaration declaration{reading_ ? "the module '" + reading_->spec.name + "'" : "the effect",
                                  member.key_place};
    const auto [known, is_new] = declared_.emplace(name, declaration);
    // In one document a second key is a fault of its syntax.
    if (!is_new)
        fault(member.key_place, name + " is declared already by " + known->second.owner + " (" +
                                    to_string(known->second.place) + ")");
    return is_new;
}

}  // namespace aftershade
