#include "framework/effect/manifest/manifest_check.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <variant>

#include "framework/base/path_bounds.h"
#include "framework/document/param_type.h"
#include "framework/effect/glsl_tokens.h"

namespace aftershade {

namespace {

/// Lower-case keywords and reserved words of GLSL 4.50, section 3.6; vectors and matrices are is_word's.
const std::set<std::string> kWords = {
    "active",     "asm",      "atomic_uint", "attribute", "bool",          "break",
    "buffer",     "case",     "cast",        "centroid",  "class",         "coherent",
    "common",     "const",    "continue",    "default",   "discard",       "do",
    "double",     "else",     "enum",        "extern",    "external",      "false",
    "filter",     "fixed",    "flat",        "float",     "for",           "goto",
    "half",       "highp",    "if",          "in",        "inline",        "inout",
    "input",      "int",      "interface",   "invariant", "layout",        "long",
    "lowp",       "mediump",  "namespace",   "noinline",  "noperspective", "out",
    "output",     "packed",   "partition",   "patch",     "precise",       "precision",
    "public",     "readonly", "resource",    "restrict",  "return",        "sample",
    "shared",     "short",    "sizeof",      "smooth",    "static",        "struct",
    "subroutine", "superp",   "switch",      "template",  "this",          "true",
    "typedef",    "uint",     "uniform",     "union",     "unsigned",      "using",
    "varying",    "void",     "volatile",    "while",     "writeonly"};

/// Functions that a global name would hide, and the host's own blocks. GLSL 4.50, chapter 8.
const std::set<std::string> kTaken = {
    "param",       "frame",      "camera",      "pass",      "native",      "main",    "radians", "degrees",
    "sin",         "cos",        "tan",         "asin",      "acos",        "atan",    "sinh",    "cosh",
    "tanh",        "asinh",      "acosh",       "atanh",     "pow",         "exp",     "log",     "exp2",
    "log2",        "sqrt",       "inversesqrt", "abs",       "sign",        "floor",   "trunc",   "round",
    "ceil",        "fract",      "mod",         "modf",      "min",         "max",     "clamp",   "mix",
    "step",        "smoothstep", "isnan",       "isinf",     "fma",         "frexp",   "ldexp",   "length",
    "distance",    "dot",        "cross",       "normalize", "faceforward", "reflect", "refract", "transpose",
    "determinant", "inverse",    "equal",       "any",       "all",         "not",     "texture", "barrier",
    "fwidth",      "noise1"};

/// "vec2" .. "fvec4", "mat2" .. "dmat4x3": GLSL's types of several numbers, and those that it keeps for
/// itself.
bool is_vector_or_matrix(std::string_view name) {
    const auto is_side = [](char c) { return c >= '2' && c <= '4'; };
    if (!name.empty() && std::string_view("bdiuhf").find(name.front()) != std::string_view::npos) {
        if (name.substr(1).starts_with("mat") && name.front() != 'd') return false;
        name.remove_prefix(1);
    }
    const bool is_matrix = name.starts_with("mat");
    if (!is_matrix && !name.starts_with("vec")) return false;
    name.remove_prefix(3);
    const bool is_square = name.size() == 1 && is_side(name[0]);
    return is_square ||
           (is_matrix && name.size() == 3 && is_side(name[0]) && name[1] == 'x' && is_side(name[2]));
}

bool is_word(const std::string& name) {
    return kWords.contains(name) || is_vector_or_matrix(name);
}

}  // namespace

bool is_glsl_word(const std::string& name) {
    return is_word(name) || name.starts_with("gl_") || name.find("__") != std::string::npos;
}

bool hides_glsl(const std::string& name) {
    return kTaken.contains(name);
}

namespace {

class NameChecker {
public:
    NameChecker(const EffectManifest& manifest, Diagnostics& diagnostics)
        : manifest_(manifest), diagnostics_(diagnostics) {}

