// From an effect's shader file to the text that GL compiles, with a table back to the author's lines.
//
// A shader begins `#version 450 core` and `#include <pass>`. The host generates what <pass> stands for:
// samplers, images, storage blocks, outputs and the blocks `param`, `frame`, `camera`, `lights`, `pass` and
// `native` (docs/shaders.md). `#include <x.glsl>` takes a file of glsl/, `#include <module/x.glsl>` one of a
// module's folder there, `#include "x.glsl"` one of the including file's own folder; each is included once.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/param.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/manifest/manifest.h"
#include "framework/effect/param_reader.h"
#include "framework/effect/param_resources.h"
#include "framework/image/role.h"

namespace aftershade {

/// Bindings of the generated uniform blocks.
inline constexpr int kParamBinding = 0;
inline constexpr int kFrameBinding = 1;
inline constexpr int kSizeBinding = 2;  ///< a vec4 (w, h, 1/w, 1/h) for each of PassBindings::reads
inline constexpr int kCameraBinding = 3;
inline constexpr int kPassBinding = 4;  ///< only in passes with `repeat`
inline constexpr int kNativeBinding = 5;
inline constexpr int kLightsBinding = 6;  ///< only of effects with "uses": ["lights"]
/// Bindings of glsl/host/tiles.vert: the block, and the storage block with the rectangles of tiles.
inline constexpr int kTilesBinding = 7;
inline constexpr int kTileRunsBinding = 0;

/// A pass as one part of a fused program (framework/effect/fused_shader.h).
struct FusedPart {
    int first_sampler = 0;  ///< what is added to the bindings of samplers, uniform blocks and storage blocks
    int first_block = 0;
    int first_buffer = 0;
    std::vector<std::string> held;  ///< reads by the pixel, by their GLSL name, that an earlier part makes
    std::vector<int> left_out;      ///< uniform blocks that its shader does not use, by their bindings

    bool is_held(const std::string& read) const {
        return std::find(held.begin(), held.end(), read) != held.end();
    }
    bool leaves_out(int block) const {
        return std::find(left_out.begin(), left_out.end(), block) != left_out.end();
    }
};

/// Files of shaders, each read once: most passes include the same ones. [one thread]
class ShaderTexts {
public:
    struct File {
        std::string text;
        std::string out_of_bounds;  ///< why it may not be read; empty where it may
        std::string fault;          ///< why it could not be read
    };
    const File& of(const std::filesystem::path& file);

private:
    std::map<std::string, File> files_;
};

/// The inputs of one pass, resolved for one set of parameters and inputs.
struct ShaderContext {
    const EffectManifest* manifest = nullptr;
    const PassSpec* pass = nullptr;
    ParamReader params;                       ///< define-bound values become preprocessor symbols
    std::vector<std::string> present_inputs;  ///< optional inputs that the frame has
    std::filesystem::path glsl_folder;
    /// The content of file parameters, by parameter; nullptr or no entry: none has a file.
    const std::map<std::string, ParamFile>* files = nullptr;
    const FusedPart* part = nullptr;  ///< nullptr: the pass is a program by itself
    ShaderTexts* texts = nullptr;     ///< of several passes; nullptr: reads the pass's files itself

