// Parameters that reach GLSL as a texture or a buffer instead of in the block `param`: curves, files, tables.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "framework/core/param.h"
#include "framework/gpu/texture.h"
#include "framework/image/image.h"
#include "framework/image/lut.h"

namespace aftershade {

/// Texels for one gpu::Texture, read by texelFetch alone: nearest, one level.
struct ParamTexture {
    int width = 0;
    int height = 0;
    int layers = 1;  ///< > 1: sampler2DArray
    gpu::TextureFormat format = gpu::TextureFormat::rgba32f;
    std::vector<float> texels;  ///< layer after layer, rows from the top, channels interleaved
};

/// What a file parameter's path holds; nothing for "".
using ParamFile = std::variant<std::monostate, Image, Lut>;

/// Reads the file of a file parameter; "" is none. Relative paths are the caller's to resolve. nullopt after
/// faults, which name the file (and a LUT's lines).
std::optional<ParamFile> load_param_file(const ParamSpec& spec, const std::filesystem::path& path,
                                         Diagnostics& diagnostics);

/// How many samples of a curve its texture holds, over the domain, both ends included. With d the domain's
/// length and h = d / 1023, the shader's value is the curve's but for at most h^2 / 8 times the largest
/// second derivative where it is smooth, at most h / 4 times the change of slope beside a corner, and
/// rounding to float; points nearer to each other than h may be passed over.
inline constexpr int kCurveSamples = 1024;

/// Texels in a row of a 1-D LUT: its most samples, 65536, are more than a side of a texture may have.
inline constexpr int kLutRow = 4096;

/// The GLSL that declares a curve, file or table parameter at `binding` (of a sampler; of a storage block for
/// a table) and the function or the names to read it, each on its own line:
///
///     curve   float falloff(float x)            x clamped to the domain
///     image   sampler2D stain, stain_size       vec4(w, h, 1/w, 1/h); HAS_STAIN
///     lut     vec3 grade(vec3 rgb)              clamped to its domain, tetrahedral; HAS_GRADE
///     table   ScalesRow scales(uint object_id)  with the columns as members; enums are ints, and
///                                               SCALES_MODE_SOFT their values' names
///     objects bool skin(uint object_id)         whether the list has it; of an empty list true
///
/// "" for a file parameter without a file. Of a LUT the text holds size, dimension and domain, so that it
/// differs between LUTs of different shape. Without `has_rows` a table gives its default and does not search.
std::string param_resource_glsl(const ParamSpec& spec, const ParamFile& file, int binding,
                                bool has_rows = true);

/// Of a scattering_profile at `binding` of a sampler: sampler2D scattering_profile_curves, which what
/// param_resource_glsl has for it at its storage block's binding reads:
///
///     ScatteringProfileRow scattering_profile(uint object_id)       index, d, direct, falloff, reach; mm
///     vec3 scattering_profile_radial(ScatteringProfileRow, float r) 2 pi r R(r), 1/mm; 0 beyond its reach
///     vec3 scattering_profile_within(ScatteringProfileRow, float r) share within r
///     vec3 scattering_profile_line(ScatteringProfileRow, float x)   edge response, x >= 0 into the lit side
///     vec3 scattering_profile_variance(ScatteringProfileRow, int k) of its Gaussian k, mm^2
///     vec3 scattering_profile_weight(ScatteringProfileRow, int k)   0 for those that it lacks
///     SCATTERING_PROFILE_GAUSSIANS                                  how many k there are
///     SCATTERING_PROFILE_IS_BURLEY                                  1: each profile is Burley's with its d,
///     else 0
///
/// Interpolation is linear between kScatteringSamples radii.
std::string scattering_sampler_glsl(const ParamSpec& spec, int binding);
/// rgba32f, kScatteringSamples wide; kScatteringRows rows for each of the value's profiles.
inline constexpr int kScatteringRows = 4;
ParamTexture scattering_texture(const ScatteringValue& value);

/// kCurveSamples x 1, r32f.
ParamTexture curve_texture(const ParamSpec& spec, const CurveValue& curve);
/// rgba32f. There must be a file. A 3-D LUT has blue for its layer, green its row; a 1-D one is laid out in
/// rows of kLutRow.
ParamTexture file_texture(const ParamFile& file);

/// The id of an object by its name; nullopt for a name that there is not.
using ObjectIds = std::function<std::optional<std::uint32_t>(const std::string&)>;

/// Of a table, objects and a scattering_profile what shaders look up by object.
TableValue table_of(const ParamValue& value);

/// Entries that the storage block of a table, objects or a scattering_profile has room for: one per row, and
/// one more for each name that may take its id out of a range. Depends on what kinds of keys there are, never
/// on what they say, so that content can change without another block.
std::size_t table_entries(const ParamValue& value);
/// Bytes of a storage block with room for that many entries.
std::size_t table_buffer_bytes(const ParamSpec& spec, std::size_t entries);

/// The bytes of a table's storage block, std430, at most table_buffer_bytes(). Rows whose name `ids` does not know are left out: the caller
/// has been asked and reports them. A row by name goes before one by id; of two names for one id the first.
std::vector<std::byte> table_buffer(const ParamSpec& spec, const TableValue& table, const ObjectIds& ids);

}  // namespace aftershade
