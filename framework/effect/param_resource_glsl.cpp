// What a shader sees of a curve, file or table parameter.
#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <string>
#include <string_view>

#include "framework/core/units.h"
#include "framework/effect/param_resources.h"

namespace aftershade {

namespace {

std::string upper(const std::string& name) {
    std::string text = name;
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

/// "ObjectScales" for "object_scales".
std::string type_name(const std::string& name) {
    std::string text;
    bool begins = true;
    for (const char c : name) {
        if (c != '_') text += begins ? char(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = c == '_';
    }
    return text;
}

/// `text` with each "$name" replaced by what `values` has for it.
std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
    std::string result;
    for (std::size_t mark = text.find('$'); mark != text.npos; mark = text.find('$')) {
        const auto is_name = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
        const auto* end = std::find_if_not(text.begin() + mark + 1, text.end(), is_name);
        const std::size_t past = std::size_t(end - text.begin());
        const std::string name(text.substr(mark + 1, past - mark - 1));
        result += std::string(text.substr(0, mark)) + values.at(name);
        text.remove_prefix(past);
    }
    return result + std::string(text);
}

/// The float that the shader computes with, in brackets for its sign.
std::string literal(double value) {
    std::string text = format_number(double(float(value)));
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return "(" + text + ")";
}

std::string vec3_literal(const std::array<double, 3>& v) {
    return "vec3(" + literal(v[0]) + ", " + literal(v[1]) + ", " + literal(v[2]) + ")";
}

constexpr std::string_view kCurve = R"(layout(binding = $binding) uniform sampler2D $texture;
float $name(float x) {
    float at = clamp((x - $low) * $scale, 0.0, $last);
    int i = min(int(at), int($last) - 1);
    float a = texelFetch($texture, ivec2(i, 0), 0).r;
    float b = texelFetch($texture, ivec2(i + 1, 0), 0).r;
    return mix(a, b, at - float(i));
}
)";

std::string curve_glsl(const ParamSpec& spec, int binding) {
    const auto [low, high] = spec.domain;
    return filled(kCurve, {{"name", spec.name},
                           {"texture", spec.name + "_curve"},
                           {"binding", std::to_string(binding)},
                           {"low", literal(low)},
                           {"scale", literal((kCurveSamples - 1) / (high - low))},
                           {"last", literal(kCurveSamples - 1)}});
}

constexpr std::string_view kImage = R"(#define HAS_$upper 1
layout(binding = $binding) uniform sampler2D $name;
#define $size vec4(vec2(textureSize($name, 0)), 1.0 / vec2(textureSize($name, 0)))
)";

std::string image_glsl(const ParamSpec& spec, int binding) {
    return filled(kImage, {{"upper", upper(spec.name)},
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
    const std::string position = filled(kLutPosition, {{"low", vec3_literal(lut.domain_min)},
                                                       {"scale", vec3_literal(scale)},
                                                       {"last", literal(lut.size - 1)}});
    return filled(lut.dimensions == 3 ? kLut3d : kLut1d, {{"upper", upper(spec.name)},
                                                          {"binding", std::to_string(binding)},
                                                          {"name", spec.name},
                                                          {"texture", spec.name + "_lut"},
                                                          {"texel", spec.name + "_lut_texel"},
                                                          {"row", std::to_string(kLutRow)},
                                                          {"position", position}});
}

std::string_view column_type(const ParamSpec& column) {
    switch (column.type) {
        case ParamType::bool_: return "bool";
        case ParamType::int_:
        case ParamType::enum_: return "int";
        case ParamType::vec2: return "vec2";
        case ParamType::color:
        case ParamType::vec3: return "vec3";
        case ParamType::vec4: return "vec4";
        default: return "float";
    }
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
        columns += "    " + std::string(column_type(column)) + " " + column.name + ";\n";
        for (std::size_t i = 0; i < column.values.size(); ++i)
            defines += "#define " + upper(spec.name + "_" + column.name + "_" + column.values[i]) + " " +
                       std::to_string(i) + "\n";
    }
    const std::string count = spec.name + "_count", entries = spec.name + "_entries";
    const std::string search = has_rows ? filled(kSearch, {{"count", count}, {"entries", entries}}) : "";
    return filled(kTable, {{"defines", defines},
                           {"columns", columns},
                           {"search", search},
                           {"row", type_name(spec.name) + "Row"},
                           {"entry", type_name(spec.name) + "Entry"},
                           {"block", type_name(spec.name) + "Table"},
                           {"binding", std::to_string(binding)},
                           {"name", function},
                           {"count", count},
                           {"default", spec.name + "_default"},
                           {"entries", entries}});
}

constexpr std::string_view kScattering = R"(#define $upper_GAUSSIANS $gaussians
vec3 $sample($row row, int kind, float r) {
    float at = sqrt(clamp(r / row.reach, 0.0, 1.0)) * $last;
    int i = min(int(at), int($last) - 1), line = 4 * row.index + kind;
    return mix(texelFetch($curves, ivec2(i, line), 0).rgb, texelFetch($curves, ivec2(i + 1, line), 0).rgb, at - float(i));
}
vec3 $radial($row row, float r) { return r > row.reach ? vec3(0.0) : $sample(row, 0, r); }
vec3 $within($row row, float r) { return $sample(row, 1, r); }
vec3 $line($row row, float x) { return $sample(row, 2, x); }
vec3 $variance($row row, int k) { return texelFetch($curves, ivec2(2 * k, 4 * row.index + 3), 0).rgb; }
vec3 $weight($row row, int k) { return texelFetch($curves, ivec2(2 * k + 1, 4 * row.index + 3), 0).rgb; }
)";

std::string scattering_glsl(const ParamSpec& spec) {
    std::map<std::string, std::string> values = {
        {"upper_GAUSSIANS", upper(spec.name) + "_GAUSSIANS"},
        {"gaussians", std::to_string(ScatteringProfile::kMaxGaussians)},
        {"row", type_name(spec.name) + "Row"},
        {"last", literal(kScatteringSamples - 1)}};
    for (const char* part : {"curves", "sample", "radial", "within", "line", "variance", "weight"})
        values[part] = spec.name + "_" + part;
    return filled(kScattering, values);
}

}  // namespace

std::string scattering_sampler_glsl(const ParamSpec& spec, int binding) {
    return "layout(binding = " + std::to_string(binding) + ") uniform sampler2D " + spec.name + "_curves;\n";
}

std::string param_resource_glsl(const ParamSpec& spec, const ParamFile& file, int binding, bool has_rows) {
    if (spec.type == ParamType::curve) return curve_glsl(spec, binding);
    if (spec.type == ParamType::table) return table_glsl(spec, spec.name, binding, has_rows);
    if (spec.type == ParamType::objects)
        return table_glsl(spec, spec.name + "_row", binding, has_rows) + "bool " + spec.name +
               "(uint object_id) { return " + spec.name + "_row(object_id).listed; }\n";
    if (spec.type == ParamType::scattering_profile)
        return table_glsl(spec, spec.name, binding, has_rows) + scattering_glsl(spec);
    if (const auto* lut = std::get_if<Lut>(&file)) return lut_glsl(spec, *lut, binding);
    return std::holds_alternative<Image>(file) ? image_glsl(spec, binding) : "";
}

}  // namespace aftershade
