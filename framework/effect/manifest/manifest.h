// The declaration of an effect: effects/<id>/effect.json, and of what it shares: glsl/<module>/module.json.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/document/param.h"
#include "framework/gpu/commands.h"
#include "framework/gpu/texture.h"

namespace aftershade {

/// A condition on one parameter ("shape"), on whether a number is not 0 ("nonzero.gain"), on whether a
/// parameter is not at its identity ("changes.gamma") or on an optional input ("has.velocity"): any of these
/// values.
struct WhenSpec {
    std::string subject;
    std::vector<ParamValue> values;
    std::optional<ParamValue> identity;  ///< of the parameter, where it has one
    Place place;
};

/// An image that the effect takes. A shader reads it under its name; an optional one defines HAS_<NAME> when
/// present.
struct InputSpec {
    std::string name;
    std::string role;
    bool optional = false;
    bool history = false;  ///< last frame's image may be read too, as "<name>.prev"; zero where there is none
    int frame = 0;         ///< of the capture that many frames after; must be optional, for shots end
    int layer = -1;  ///< of a capture with layers, 0 in front, which must be optional; -1: the whole picture
    bool from_capture = false;  ///< the capture's image even where an earlier step makes that role
    /// All must hold, or the input is absent and its image is not read. On values of parameters alone, of
    /// optional inputs.
    std::vector<WhenSpec> when;
    std::string instead;  ///< another optional input: one of the two must be there; "": neither need be
    std::string doc;
    Place place;

