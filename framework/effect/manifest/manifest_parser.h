// Reads the sections of effect.json and module.json, which the grammar has checked (manifest_grammar.h), and
// reports what it does not cover: how the parts of a manifest stand to each other. Internal to
// framework/effect.
#pragma once

#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "framework/document/grammar_reader.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/effect/manifest/manifest_blocks.h"

namespace aftershade {

/// Why a value for every channel, or four of them, cannot stand in a texture of this format; "" where it can.
std::string why_not_in_format(const std::vector<double>& texel, gpu::TextureFormat format);

class ManifestParser {
public:
    using Reader = grammar::Reader;

    ManifestParser(EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {}

    void identity(const Reader& document);
    /// Opens the modules that the effect names, for declarations().
    void modules(const Reader& document, const std::filesystem::path& glsl_folder);
    /// Whether every module that was named could be read.
    bool has_all_modules() const { return !lacks_modules_; }
    /// A section of every module, then the effect's own.
    using SectionReader = void (ManifestParser::*)(const Reader& document);
    void declarations(const Reader& effect, SectionReader section_reader);
    void inputs(const Reader& document);
    void outputs(const Reader& document);
    void uses(const Reader& document);
    void reach(const Reader& document);   ///< after params
    void params(const Reader& document);  ///< before everything that may count by one
    void textures(const Reader& document);
    void buffers(const Reader& document);
    void tiles(const Reader& document);  ///< after textures
    void passes(const Reader& document);
    void native(const Reader& document);
    void presets(const Reader& document);
    void telemetry(const Reader& document);  ///< after textures

private:
    struct Module {
        ModuleSpec spec;
        Node document;
    };

    void module(const Node& item, const std::filesystem::path& glsl_folder);
    /// Whether no module before has a `thing` of this name; otherwise a fault.
    bool is_new(const std::string& thing, const Member& member);
    void fault(const Place& place, std::string text) { diagnostics_.error(place, std::move(text)); }
    void preset(const Member& member);
    void statistic(const Reader::Named& declared);
    std::optional<TextureChannel> channel(const Reader& reader, const std::string& key,
                                          const std::string& thing);

    /// 1 where there is none.
    CountSpec count(const Reader& reader, const std::string& key, const CountLimits& limits);
    void count_by_param(const Node& node, const std::string& key, const CountLimits& limits);
    GridSpec grid(const Reader& reader, bool may_be_fixed);
    void check_formula(const Node& node);
    std::optional<GridSpec> per(const Reader& reader);
    void texture(const Reader::Named& declared);
    void mips(const Reader& reader, TextureSpec& texture);
    void buffer(const Reader::Named& declared);
    void check_words(const BufferSpec& buffer, const Place& place);

    void copied(const Reader& reader, PassSpec& pass);
    void tile_list(const Reader::Named& declared);
    void tiles_of_texture(const Reader& reader, TileListSpec& list);
    PassSpec pass(const Reader& reader);
    void shaders(const Reader& reader, PassSpec& pass, const std::string& ending);
    DrawSpec drawn(const Reader& reader);
    InstanceSpec instances(const Reader& reader);
    DispatchSpec dispatch(const Reader& reader);

    EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    std::list<Module> modules_;
    bool lacks_modules_ = false;
    const Module* reading_ = nullptr;  // the module that is being read; nullptr: the effect
    struct Declaration {
        std::string owner;  // "the module 'x'"
        Place place;
    };
    std::map<std::string, Declaration> declared_;  // by "texture 'x'"
    std::set<std::string> faulty_params_;          // declared, with faults that have been reported
};

// ---- what passes and tile lists use (manifest_uses.cpp, manifest_when.cpp) ----

/// "name.prev" is the last frame's: takes the end off and returns whether it was there.
bool take_prev(std::string& name);
/// The items of "reads" and "writes". True where the rest is what the shaders' text names: the key is left
/// out, or an item is "*".
bool read_reads(const grammar::Reader& owner, std::vector<ReadSpec>& reads);
bool read_writes(const grammar::Reader& owner, std::vector<WriteSpec>& writes);
std::vector<AccessSpec> read_accesses(const grammar::Reader& pass, const std::string& key);
/// Those of "when"; none where it is absent.
void add_conditions(const grammar::Reader& owner, std::vector<WhenSpec>& conditions);
/// The numbers of a list that are integers; `size` of them, 1 where there are fewer.
std::vector<int> integers_of(const grammar::Reader& reader, const std::string& key, std::size_t size);

}  // namespace aftershade
