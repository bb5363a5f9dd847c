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

#include "framework/color/color_transform.h"
#include "framework/document/param.h"
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

/// The content of a file parameter's path; none for "", but a config's "" is the user's.
using ParamFile = std::variant<std::monostate, Image, Lut, ColorTransform>;

/// Reads the file of a file parameter; "" is none. Relative paths are the caller's to resolve. nullopt after
/// faults, which name the file (and a LUT's lines). One with is_ocio_file() is not for this function.
std::optional<ParamFile> load_param_file(const ParamSpec& spec, const std::filesystem::path& path,
                                         Diagnostics& diagnostics);

/// Texels in a row of a 1-D LUT: its most samples, 65536, are more than a side of a texture may have.
inline constexpr int kLutRow = kColorTableRow;

/// The GLSL that declares the sampler of a parameter at `binding` and the function or the names to read it,
/// each on its own line:
///
///     curve   float falloff(float x)            x clamped to the domain
///     image   sampler2D stain, stain_size       vec4(w, h, 1/w, 1/h); HAS_STAIN
///     lut     vec3 grade(vec3 rgb)              clamped to its domain, tetrahedral; HAS_GRADE
///     ocio    vec3 view(vec3 rgb)               what OpenColorIO makes; HAS_VIEW
///
/// "" for a file parameter without a file. For a LUT the text has size, dimension and domain, so that it
/// differs between LUTs of different shape.
std::string param_sampler_glsl(const ParamSpec& spec, const ParamFile& file, int binding);

/// The GLSL that declares the storage block of a parameter at `binding` and what looks an object up in it:
///
///     table   ScalesRow scales(uint object_id)  with the columns as members; enums are ints, and
///                                               SCALES_MODE_SOFT their values' names
///     objects bool skin(uint object_id)         whether the list has it; of an empty list true
///
/// and what the type adds (framework/scattering/param_scattering.h). Without `has_rows` a table gives its
/// default and does not search.
std::string param_table_glsl(const ParamSpec& spec, int binding, bool has_rows = true);

/// The format of a texture with 1 or 4 channels: r32f or rgba32f.
gpu::TextureFormat param_texture_format(int channels);
/// The texels that its type makes of a value. There must be a texture of that type: is_param_texture().
ParamTexture param_texture(const ParamSpec& spec, const ParamValue& value);
/// rgba32f, or rg32f for OpenColorIO's curves. There must be a file. OpenColorIO's has rows of kLutRow. A 3-D
/// LUT has blue for its layer, green its row; a 1-D one is laid out in rows of kLutRow.
ParamTexture file_texture(const ParamFile& file);

/// The id of an object by its name; nullopt for a name that does not exist.
using ObjectIds = std::function<std::optional<std::uint32_t>(const std::string&)>;

/// Bytes of the storage block of a parameter that shaders look up by object, with room for that many entries:
/// count_entries() of its value.
std::size_t table_buffer_bytes(const ParamSpec& spec, std::size_t entries);

/// The bytes of a table's storage block, std430, at most table_buffer_bytes(). Rows whose name `ids` does not
/// resolve are left out: the caller reports them. A row by name goes before one by id; of two names for one
/// id the first.
std::vector<std::byte> table_buffer(const ParamSpec& spec, const TableValue& table, const ObjectIds& ids);

}  // namespace aftershade