    /// What the capture calls the image: the role, or that of the layer.
    std::string image_role() const;
};

/// An image that the effect makes. A pass writes it under its name; its texture has the role's channels as
/// floats.
struct OutputSpec {
    std::string name;
    std::string role;
    std::string doc;
    Place place;
};

/// A count that a manifest gives as a number or as the name of an int parameter.
struct CountSpec {
    int number = 1;
    std::string param;  ///< "" for the number
    bool operator==(const CountSpec&) const = default;
};

/// The room beside a texture begins at a multiple of this many texels.
inline constexpr int kRoomTexels = 64;

/// Extent of a texture, and of what is counted per texel.
struct GridSpec {
    enum class Kind { scale, tile, size };
    Kind kind = Kind::scale;
    double scale = 1;  ///< of the working grid's sides, rounded up
    /// With `scale`: further texels to the right and below, in its width and height.
    double room[2] = {0, 0};
    CountSpec tile;        ///< one texel per tile of this many px a side, rounded up
    int size[2] = {0, 0};  ///< fixed, in texels; of each side that has no formula
    /// Formula of a side: over "width" and "height" of the working grid and numbers of parameters. Its
    /// integer part, at least 1.
    std::string formula[2] = {};
    bool has_formula() const { return !formula[0].empty() || !formula[1].empty(); }
    bool has_room() const { return room[0] > 0 || room[1] > 0; }
    bool operator==(const GridSpec&) const = default;
};

/// What the formula of a size calls a side of the working grid.
inline bool is_grid_side(std::string_view name) {
    return name == "width" || name == "height";
}

/// A texture between passes; every one can be tapped.
struct TextureSpec {
    std::string name;
    gpu::TextureFormat format = gpu::TextureFormat::rgba32f;
    GridSpec grid;
    int layers = 1;  ///< > 1: an array, sampler2DArray
    int mips = 1;    ///< > 1: levels that passes write each; 0 with auto_mips: as many as fit
    bool auto_mips =
        false;  ///< the host fills levels 1.. with a box filter after each pass that writes level 0
    std::optional<std::vector<double>> clear;  ///< set to this at the beginning of each frame; 1 or 4 numbers
    bool history = false;                      ///< survives into the next frame, where "<name>.prev" reads it
    bool partial = false;                      ///< no pass reads a texel that none has drawn in this frame
    /// All must hold, or every read, write and image of it is absent.
    std::vector<WhenSpec> when;
    std::string doc;  ///< one sentence with the unit
    Place place;
};

/// An array in GPU memory: `<element> <name>[]` of a shader storage block.
struct BufferSpec {
    std::string name;
    std::string element;           ///< float, int, uint, vec2, vec4, ivec2, ivec4, uvec2, uvec4
    std::optional<GridSpec> grid;  ///< `count` elements per texel of this grid; without one, `count` in all
    CountSpec count;
    std::vector<double>
        clear;  ///< first words at the beginning of each frame, the rest 0; empty: not cleared
    bool history = false;
    bool indirect = false;  ///< holds the arguments of an indirect draw or dispatch: uint, at least 4
    std::string doc;
    Place place;
};

/// A level or a layer: a number, or "pass.index" of a repeated pass with a number added.
struct TurnIndex {
    int number = 0;
    bool is_of_pass = false;
    /// In turn `turn` of the pass.
    constexpr int in_turn(int turn) const { return is_of_pass ? turn + number : number; }
    constexpr bool operator==(const TurnIndex&) const = default;
};

struct ReadSpec {
    std::string name;       ///< of an input or a texture
    bool previous = false;  ///< "<name>.prev": as it was at the end of the last frame
    gpu::Filter filter = gpu::Filter::nearest;
    bool is_pixel = false;  ///< the shader has the texel at its own pixel, and no sampler
    gpu::Wrap wrap = gpu::Wrap::clamp;
    std::optional<TurnIndex> level;  ///< one level only; nullopt: all
    /// All must hold, or there is no sampler. With any, the shader has HAS_<NAME> where it is there.
    std::vector<WhenSpec> when;
    Place place;
    /// The sampler's name in GLSL: "color", "color_prev".
    std::string glsl_name() const { return previous ? name + "_prev" : name; }
};

struct WriteSpec {
    std::string name;  ///< of a texture or an output
    TurnIndex level, layer;
    /// All must hold, or there is no target. With any, the shader has HAS_OUT_<NAME> where it is there.
    std::vector<WhenSpec> when;
    Place place;
};

/// A texture bound as an image, or a buffer as a storage block.
struct AccessSpec {
    enum class Kind { read, write, atomic };
    std::string name;
    bool previous = false;  ///< buffers with history, read only
    Kind kind = Kind::read;
    std::vector<WhenSpec> when;  ///< of an image: its texture's, or it is absent
    Place place;
    std::string glsl_name() const { return previous ? name + "_prev" : name; }
};

/// Limits that hold on every machine, so that an effect means the same everywhere (OpenGL 4.5 core, table 23.
/// 53 and following; GL_MAX_TEXTURE_SIZE is llvmpipe's).
inline constexpr int kMaxTargets = 8;
inline constexpr int kMaxSamplers = 32;
inline constexpr int kMaxImages = 8;
inline constexpr int kMaxStorageBlocks = 8;
inline constexpr int kMaxSide = 16384;
inline constexpr int kMaxLayers = 256;
inline constexpr int kMaxRepeat = 4096;
inline constexpr int kMaxIterations = 60000;  ///< llvmpipe silently ends loops after 65,535

/// The primitive of a draw of instances, and their number.
struct InstanceSpec {
    enum class Primitive { quads, points };  ///< gl_VertexID 0..3 of a strip, or 0
    Primitive primitive = Primitive::quads;
    std::optional<GridSpec> grid;  ///< `count` per texel of this grid
    CountSpec count;
    std::string indirect;  ///< buffer of {vertices, instances, first, base}; "" for the count
    bool covers = false;   ///< the target as a whole, so that nothing has to fill it before
};

/// How many work groups a compute pass has.
struct DispatchSpec {
    enum class Kind { tile, groups, indirect };
    Kind kind = Kind::tile;
    CountSpec tile{8, ""};  ///< one group per tile of this many texels a side ...
    std::string over;       ///< ... of this texture; "" for the working grid
    int groups[3] = {1, 1, 1};
    std::string indirect;  ///< buffer of {x, y, z}
};

/// One channel of a texture: "history.a".
struct TextureChannel {
    std::string texture;
    int channel = 0;
    std::string text() const { return texture + "." + "rgba"[channel]; }
};

/// Tiles that draws are confined to. parse_manifest() writes a list out as two buffers and a compute pass of
/// the host's, which has the list's name and comes before the first pass over the list.
struct TileListSpec {
    std::string name;
    std::optional<TextureChannel> of;  ///< tiles where this is above 0, of a texture with a texel per tile
    std::string predicate;  ///< or else the file in `folder` with `bool <name>(ivec2 tile)`, which decides
    CountSpec tile;         ///< side in texels of `on`
    std::string on;         ///< the texture whose texels make up the tiles; "" for the working grid
    std::vector<ReadSpec> reads;   ///< the predicate's
    bool infers_reads = false;     ///< they are what the predicate's text names
    std::vector<WhenSpec> when;    ///< all must hold, or neither the list nor the passes over it are there
    std::filesystem::path folder;  ///< the effect's, or the module's
    std::string module;            ///< that declares it; "" for the effect itself
    std::string doc;
    Place place;
    /// Whether the list is of a texture and its tiles have a known side: its pass then has the same text in
    /// every effect.
    bool has_common_text() const { return of && tile.param.empty(); }
    std::string runs() const { return name + "_runs"; }  ///< buffer: see glsl/tile_runs.glsl
    std::string args() const { return name + "_args"; }  ///< buffer: {vertices, instances, first, base}
};

/// A draw over the full screen, over tiles, or of instances.
struct DrawSpec {
    std::optional<std::string> vertex;  ///< its vertex shader, a file; nullopt: the host's
    std::optional<std::string> over;    ///< the tile list that it is confined to
    std::optional<InstanceSpec> instances;
    gpu::Blend blend = gpu::Blend::none;
};

struct ComputeSpec {
    DispatchSpec dispatch;
    std::optional<std::string> lists;  ///< the tile list that the host's own pass fills
};

/// Sets what it writes.
struct ClearSpec {
    std::vector<double> value;  ///< 1 or 4 numbers
};

/// Copies the only texture that it reads to the only one that it writes.
struct CopySpec {};

struct PassSpec {
    std::string name;
    std::variant<DrawSpec, ComputeSpec, ClearSpec, CopySpec> work;
    std::filesystem::path folder;  ///< of its shaders: the effect's, or its module's
    std::string module;            ///< that declares it; "" for the effect itself
    std::string shader;  ///< file in that folder; "" where the host has all of the text, or none runs
    std::vector<ReadSpec> reads;
    std::vector<WriteSpec> writes;  ///< textures and outputs, in the order of the attachments
    std::vector<AccessSpec> images;
    std::vector<AccessSpec> buffers;
    std::map<std::string, std::string> defines;
    std::vector<WhenSpec> when;       ///< all must hold
    std::optional<CountSpec> repeat;  ///< the shader reads its turn as pass.index, 0 .. pass.count - 1
    int max_iterations = 0;      ///< upper bound of the loop iterations of one invocation; 0: not declared
    bool infers_reads = false;   ///< the manifest leaves `reads` to the shaders' text
    bool infers_writes = false;  ///< likewise `writes`
    Place place;
    const DrawSpec* draw() const { return std::get_if<DrawSpec>(&work); }
    DrawSpec* draw() { return std::get_if<DrawSpec>(&work); }
    const ComputeSpec* compute() const { return std::get_if<ComputeSpec>(&work); }
    const ClearSpec* clear() const { return std::get_if<ClearSpec>(&work); }
    bool copies() const { return std::holds_alternative<CopySpec>(work); }
    bool runs_shader() const { return draw() || compute(); }
    /// Whether it draws over the full screen, where a pixel is a texel: no vertex shader, its own or the
    /// host's over tiles, places quads or points.
    bool fills_screen() const { return draw() && !vertex() && !over(); }
    /// nullptr for none.
    const std::string* vertex() const { return draw() && draw()->vertex ? &*draw()->vertex : nullptr; }
    const std::string* over() const { return draw() && draw()->over ? &*draw()->over : nullptr; }
    const std::string* lists() const { return compute() && compute()->lists ? &*compute()->lists : nullptr; }
    /// The author's files that it runs.
    std::vector<std::string> shader_files() const;
};

/// A value or an array that the effect's native code fills before each frame.
struct NativeUniformSpec {
    std::string name;  ///< "native.<name>" in GLSL
    std::string type;  ///< float, int, uint, vec2, vec3, vec4
    std::string doc;
    Place place;
};
struct NativeTableSpec {
    std::string name;
    std::string element;  ///< float, vec2, vec4, uint, uvec2, uvec4
    int width = 0;        ///< most elements a row, up to 1024
    int height = 1;       ///< rows, up to 1024; read by texelFetch from a 2-D sampler
    std::string doc;
    Place place;
};
struct NativeSpec {
    std::vector<NativeUniformSpec> uniforms;
    std::vector<NativeTableSpec> tables;
    Place place;
};

/// Parameters, textures, buffers and passes that effects share; they stand before the effect's own.
struct ModuleSpec {
    std::string name;
    std::string summary;
    std::filesystem::path folder;       ///< glsl/<name>, with module.json and its shaders
    std::vector<std::string> before{};  ///< modules whose effects belong after this one's in a look
};

struct PresetSpec {
    std::string name;
    std::map<std::string, ParamValue> values;
};

/// A number for each frame out of a texture: what `run --telemetry` writes.
struct TelemetrySpec {
    using Channel = TextureChannel;
    std::string name;
    Channel of;
    std::optional<Channel> where;  ///< only texels where this is above 0; a texture of the same size
    bool squared = false;          ///< a deviation is written as variance
    double from = 0;               ///< of the histogram: `bins` of one width; what lies outside goes to the
    double to = 0;                 ///< first and last
    int bins = 0;                  ///< 0: no histogram
    std::string doc;               ///< one sentence with the unit
    Place place;
};

/// "warmup": how soon an effect forgets that its history began.
struct WarmupSpec {
    int frames = 0;    ///< rendered before the first frame that counts
    double error = 0;  ///< what then remains: 99th percentile of the difference, over the picture's mean
};
inline constexpr int kMaxWarmupFrames = 4096;

/// "reach": how far around a pixel of an output the pixels of the inputs lie that it depends on, in x and y.
struct ReachSpec {
    bool is_all = false;              ///< the whole frame
    int px = 0;                       ///< as rendered ...
    std::vector<std::string> params;  ///< ... and the values of these, in px
    Place place;
};
inline constexpr int kMaxReachPx = 16384;
/// How many frames before or behind its own an input may be of.
inline constexpr int kMostFrameOffset = 3;

/// "lens", "shutter" and so on, in the order in which lists have them.
const std::vector<std::string>& effect_groups();

struct EffectManifest {
    std::string id;
    std::string version;
    std::string summary;
    std::string group;            ///< one of effect_groups(); "" for none
    bool is_recommended = false;  ///< of its group, for what most looks need
    std::vector<std::string> sources;
    std::vector<ModuleSpec> modules;
    std::optional<Place>
        uses_lights;  ///< "uses": ["lights"]: its shaders have the block `lights`; where it says so
    std::vector<InputSpec> inputs;
    std::vector<OutputSpec> outputs;
    std::vector<ParamSpec> params;
    std::vector<TextureSpec> textures;
    std::vector<BufferSpec> buffers;  ///< with those of tile lists
    std::vector<TileListSpec> tiles;
    std::vector<PassSpec> passes;  ///< with those of tile lists
    std::optional<NativeSpec> native;
    bool accumulates_subframes = false;  ///< "accumulates": "subframes": runs for each, emits at the last
    bool is_in_display_window = false;   ///< "window": "display": works on that window, whatever the data's
    std::optional<WarmupSpec> warmup;
    std::optional<ReachSpec> reach;  ///< nullopt: the passes decide (framework/look/reach.h)
    /// Some shader takes a place or a size from the part of the frame that is rendered, which it does not
    /// count from the display window. Known where there is no `reach`.
    bool counts_from_part = false;
    std::vector<PresetSpec> presets;
    std::vector<TelemetrySpec> telemetry;
    std::filesystem::path folder;
    std::filesystem::path document;  ///< what declares it: folder / "effect.json", or a file of another host
    /// Shaders of the host's making that stand for files of `folder`, by name.
    std::map<std::string, std::string> generated;

    /// Text of a shader's file; nullptr: the file is on the disk.
    const std::string* find_generated(const std::filesystem::path& file) const;
    const InputSpec* find_input(const std::string& name) const;
    const OutputSpec* find_output(const std::string& name) const;
    const ParamSpec* find_param(const std::string& name) const;
    const TextureSpec* find_texture(const std::string& name) const;
    const BufferSpec* find_buffer(const std::string& name) const;
    /// The one that the pass fills or is confined to; nullptr for none.
    const TileListSpec* tile_list_of(const PassSpec& pass) const;
    bool has_history() const;  ///< of any texture, buffer or input
    const PresetSpec* find_preset(const std::string& name) const;
    std::vector<std::string> param_names() const;
    /// The greatest value of a count: its number, or its parameter's `max`.
    int most_of(const CountSpec& count) const;
};

}  // namespace aftershade
