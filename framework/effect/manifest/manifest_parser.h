// Reads the sections of effect.json. Internal to framework/effect.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "framework/effect/manifest/manifest.h"

namespace aftershade {

/// Why a value for every channel, or four of them, cannot stand in a texture of this format; "" where it can.
std::string why_not_in_format(const std::vector<double>& texel, gpu::TextureFormat format);

/// The enumerator that a text of `names`, which are in their order, stands for.
template <typename T>
T choice_of(const std::optional<std::string>& text, const std::vector<std::string>& names, T otherwise) {
    if (!text) return otherwise;
    return T(std::find(names.begin(), names.end(), *text) - names.begin());
}

class ManifestParser {
public:
    ManifestParser(EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {}

    void identity(ObjectReader& reader, const Node& node);
    /// Opens the modules that the effect names, for declarations().
    void modules(const Node& section, const std::filesystem::path& glsl_folder);
    /// Whether every module that was named could be read.
    bool has_all_modules() const { return !lacks_modules_; }
    /// The section `key` of every module, then the effect's own; nullptr: it has none.
    using SectionReader = void (ManifestParser::*)(const Node& section);
    void declarations(const std::string& key, const Node* own, SectionReader section_reader);
    void inputs(const Node& section);
    void outputs(const Node& section);
    void uses(const Node& section);
    void params(const Node& section);  ///< before everything that may count by one
    void textures(const Node& section);
    void buffers(const Node& section);
    void tiles(const Node& section);  ///< after textures
    void passes(const Node& section);
    void native(const Node& section);
    void presets(const Node& section);
    void telemetry(const Node& section);  ///< after textures

private:
    /// Limits of a count: of a number, and the least `min` that a parameter may have.
    struct CountLimits {
        int least = 1;
        int most = 1;
        int least_of_param = 1;
    };

    struct Module {
        ModuleSpec spec;
        Node document;
        std::map<std::string, const Node*> sections;  // of the document, by key
    };

    void module(const Node& item, const std::filesystem::path& glsl_folder);
    std::map<std::string, const Node*> module_sections(Module& module);
    /// Whether no module before has a `thing` of this name; otherwise a fault.
    bool is_new(const std::string& thing, const Member& member);
    void fault(const Place& place, std::string text) { diagnostics_.error(place, std::move(text)); }
    void identifier(const std::string& name, const Place& place, const std::string& thing);
    std::string role(ObjectReader& reader, const Node& node);
    void check_from(const ParamSpec& spec, const Place& place);
    void preset(const Member& member);
    void statistic(const Member& member);
    std::optional<TextureChannel> channel(const Node& node, const std::string& label);
    void histogram(const Node& node, TelemetrySpec& spec);

    CountSpec count(const Node& node, const std::string& key, const CountLimits& limits);
    void count_by_param(const Node& node, const std::string& key, const CountLimits& limits);
    std::int64_t integer_in(const Node& node, const std::string& key, std::int64_t least, std::int64_t most);
    std::vector<int> integers_in(const Node& node, const std::string& key, std::size_t size, int least,
                                 int most);
    GridSpec grid(ObjectReader& reader, bool may_be_fixed);
    std::optional<GridSpec> per(ObjectReader& reader);
    void mips(ObjectReader& reader, TextureSpec& texture);
    std::vector<double> numbers(const Node& node, const std::string& key);
    std::vector<double> texel(const Node& node, const std::string& key);
    void texture(const Member& member);
    void buffer(const Member& member);
    void check_words(const BufferSpec& buffer, const Node& node);
    void native_uniform(const Member& member);
    void native_table(const Member& member);

    void tile_list(const Member& member);
    void tiles_of_texture(const Node& of, TileListSpec& list);
    void pass_or_group(const Node& node, const std::vector<WhenSpec>& shared);
    void pass(const Node& node, const std::vector<WhenSpec>& shared);
    void shaders(ObjectReader& reader, const Node& node, PassSpec& pass);
    /// The items of "reads" and "writes". True where the rest is what the shaders' text names: the key is
    /// left out, or an item is "*".
    bool reads(const Node& owner, ObjectReader& reader, std::vector<ReadSpec>& reads);
    bool writes(const Node& owner, ObjectReader& reader, std::vector<WriteSpec>& writes);
    ReadSpec read(const Node& node);
    void read_options(const Member& member, ReadSpec& read);
    WriteSpec write(const Node& node);
    int level(const Node& node, const std::string& key, int most);
    std::vector<AccessSpec> accesses(const Node& section, const std::string& thing);
    void add_conditions(const Node& section, std::vector<WhenSpec>& conditions);
    WhenSpec when(const Member& member);
    void define(PassSpec& pass, const Member& member);
    InstanceSpec instances(const Node& node);
    DispatchSpec dispatch(const Node& node);

    EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    std::list<Module> modules_;  // a list: sections point into its documents
    bool lacks_modules_ = false;
    const Module* reading_ = nullptr;  // the module that is being read; nullptr: the effect
    struct Declaration {
        std::string owner;  // "the module 'x'"
        Place place;
    };
    std::map<std::string, Declaration> declared_;  // by "texture 'x'"
    std::set<std::string> faulty_params_;          // declared, but with faults that are already told
};

}  // namespace aftershade