    const ParamFile& file_of(const std::string& param) const;
};

/// Where everything of a pass is bound. The GLSL is written from this and the host binds by it.
struct PassBindings {
    std::vector<ReadSpec> reads;  ///< sampler i is reads[i]
    int first_param_sampler = 0;  ///< then one for each curve and each file that is given ...
    std::vector<const ParamSpec*> param_samplers;
    int first_native_sampler = 0;  ///< ... and one for each native table
    std::vector<const NativeTableSpec*> native_tables;
    std::vector<WriteSpec> writes;  ///< target i is writes[i]
    /// The writes with has_size_of_target(): in the block of sizes behind the reads.
    std::vector<WriteSpec> sized_writes;
    std::vector<AccessSpec> images;   ///< image unit i is images[i]
    std::vector<AccessSpec> buffers;  ///< storage block i is buffers[i]
    int first_param_buffer = 0;       ///< then one for each table parameter
    std::vector<const ParamSpec*> param_buffers;
    bool has_param_block = false;
    bool has_pass_block = false;
    bool has_native_block = false;
    bool has_sizes() const { return !reads.empty() || !sized_writes.empty() || has_tile_grid; }
    /// For a pass that lists tiles, or draws over them with a vertex shader of its own, the block of sizes
    /// ends with a vec4 `tile_grid_size`, how many texels of the tile list's grid the pass's target has, or
    /// what the list is of. Other draws over tiles have it in the block of glsl/host/tiles.vert.
    bool has_tile_grid = false;
};

/// Pointers are into the context's manifest.
PassBindings pass_bindings(const ShaderContext& context);

/// A draw of instances has two shaders, every other pass one.
enum class ShaderFile { main, vertex };

/// Where a pass's shader begins: the author's file, or the host's own where tiles are listed or drawn over.
std::filesystem::path shader_path(const PassSpec& pass, ShaderFile file,
                                  const std::filesystem::path& glsl_folder);

/// The type of a texel as GLSL declares it: float, uint, vec2, uvec4.
std::string texel_type(gpu::TextureFormat format);

/// Bounds of a shader with its includes. A driver's compiler does not give up by itself: Mesa 22.3.6 runs out
/// of stack on an expression of 20,000 terms, and takes minutes for large arrays.
inline constexpr std::uintmax_t kMaxShaderFileBytes = 1024 * 1024;
inline constexpr std::size_t kMaxShaderBytes = 2 * 1024 * 1024;
inline constexpr std::size_t kMaxShaderLines = 20'000;
inline constexpr int kMaxIncludeDepth = 64;

struct ShaderInclude {
    std::string name;
    bool is_shared = false;  ///< in <>, else in quotation marks
};

/// The file that a line of a shader includes; nullopt for every other line.
std::optional<ShaderInclude> parse_include(std::string_view line);

/// Faults (a missing include, a shader that does not begin as it must) go to `diagnostics`.
ShaderSource assemble_shader(const ShaderContext& context, Diagnostics& diagnostics,
                             ShaderFile file = ShaderFile::main);

/// The text that authors wrote, with its includes and without what the host generates; the pass need not be
/// sound. A missing include goes to `diagnostics`. `texts` as in ShaderContext.
ShaderSource author_text(const EffectManifest& manifest, const PassSpec& pass,
                         const std::filesystem::path& glsl_folder, Diagnostics& diagnostics, ShaderFile file,
                         ShaderTexts* texts = nullptr);

/// The texture of a pass that lists tiles by it, where TileListSpec::has_common_text().
inline const std::string kListedSampler = "listed";

/// The text of `#include <pass>`; a vertex shader's has no outputs.
std::string interface_glsl(const ShaderContext& context, ShaderFile file = ShaderFile::main);

/// The reads of a pass that are there: textures and inputs that are present, where their conditions hold.
/// Their order gives the sampler bindings.
std::vector<ReadSpec> present_reads(const EffectManifest& manifest, const PassSpec& pass,
                                    const ParamReader& params,
                                    const std::vector<std::string>& present_inputs);

/// The writes of a pass whose conditions hold; their order is that of the targets.
std::vector<WriteSpec> present_writes(const PassSpec& pass, const ParamReader& params,
                                      const std::vector<std::string>& present_inputs);

/// Whether every condition of the pass holds, and at least one of the things that it writes is there.
bool pass_enabled(const PassSpec& pass, const ParamReader& params,
                  const std::vector<std::string>& present_inputs);

/// Whether the shaders of a pass with this write have `out_<name>_size`: its texture's size is a formula.
bool has_size_of_target(const EffectManifest& manifest, const WriteSpec& write);

/// Format of an input's or output's texture: its role's channels as floats, or unsigned integers.
gpu::TextureFormat texture_format_of_role(const RoleId& role);

/// Format of a read's, a write's or an image's texture.
gpu::TextureFormat format_of_read(const EffectManifest& manifest, const std::string& name);
gpu::TextureFormat format_of_write(const EffectManifest& manifest, const std::string& name);

/// The block `param` in std140, in the manifest's order: every parameter of a block type that is bound as a
/// uniform.
std::vector<std::byte> param_block(const EffectManifest& manifest, const ParamSet& params);
/// Its size, the same for all values.
std::size_t param_block_bytes(const EffectManifest& manifest);
bool has_param_block(const EffectManifest& manifest);

/// Values of native uniforms by name, as many as the type has components.
using NativeValues = std::map<std::string, std::vector<double>>;
/// The block `native` in std140, in the manifest's order; what has no value is 0.
std::vector<std::byte> native_block(const EffectManifest& manifest, const NativeValues& values);
bool has_native_block(const EffectManifest& manifest);

/// The block `pass` of a repeated pass.
struct PassBlock {
    std::int32_t index = 0;  ///< 0 .. count - 1
    std::int32_t count = 1;
    std::int32_t padding[2] = {0, 0};
};

/// The block `frame`; the same for every pass of a frame except `step_seed`.
struct FrameBlock {
    std::int32_t display_size_px[2] = {0, 0};  ///< of the display window, at the rendered scale
    std::int32_t origin_px[2] = {0, 0};  ///< display-window pixel of texel (0, 0), at the rendered scale
    std::int32_t number = 0;             ///< of the frame
    std::uint32_t step_seed = 0;         ///< differs between the steps of a look
    float fps = 0;                       ///< frames per second; 0 where unknown
    std::int32_t history_valid = 0;      ///< 0 on the first frame and after a cut, a gap or a change of size
    float rec709_from_color[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};  ///< by columns, each a vec4
    std::int32_t size_px[2] = {0, 0};                                            ///< of the working grid
    std::int32_t full_display_size_px[2] = {0, 0};  ///< of the display window at full scale
    float scale = 1;            ///< rendered over full scale; parameters in px are already scaled
    std::int32_t subframe = 0;  ///< 0 .. subframe_count - 1
    std::int32_t subframe_count = 1;
    float subframe_time = 0;  ///< within the frame, -1/2 .. 1/2
};
/// Each with a binding of its own: kFrameBinding and so on.
std::string_view frame_block_glsl();

/// A mat4 as GLSL lays it out: 16 floats by columns.
using ColumnMatrix = std::array<float, 16>;
inline constexpr ColumnMatrix kIdentityMatrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

/// The block `camera` (docs/shaders.md): view looks along -z, NDC z in [0, 1], +y up. Lens values are 0 where
/// unknown.
struct CameraBlock {
    ColumnMatrix view_from_world = kIdentityMatrix;
    ColumnMatrix world_from_view = kIdentityMatrix;
    ColumnMatrix clip_from_view = kIdentityMatrix;
    ColumnMatrix view_from_clip = kIdentityMatrix;
    ColumnMatrix clip_from_world = kIdentityMatrix;
    ColumnMatrix world_from_clip = kIdentityMatrix;
    ColumnMatrix prev_clip_from_world = kIdentityMatrix;
    ColumnMatrix prev_view_from_world = kIdentityMatrix;
    ColumnMatrix prev_clip_from_view = kIdentityMatrix;  ///< from this frame's view: no far world's rounding
    ColumnMatrix prev_view_from_view = kIdentityMatrix;
    float position_m[3] = {0, 0, 0};  ///< in the world
    float padding = 0;
    float jitter_px[2] = {0, 0};  ///< offset of the sample from the pixel's centre, +y down
    float prev_jitter_px[2] = {0, 0};
    float focal_length_mm = 0;
    float sensor_width_mm = 0;
    float focus_distance_m = 0;
    float f_number = 0;
    std::int32_t has_matrices = 0;       ///< the matrices of this frame are known
    std::int32_t has_prev_matrices = 0;  ///< those of the frame before are known
    std::int32_t end_padding[2] = {0, 0};
};
std::string_view camera_block_glsl();

/// One light of the block `lights`; what its kind does not have is 0.
struct LightEntry {
    float position_m[3] = {0, 0, 0};  ///< world; of an area light its centre
    std::int32_t kind = 0;            ///< LIGHT_POINT, LIGHT_DIRECTIONAL, LIGHT_AREA: 0, 1, 2
    float direction[3] = {0, 0, 0};   ///< world, unit length, the way the light shines
    float padding = 0;
    float intensity[3] = {0, 0, 0};  ///< W/sr of a point, W/m^2 of a directional, W/(m^2 sr) of an area light
    float end_padding = 0;
    float size_m[2] = {0, 0};
    float array_padding[2] = {0, 0};
};
/// Most lights that shaders get.
inline constexpr std::size_t kMaxShaderLights = 16;
/// The block `lights` of effects with "uses": ["lights"].
struct LightsBlock {
    std::int32_t count = 0;
    std::int32_t padding[3] = {0, 0, 0};
    LightEntry light[kMaxShaderLights];
};
std::string_view lights_block_glsl();

// std140 (OpenGL 4.5 core, section 7.6.2.2): scalars align to 4 bytes, vec2 to 8, vec3, vec4 and matrices to
// 16, and a scalar may fill the fourth place of a vec3, which jitter_px cannot.
static_assert(offsetof(FrameBlock, origin_px) == 8 && offsetof(FrameBlock, number) == 16);
static_assert(offsetof(FrameBlock, fps) == 24 && offsetof(FrameBlock, history_valid) == 28);
static_assert(offsetof(FrameBlock, rec709_from_color) == 32 && offsetof(FrameBlock, size_px) == 80);
static_assert(offsetof(FrameBlock, scale) == 96 && sizeof(FrameBlock) == 112);
static_assert(offsetof(CameraBlock, clip_from_world) == 256 && offsetof(CameraBlock, position_m) == 640);
static_assert(offsetof(CameraBlock, jitter_px) == 656 && offsetof(CameraBlock, focal_length_mm) == 672);
static_assert(offsetof(CameraBlock, has_matrices) == 688 && sizeof(CameraBlock) == 704);
static_assert(offsetof(LightEntry, kind) == 12 && offsetof(LightEntry, direction) == 16);
static_assert(offsetof(LightEntry, intensity) == 32 && offsetof(LightEntry, size_m) == 48);
static_assert(offsetof(LightsBlock, light) == 16 && sizeof(LightEntry) == 64);
static_assert(sizeof(PassBlock) == 16);

}  // namespace aftershade