    void check() {
        if (manifest_.uses_lights)
            for (const char* name : {"lights", "Light", "LIGHT_POINT", "LIGHT_DIRECTIONAL", "LIGHT_AREA"})
                claim(name, "block 'lights'", *manifest_.uses_lights);
        for (const InputSpec& input : manifest_.inputs) {
            sampled("input", input);
            if (input.optional)
                claim("HAS_" + upper_case(input.name), "input '" + input.name + "'", input.place);
            const InputSpec* const instead = manifest_.find_input(input.instead);
            if (!input.instead.empty() && (!instead || !instead->optional || instead == &input))
                diagnostics_.error(input.place, "input '" + input.name + "': 'instead' names '" +
                                                    input.instead + "', which is not another optional input");
        }
        for (const OutputSpec& output : manifest_.outputs) {
            word("output", output.name, output.place);
            claim("out_" + output.name, "output '" + output.name + "'", output.place);
        }
        for (const TextureSpec& texture : manifest_.textures) {
            sampled("texture", texture);
            claim("out_" + texture.name, "texture '" + texture.name + "'", texture.place);
        }
        for (const BufferSpec& buffer : manifest_.buffers) stored(buffer);
        for (const TileListSpec& list : manifest_.tiles) tile_list(list);
        for (const ParamSpec& param : manifest_.params) {
            parameter(param);
            const ParamSpec* const unit = manifest_.find_param(param.per_metre);
            if (!param.per_metre.empty() && (!unit || unit->type != ParamType::float_))
                diagnostics_.error(param.place, "parameter '" + param.name + "': 'per_metre' names '" +
                                                    param.per_metre + "', which is not a float parameter");
        }
        if (manifest_.native) native(*manifest_.native);
        for (const PassSpec& pass : manifest_.passes) passes(pass);
    }

private:
    /// A name that no GLSL identifier may be.
    void word(const std::string& thing, const std::string& name, const Place& place) {
        if (is_word(name)) diagnostics_.error(place, thing + " '" + name + "' is a word of GLSL");
        else if (name.starts_with("gl_") || name.find("__") != std::string::npos)
            diagnostics_.error(place, thing + " '" + name + "' has gl_ or __, which GLSL keeps for itself");
    }
    /// A name that stands alone in a shader.
    void global(const std::string& thing, const std::string& name, const Place& place) {
        word(thing, name, place);
        if (kTaken.contains(name))
            diagnostics_.error(place, thing + " '" + name + "' would hide GLSL's or the host's own '" + name +
                                          "' in its shaders");
        claim(name, thing + " '" + name + "'", place);
    }
    void claim(const std::string& identifier, const std::string& owner, const Place& place) {
        const auto [known, is_new] = owners_.emplace(identifier, Owner{owner, place});
        if (is_new || known->second.name == owner) return;
        if (told_.emplace(known->second.name, owner).second)
            diagnostics_.error(place, owner + " needs the GLSL name '" + identifier + "', which the " +
                                          known->second.seen_from(place) + " has");
    }

