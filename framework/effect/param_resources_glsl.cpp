// What a shader sees of a curve, file or table parameter.
#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "framework/document/glsl_text.h"
#include "framework/document/param_type.h"
#include "framework/effect/param_resources.h"

namespace aftershade {

namespace {

std::string glsl_vec3(const std::array<double, 3>& v) {
    return "vec3(" + glsl_float(v[0]) + ", " + glsl_float(v[1]) + ", " + glsl_float(v[2]) + ")";
}

constexpr std::string_view kImage = R"(#define HAS_$upper 1
layout(binding = $binding) uniform sampler2D $name;
#define $size vec4(vec2(textureSize($name, 0)), 1.0 / vec2(textureSize($name, 0)))
)";

std::string image_glsl(const ParamSpec& spec, int binding) {
    return filled(kImage, {{"upper", upper_case(spec.name)},
                           {"binding", std::to_string(binding)},
                           {"name", spec.name},
                           {"size", spec.name + "_size"}});
}

/// Where rgb lies in the table, in samples, and its fraction beyond sample i.
constexpr std::string_view kLutPosition =
    R"(    vec3 at = clamp((rgb - $low) * $scale, vec3(0.0), vec3($last));
    ivec3 i = min(ivec3(at), ivec3($last) - 1);
    vec3 f = at - vec3(i);
)";

constexpr std::string_view kLut1d = R"(#define HAS_$upper 1
layout(binding = $binding) uniform sampler2D $texture;
vec4 $texel(int i) {
    return texelFetch($texture, ivec2(i % $row, i / $row), 0);
}
vec3 $name(vec3 rgb) {
$position    vec3 a = vec3($texel(i.r).r, $texel(i.g).g, $texel(i.b).b);
    vec3 b = vec3($texel(i.r + 1).r, $texel(i.g + 1).g, $texel(i.b + 1).b);
    return mix(a, b, f);
}
)";

/// The cell is cut into six tetrahedra along the diagonal from its low to its high corner, on which grey
/// lies: Kasson, Plouffe and Nin 1993, "Tetrahedral interpolation technique for color space conversion",
/// doi:10.1117/12.149035. From the low corner go first along the largest fraction, then along the middle one.
constexpr std::string_view kLut3d = R"(#define HAS_$upper 1
layout(binding = $binding) uniform sampler2DArray $texture;
vec3 $name(vec3 rgb) {
$position    bool rg = f.r >= f.g, gb = f.g >= f.b, rb = f.r >= f.b;
    ivec3 one = rg && rb ? ivec3(1, 0, 0) : gb && !rg ? ivec3(0, 1, 0) : ivec3(0, 0, 1);
    ivec3 two = gb && rb ? ivec3(1, 1, 0) : rg && !gb ? ivec3(1, 0, 1) : ivec3(0, 1, 1);
    float high = max(max(f.r, f.g), f.b);
    float low = min(min(f.r, f.g), f.b);
    float middle = max(min(f.r, f.g), min(max(f.r, f.g), f.b));
    return (1.0 - high) * texelFetch($texture, i, 0).rgb
        + (high - middle) * texelFetch($texture, i + one, 0).rgb
        + (middle - low) * texelFetch($texture, i + two, 0).rgb
        + low * texelFetch($texture, i + 1, 0).rgb;
}
)";

std::string lut_glsl(const ParamSpec& spec, const Lut& lut, int binding) {
    std::array<double, 3> scale{};
    for (std::size_t c = 0; c < 3; ++c) scale[c] = (lut.size - 1) / (lut.domain_max[c] - lut.domain_min[c]);
    const std::string position = filled(kLutPosition, {{"low", glsl_vec3(lut.domain_min)},
                                                       {"scale", glsl_vec3(scale)},
                                                       {"last", glsl_float(lut.size - 1)}});
    return filled(lut.dimensions == 3 ? kLut3d : kLut1d, {{"upper", upper_case(spec.name)},
                                                          {"binding", std::to_string(binding)},
                                                          {"name", spec.name},
                                                          {"texture", spec.name + "_lut"},
                                                          {"texel", spec.name + "_lut_texel"},
                                                          {"row", std::to_string(kLutRow)},
                                                          {"position", position}});
}

std::string transform_glsl(const ParamSpec& spec, const ColorTransform& transform, int binding) {
    return "#define HAS_" + upper_case(spec.name) + " 1\nlayout(binding = " + std::to_string(binding) +
           ") uniform sampler2D " + spec.name + "_table;\n" + transform.glsl;
}

/// Looks for the first entry that ends at the id or beyond it.
constexpr std::string_view kTable = R"($defines
struct $row {
$columns};
struct $entry {
    uint first;
    uint last;
    $row row;
};
layout(std430, binding = $binding) readonly buffer $block {
    uint $count;
    $row $default;
    $entry $entries[];
};
$row $name(uint object_id) {
$search    return $default;
}
)";

/// Left out where there are no rows: llvmpipe would load both what it finds and the default, lane by lane,
/// for every pixel.
constexpr std::string_view kSearch = R"(    uint low = 0u, high = $count;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if ($entries[middle].last < object_id) low = middle + 1u;
        else high = middle;
    }
    if (low < $count && $entries[low].first <= object_id) return $entries[low].row;
)";

std::string table_glsl(const ParamSpec& spec, const std::string& function, int binding, bool has_rows) {
    std::string defines, columns;
    for (const ParamSpec& column : spec.columns) {
        columns += "    " + std::string(column.type->glsl_type) + " " + column.name + ";\n";
        for (std::size_t i = 0; i < column.values.size(); ++i)
            defines += "#define " + upper_case(spec.name + "_" + column.name + "_" + column.values[i]) + " " +
                       std::to_string(i) + "\n";
    }
    const std::string count = spec.name + "_count", entries = spec.name + "_entries";
    const std::string search = has_rows ? filled(kSearch, {{"count", count}, {"entries", entries}}) : "";
    return filled(kTable, {{"defines", defines},
                           {"columns", columns},
                           {"search", search},
                           {"row", camel_case(spec.name) + "Row"},
                           {"entry", camel_case(spec.name) + "Entry"},
                           {"block", camel_case(spec.name) + "Table"},
                           {"binding", std::to_string(binding)},
                           {"name", function},
                           {"count", count},
                           {"default", spec.name + "_default"},
                           {"entries", entries}});
}

}  // namespace

std::string param_sampler_glsl(const ParamSpec& spec, const ParamFile& file, int binding) {
    if (is_param_texture(spec.type)) return spec.type->texture->glsl(spec, binding);
    if (const auto* lut = std::get_if<Lut>(&file)) return lut_glsl(spec, *lut, binding);
    if (const auto* transform = std::get_if<ColorTransform>(&file))
        return transform_glsl(spec, *transform, binding);
    return std::holds_alternative<Image>(file) ? image_glsl(spec, binding) : "";
}

std::string param_table_glsl(const ParamSpec& spec, int binding, bool has_rows) {
    const AbstractParamTable& table = *spec.type->table;
    return table_glsl(spec, spec.name + std::string(table.lookup()), binding, has_rows) + table.glsl(spec);
}

}  // namespace aftershade
