#include "framework/effect/compute_form.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <utility>

#include "framework/document/glsl_text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/gpu/commands.h"

namespace aftershade {

namespace {

/// As long as gl_FragCoord, so that columns stay; the prefix is no author's.
constexpr std::string_view kFragCoord = "as_FragCoord";
constexpr std::string_view kDrawMain = "aftershade_draw_pixel";

/// Before the text, which may read gl_FragCoord where it initialises a global variable. `precise`: compilers
/// would add the 0.5 to constants of the author's.
constexpr const char* kComputeHead = R"(layout(local_size_x = $side, local_size_y = $side) in;
precise vec4 as_FragCoord = vec4(vec2(gl_GlobalInvocationID.xy) + 0.5, 0.0, 1.0);
bool aftershade_is_discarded = false;
)";

/// Which texels the quads of glsl/tile_runs.glsl cover, by the bits of each group of tiles. Corners are
/// rounded to 1/256 texel. Where an edge then goes through a texel's centre, that texel belongs to the tile
/// on the right or above, hence 1/512.
constexpr const char* kDrawnTiles = R"(
layout(std140, binding = $binding) uniform AftershadeTiles {
    vec4 aftershade_grid_size;
    int aftershade_tile_side, aftershade_tiles_across, aftershade_tiles_down;
};
bool aftershade_is_drawn(ivec2 texel, ivec2 size) {
    vec2 at = vec2(texel) + vec2(0.5 + 1.0 / 512.0, 0.5 - 1.0 / 512.0);
    ivec2 tile = ivec2(at * (aftershade_grid_size.xy / vec2(size))) / aftershade_tile_side;
    if (tile.x >= aftershade_tiles_across || tile.y >= aftershade_tiles_down) return false;
    uint tiles = $runs[tile.y * ((aftershade_tiles_across + 15) / 16) + tile.x / 16].w;
    return (tiles >> (tile.x & 15) & 1u) != 0u;
}
)";
constexpr const char* kDrawnWhole = "\nbool aftershade_is_drawn(ivec2 texel, ivec2 size) { return true; }\n";

constexpr const char* kComputeMain = R"(
vec4 aftershade_texel(float v) { return vec4(v, 0.0, 0.0, 1.0); }
vec4 aftershade_texel(vec2 v) { return vec4(v, 0.0, 1.0); }
vec4 aftershade_texel(vec4 v) { return v; }
uvec4 aftershade_texel(uint v) { return uvec4(v, 0u, 0u, 1u); }
uvec4 aftershade_texel(uvec2 v) { return uvec4(v, 0u, 1u); }
uvec4 aftershade_texel(uvec4 v) { return v; }
ivec4 aftershade_texel(int v) { return ivec4(v, 0, 0, 1); }
// A draw turns NaN into 0 in formats of bytes, and llvmpipe's imageStore() into 1.
vec4 aftershade_bytes(vec4 v) { return mix(v, vec4(0.0), isnan(v)); }
void main() {
    ivec2 aftershade_at = ivec2(gl_GlobalInvocationID.xy), aftershade_size = imageSize(aftershade_target_0);
    if (any(greaterThanEqual(aftershade_at, aftershade_size))) return;
    if (!aftershade_is_drawn(aftershade_at, aftershade_size)) return;
    aftershade_draw_pixel();
    if (aftershade_is_discarded) return;
)";

/// Of fragment shaders alone.
constexpr std::array<std::string_view, 12> kDerivatives = {"dFdx",
                                                           "dFdy",
                                                           "fwidth",
                                                           "dFdxFine",
                                                           "dFdyFine",
                                                           "fwidthFine",
                                                           "dFdxCoarse",
                                                           "dFdyCoarse",
                                                           "fwidthCoarse",
                                                           "interpolateAtCentroid",
                                                           "interpolateAtSample",
                                                           "interpolateAtOffset"};
/// Functions that choose a level by derivatives; a macro may call one.
constexpr std::array<std::string_view, 5> kLevelByDerivatives = {"texture", "textureOffset", "textureProj",
                                                                 "textureProjOffset", "textureQueryLod"};

class ComputeForm {
public:
    ComputeForm(ShaderSource& source, const DrawShape& shape)
        : source_(source), shape_(shape), tokens_(all_glsl_tokens(source)) {}

    std::string make() {
        outputs_.resize(shape_.targets.size());
        if (int(outputs_.size()) + shape_.first_target_unit > kMostComputeImages)
            return "has more than " + std::to_string(kMostComputeImages) + " targets and images";
        find_mains();
        if (mains_.empty()) return "has no main()";
        for (std::size_t i = 0; i < tokens_.size(); ++i)
            if (std::string fault = look_at(i); !fault.empty()) return fault;
        for (const std::string& output : outputs_)
            if (output.empty()) return "declares outputs of its own";
        replace(mains_.back().name, kDrawMain);
        apply();
        surround();
        return "";
    }

private:
    struct Main {
        std::size_t name = 0, end = 0;  ///< tokens
    };
    struct Edit {
        std::size_t at = 0, bytes = 0;
        std::string text;
    };

    std::string_view text(std::size_t i) const { return i < tokens_.size() ? tokens_[i].text : ""; }