    template <typename Spec>
    void sampled(const std::string& thing, const Spec& spec) {
        const std::string owner = thing + " '" + spec.name + "'";
        global(thing, spec.name, spec.place);
        claim(spec.name + "_size", owner, spec.place);
        if (!spec.history) return;
        claim(spec.name + "_prev", owner, spec.place);
        claim(spec.name + "_prev_size", owner, spec.place);
    }
    void stored(const BufferSpec& buffer) {
        const std::string owner = "buffer '" + buffer.name + "'";
        global("buffer", buffer.name, buffer.place);
        claim(storage_block_name(buffer.name), owner, buffer.place);
        if (!buffer.history) return;
        claim(buffer.name + "_prev", owner, buffer.place);
        claim(storage_block_name(buffer.name + "_prev"), owner, buffer.place);
    }
    void tile_list(const TileListSpec& list) {
        for (const char* name : {"TILE_RUNS", "TILE_ARGS", "TILE_SIDE", "tile_grid_size"})
            claim(name, "section 'tiles'", list.place);
        if (list.of) return;
        global("tile list", list.name, list.place);
        claim("is_listed", "section 'tiles'", list.place);
    }
    void parameter(const ParamSpec& param) {
        const std::string owner = "parameter '" + param.name + "'";
        if (is_block_type(param.type)) word("parameter", param.name, param.place);
        else global("parameter", param.name, param.place);
        if (param.bind == ParamBind::define) claim(upper_case(param.name), owner, param.place);
        for (const std::string& value : param.values)
            claim(upper_case(param.name) + "_" + upper_case(value), owner, param.place);
    }
    void native(const NativeSpec& native) {
        for (const NativeUniformSpec& uniform : native.uniforms)
            word("native uniform", uniform.name, uniform.place);
        for (const NativeTableSpec& table : native.tables) global("native table", table.name, table.place);
    }
    void passes(const PassSpec& pass) {
        word("pass", pass.name, pass.place);
        for (const ReadSpec& read : pass.reads)
            if (!read.when.empty()) presence(read.glsl_name(), read.name, read.place);
        for (const WriteSpec& write : pass.writes)
            if (!write.when.empty()) presence("out_" + write.name, write.name, write.place);
        for (const auto& [name, value] : pass.defines) {
            const auto known = owners_.find(name);
            if (known != owners_.end())
                diagnostics_.error(pass.place, "pass '" + pass.name + "' defines '" + name + "', which the " +
                                                   known->second.seen_from(pass.place) +
                                                   " has as its GLSL name");
            else if (is_word(name) || kTaken.contains(name))
                diagnostics_.error(pass.place, "pass '" + pass.name + "' defines '" + name +
                                                   "', a word of GLSL or the host");
        }
    }

    /// The define of what a pass reads or writes only under conditions.
    void presence(const std::string& glsl_name, const std::string& name, const Place& place) {
        const std::string thing = manifest_.find_input(name)     ? "input"
                                  : manifest_.find_texture(name) ? "texture"
                                                                 : "output";
        claim("HAS_" + upper_case(glsl_name), thing + " '" + name + "'", place);
    }

    const EffectManifest& manifest_;
    Diagnostics& diagnostics_;
    struct Owner {
        std::string name;
        Place place;
        /// With its place, if in another document.
        std::string seen_from(const Place& other) const {
            return place.file == other.file ? name : name + " (" + to_string(place) + ")";
        }
    };
    std::map<std::string, Owner> owners_;  // by GLSL identifier
    std::set<std::pair<std::string, std::string>> told_;
};

/// Pictures and tables that a manifest names lie in its folder.
void check_files(const EffectManifest& manifest, Diagnostics& diagnostics) {
    const auto check = [&](const ParamSpec& spec, const ParamValue& value, const std::string& place) {
        const auto& file = std::get<std::string>(value);
        if (file.empty()) return;
        const std::filesystem::path path = manifest.folder / file;
        if (const std::string why = out_of_bounds(path, manifest.folder); !why.empty())
            diagnostics.error({manifest.document.string()},
                              place + spec.name + ": " + path.string() + " " + why);
    };
    for (const ParamSpec& spec : manifest.params) {
        if (!is_file_type(spec.type)) continue;
        check(spec, spec.default_value, "params.");
        for (const PresetSpec& preset : manifest.presets)
            if (const auto value = preset.values.find(spec.name); value != preset.values.end())
                check(spec, value->second, "presets." + preset.name + ".");
    }
}

}  // namespace

void check_names(const EffectManifest& manifest, Diagnostics& diagnostics) {
    NameChecker(manifest, diagnostics).check();
}

void check_manifest(const EffectManifest& manifest, Diagnostics& diagnostics) {
    check_names(manifest, diagnostics);
    check_files(manifest, diagnostics);
    check_passes(manifest, diagnostics);
    check_tiles(manifest, diagnostics);
}

}  // namespace aftershade
