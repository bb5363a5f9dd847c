#include "framework/color/color_glsl.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <string_view>

#include "framework/color/color_request.h"
#include "framework/document/glsl_text.h"

namespace aftershade {

namespace {

static_assert(kColorTableRow == 1 << 12, "the texts below shift by 12");
constexpr std::string_view kTexel = R"(vec3 $texel(int i) {
    return texelFetch($table, ivec2((i + $first) & ($row - 1), (i + $first) >> 12), 0).rgb;
}
)";

/// A curve: `at` as texture() takes it, so the sample lies at the middle of its texel.
constexpr std::string_view kCurve = R"(vec3 $curve(float x, int row) {
    float place = clamp(x * $width.0 - 0.5, 0.0, $width.0 - 1.0);
    int i = min(int(place), $width - 2);
    return mix($texel(row * $width + i), $texel(row * $width + i + 1), place - float(i));
}
vec3 $at(float x) { return $curve(x, 0); }
vec3 $at(vec2 at) { return $curve(at.x, int(at.y * $height.0)); }
)";

constexpr std::string_view kCube = R"(vec3 $at(vec3 at) {
    vec3 place = clamp(at * $width.0 - 0.5, 0.0, $width.0 - 1.0);
    ivec3 i = min(ivec3(place), ivec3($width - 2));
    vec3 f = place - vec3(i);
    int low = i.x + $width * (i.y + $width * i.z);
$between}
)";

constexpr std::string_view kTrilinear = R"(    vec3 a = mix($texel(low), $texel(low + 1), f.x);
    vec3 b = mix($texel(low + $width), $texel(low + $width + 1), f.x);
    vec3 c = mix($texel(low + $layer), $texel(low + $layer + 1), f.x);
    vec3 d = mix($texel(low + $layer + $width), $texel(low + $layer + $width + 1), f.x);
    return mix(mix(a, b, f.y), mix(c, d, f.y), f.z);
)";

/// As param_resources_glsl.cpp has it, with its source: first along the largest fraction, then the middle
/// one.
constexpr std::string_view kTetrahedral = R"(    bool xy = f.x >= f.y, yz = f.y >= f.z, xz = f.x >= f.z;
    int one = xy && xz ? 1 : yz && !xy ? $width : $layer;
    int two = yz && xz ? 1 + $width : xy && !yz ? 1 + $layer : $width + $layer;
    float high = max(max(f.x, f.y), f.z), least = min(min(f.x, f.y), f.z);
    float middle = max(min(f.x, f.y), min(max(f.x, f.y), f.z));
    return (1.0 - high) * $texel(low) + (high - middle) * $texel(low + one)
        + (middle - least) * $texel(low + two) + least * $texel(low + 1 + $width + $layer);
)";

/// The places are numbers' bits, which are logarithms of their sizes by powers of 2, and straight between
/// them.
constexpr std::string_view kBitCurve = R"(float $at(float x, int first) {
    uint bits = floatBitsToUint(x);
    int i = int(bits >> $shift) + first;
    vec2 line = texelFetch($table, ivec2(i & ($row - 1), i >> 12), 0).rg;
    return isnan(x) ? x : line.x + line.y * float(bits & ((1u << $shift) - 1u));
}
vec3 $name(vec3 rgb) { return vec3($at(rgb.r, $red), $at(rgb.g, $green), $at(rgb.b, $blue)); }
)";

std::string functions_of(const ShaderLut& lut, const std::string& table, std::size_t first) {
    const std::map<std::string, std::string> values = {{"texel", lut.sampler + "_texel"},
                                                       {"curve", lut.sampler + "_between"},
                                                       {"at", lut.sampler + "_at"},
                                                       {"table", table},
                                                       {"first", std::to_string(first)},
                                                       {"row", std::to_string(kColorTableRow)},
                                                       {"width", std::to_string(lut.width)},
                                                       {"height", std::to_string(lut.height)},
                                                       {"layer", std::to_string(lut.width * lut.width)}};
    std::string text = filled(kTexel, values);
    if (lut.dimensions < 3) return text + filled(kCurve, values);
    auto cube = values;
    cube["between"] = filled(lut.is_tetrahedral ? kTetrahedral : kTrilinear, values);
    return text + filled(kCube, cube);
}

void append_texels(const ShaderLut& lut, std::vector<float>& texels) {
    const std::size_t channels = std::size_t(lut.channels);
    for (std::size_t i = 0; i < lut.values.size(); i += channels) {
        for (std::size_t c = 0; c < 3; ++c) texels.push_back(lut.values[i + std::min(c, channels - 1)]);
        texels.push_back(1);
    }
}

}  // namespace

std::string glsl_with_table(std::string text, const std::vector<ShaderLut>& luts, const std::string& table,
                            std::vector<float>& texels) {
    std::string functions;
    for (const ShaderLut& lut : luts) {
        functions += functions_of(lut, table, texels.size() / 4);
        append_texels(lut, texels);
        text = std::regex_replace(text, std::regex("uniform sampler[123]D " + lut.sampler + ";"), "");
        text = std::regex_replace(text, std::regex("texture\\(" + lut.sampler + ", "), lut.sampler + "_at(");
    }
    return functions + text;
}

std::string glsl_of_curve(const BitCurve& curve, const std::string& name, const std::string& table,
                          std::vector<float>& texels) {
    const std::size_t first = texels.size() / 4;
    for (std::size_t i = 0; i < curve.values.size(); i += 2)
        texels.insert(texels.end(), {curve.values[i], std::ldexp(curve.values[i + 1], -curve.shift), 0, 1});
    const auto start = [&](std::size_t channel) {
        return std::to_string(first + (curve.is_common() ? 0 : channel * curve.size()));
    };
    return filled(kBitCurve, {{"name", name},
                              {"at", name + "_at"},
                              {"table", table},
                              {"row", std::to_string(kColorTableRow)},
                              {"shift", std::to_string(curve.shift)},
                              {"red", start(0)},
                              {"green", start(1)},
                              {"blue", start(2)}});
}

std::vector<float> table_of(const std::vector<float>& texels, int channels) {
    const std::size_t count = texels.size() / 4, row = kColorTableRow;
    std::vector<float> table(std::max<std::size_t>((count + row - 1) / row, 1) * row * std::size_t(channels));
    for (std::size_t i = 0; i < count; ++i)
        std::copy_n(&texels[i * 4], channels, &table[i * std::size_t(channels)]);
    return table;
}

}  // namespace aftershade