    /// Bodies of functions of that name: the author's, and the host's around it, which is the last.
    void find_mains() {
        for (std::size_t i = 1; i < tokens_.size(); ++i) {
            if (text(i) != "main" || text(i - 1) != "void" || text(i + 1) != "(") continue;
            BraceDepth braces;
            std::size_t at = i;
            for (bool is_open = false; at < tokens_.size() && (!is_open || braces.value() > 0); ++at) {
                if (text(at) == "#") braces.pass_directive(text(at + 1));
                if (text(at) == "{") braces.open();
                if (text(at) == "}") braces.close();
                is_open |= text(at) == "{";
            }
            mains_.push_back({i, at});
        }
    }

    std::string look_at(std::size_t i) {
        const std::string_view word = text(i);
        if (!tokens_[i].is_word()) return "";
        if (word == "gl_FragCoord") {
            replace(i, kFragCoord);
        } else if (word.starts_with("gl_") && !word.starts_with("gl_Max") && !word.starts_with("gl_Min")) {
            return "uses " + std::string(word);
        } else if (word == "discard") {
            return look_at_discard(i);
        } else if (std::ranges::find(kDerivatives, word) != kDerivatives.end()) {
            return "uses " + std::string(word) + "()";
        } else if (shape_.has_levels &&
                   std::ranges::find(kLevelByDerivatives, word) != kLevelByDerivatives.end()) {
            return "chooses levels of a texture by derivatives, with " + std::string(word) + "()";
        } else if (word == "layout") {
            look_at_layout(i);
        }
        return "";
    }

    std::string look_at_discard(std::size_t i) {
        const bool is_in_main =
            std::ranges::any_of(mains_, [&](const Main& main) { return i > main.name && i < main.end; });
        if (!is_in_main || text(i + 1) != ";") return "discards outside of main()";
        replace(i, "{ aftershade_is_discarded = true; return; }");
        replace(i + 1, "");
        return "";
    }

    /// layout ( location = 0 ) out vec4 name ;
    void look_at_layout(std::size_t i) {
        constexpr std::size_t kNumber = 4, kOut = 6, kType = 7, kName = 8;
        if (text(i + 2) != "location" || text(i + kOut) != "out" || text(i + kName + 1) != ";") return;
        const std::string number(text(i + kNumber));
        for (std::size_t location = 0; location < outputs_.size(); ++location)
            if (number == std::to_string(location)) outputs_[location] = text(i + kName);
        for (std::size_t token = i; token < i + kType; ++token) replace(token, "");
    }

    void replace(std::size_t token, std::string_view by) {
        const std::string_view old = tokens_[token].text;
        edits_.push_back({std::size_t(old.data() - source_.text.data()), old.size(), std::string(by)});
    }

    void apply() {
        std::ranges::sort(edits_, {}, &Edit::at);
        std::string made;
        std::size_t at = 0;
        for (const Edit& edit : edits_) {
            made.append(source_.text, at, edit.at - at).append(edit.text);
            at = edit.at + edit.bytes;
        }
        source_.text = made.append(source_.text, at);
    }

    /// What stands before the text and behind it.
    void surround() {
        const std::string before = filled(kComputeHead, {{"side", std::to_string(gpu::kGroupSide)}});
        source_.text.insert(source_.text.find('\n') + 1, before);
        source_.lines.insert(source_.lines.begin() + 1, std::size_t(std::ranges::count(before, '\n')),
                             SourceLine{"<generated>", 1});
        std::string stores;
        for (std::size_t i = 0; i < outputs_.size(); ++i) {
            const gpu::TextureFormat format = shape_.targets[i];
            const std::string target = "aftershade_target_" + std::to_string(i);
            const std::string_view prefix = !gpu::is_integer(format)         ? ""
                                            : gpu::is_signed_integer(format) ? "i"
                                                                             : "u";
            source_.text += "layout(binding = " + std::to_string(shape_.first_target_unit + int(i)) + ", " +
                            std::string(gpu::texture_format_name(format)) + ") restrict writeonly uniform " +
                            std::string(prefix) + "image2D " + target + ";\n";
            const bool has_bytes =
                !gpu::is_integer(format) && gpu::bytes_per_texel(format) == gpu::channel_count(format);
            const std::string texel = "aftershade_texel(" + outputs_[i] + ")";
            stores += "    imageStore(" + target + ", aftershade_at, " +
                      (has_bytes ? "aftershade_bytes(" + texel + ")" : texel) + ");\n";
        }
        source_.text += shape_.tile_runs ? filled(kDrawnTiles, {{"binding", std::to_string(kTilesBinding)},
                                                                {"runs", *shape_.tile_runs}})
                                         : kDrawnWhole;
        source_.text += kComputeMain + stores + "}\n";
    }

    ShaderSource& source_;
    const DrawShape& shape_;
    const std::vector<Token> tokens_;
    std::vector<Main> mains_;
    std::vector<std::string> outputs_;  // by location, as the text names them
    std::vector<Edit> edits_;
};

}  // namespace

std::string to_compute_form(ShaderSource& source, const DrawShape& shape) {
    return ComputeForm(source, shape).make();
}

}  // namespace aftershade
