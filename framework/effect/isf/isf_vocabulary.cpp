#include "framework/effect/isf/isf_vocabulary.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <map>

#include "framework/effect/manifest/manifest_check.h"

namespace aftershade::isf_words {

namespace {

/// Words of GLSL 1.20 that no older file has as a name.
const Words kOldWords = {
    "attribute", "const", "varying",   "break",     "continue", "do",        "for",          "while",
    "if",        "else",  "in",        "out",       "inout",    "float",     "int",          "void",
    "bool",      "true",  "false",     "return",    "discard",  "struct",    "vec2",         "vec3",
    "vec4",      "ivec2", "ivec3",     "ivec4",     "bvec2",    "bvec3",     "bvec4",        "mat2",
    "mat3",      "mat4",  "sampler1D", "sampler2D", "defined",  "precision", "sampler2DRect"};
/// Names of the host's text that a file may have, too.
const Words kHostNames = {"param",        "frame",          "camera",      "lights",      "pass",
                          "native",       "ParamBlock",     "FrameBlock",  "CameraBlock", "LightsBlock",
                          "PassBlock",    "NativeBlock",    "SizeBlock",   "Light",       "has_coverage",
                          "kLeastAlpha",  "straight_light", "out_display", "out_color",   "display",
                          "display_size", "color_size"};

bool begins_with_any(std::string_view word, std::initializer_list<std::string_view> starts) {
    return std::ranges::any_of(starts, [&](std::string_view start) { return word.starts_with(start); });
}

}  // namespace

const Words kQualifiers = {"smooth",  "flat",     "noperspective", "sample",   "patch",     "precise",
                           "buffer",  "shared",   "coherent",      "volatile", "restrict",  "readonly",
                           "lowp",    "mediump",  "highp",         "layout",   "writeonly", "subroutine",
                           "uniform", "centroid", "invariant"};
const Words kSampling = {"texture",          "texture2D",         "texture2DRect", "textureCube",
                         "textureCubeLod",   "textureCubeLodEXT", "texture2DLod",  "textureLod",
                         "texture2DLodEXT",  "texture2DProj",     "textureProj",   "texelFetch",
                         "texture2DProjLod", "texture2DRectProj", "texture2DGrad", "texture2DGradARB",
                         "textureProjLod",   "textureProjGrad",   "textureGrad",   "textureOffset",
                         "textureLodOffset", "texelFetchOffset",  "textureGather", "dFdy",
                         "dFdyFine",         "dFdyCoarse"};
const Words kOfIsf = {"TIME",
                      "TIMEDELTA",
                      "DATE",
                      "PASSINDEX",
                      "FRAMEINDEX",
                      "RENDERSIZE",
                      "isf_FragNormCoord",
                      "vv_FragNormCoord"};
const Words kAliases = {"isf_FragColor", "isf_FragCoord"};

bool is_name(std::string_view word) {
    const auto matches = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    return !word.empty() && !std::isdigit(static_cast<unsigned char>(word[0])) && !word.starts_with("gl_") &&
           std::ranges::all_of(word, matches);
}

bool is_old_word(std::string_view word) {
    return kOldWords.contains(word);
}

bool is_new_type(std::string_view word) {
    if (word == "double" || word == "uint" || word == "atomic_uint") return true;
    if (kOldWords.contains(word)) return false;
    if (begins_with_any(word, {"uvec", "dvec", "mat", "dmat"})) return is_glsl_word(std::string(word));
    if (begins_with_any(word, {"i", "u"}) && word != "image")
        word.remove_prefix(word.starts_with("image") ? 0 : 1);
    for (const std::string_view kind : {"image", "sampler"})
        if (word.starts_with(kind))
            return begins_with_any(word.substr(kind.size()), {"1D", "2D", "3D", "Cube", "Buffer"});
    return false;
}

bool is_keyword(std::string_view word) {
    return !kOldWords.contains(word) &&
           (is_new_type(word) || kQualifiers.contains(word) ||
            (!word.starts_with("gl_") && word.find("__") == std::string_view::npos &&
             is_glsl_word(std::string(word))));
}

bool is_statement_word(std::string_view word) {
    return word == "switch" || word == "case" || word == "default";
}

bool is_host_name(std::string_view word) {
    if (word == "isf_FragNormCoord" || word == "isf_vertShaderInit") return false;
    return kHostNames.contains(word) || begins_with_any(word, {"isf_", "ISF_", "HAS_", "aftershade_"});
}

bool is_swizzle(std::string_view word) {
    return word.size() <= 4 &&
           std::ranges::any_of(
               std::array<std::string_view, 3>{"xyzw", "rgba", "stpq"},
               [&](std::string_view set) { return word.find_first_not_of(set) == std::string_view::npos; });
}

}  // namespace aftershade::isf_words

namespace aftershade {

std::string with_isf_names(const std::string& message) {
    static const std::map<std::string, std::string, std::less<>> kNames = {
        {"isf_main", "main"},
        {"isf_sample", "texture2D"},
        {"isf_data", "gl_FragData"},
        {"isf_sample_here", "IMG_THIS_PIXEL"},
        {"isf_FragCoord", "gl_FragCoord"},
        {"isf_sample_pixel", "IMG_PIXEL"},
        {"isf_size", "IMG_SIZE"}};
    std::string text;
    for (std::size_t i = 0; i < message.size();) {
        std::size_t end = i;
        while (end < message.size() &&
               (std::isalnum(static_cast<unsigned char>(message[end])) || message[end] == '_'))
            ++end;
        std::string_view word = std::string_view(message).substr(i, end - i);
        if (word.empty()) {
            text += message[i++];
            continue;
        }
        for (const std::string_view prefix : {isf_words::kOwn, isf_words::kCall, isf_words::kHere})
            if (word.starts_with(prefix)) word.remove_prefix(prefix.size());
        const auto known = kNames.find(word);
        text += known == kNames.end() ? word : std::string_view(known->second);
        i = end;
    }
    return text;
}

}  // namespace aftershade
