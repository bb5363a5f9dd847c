// Inputs and outputs of native code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "framework/document/param.h"
#include "framework/image/camera.h"

namespace aftershade {

enum class NativeScalar { float_, int_, uint_ };

/// float, vec2..4, int, ivec2..4, uint, uvec2..4.
struct NativeUniformType {
    NativeScalar scalar = NativeScalar::float_;
    int components = 1;
    bool operator==(const NativeUniformType&) const = default;
};

/// "vec3", ...; nullopt for anything else.
std::optional<NativeUniformType> parse_native_uniform_type(std::string_view name);
std::string native_uniform_type_name(NativeUniformType type);

/// The numbers are the ABI's.
enum class NativeElement { float_ = 0, vec2, vec4, uint_, uvec2, uvec4 };

/// "float", "vec2", "vec4", "uint", "uvec2", "uvec4"; nullopt for anything else.
std::optional<NativeElement> parse_native_element(std::string_view name);
std::string_view native_element_name(NativeElement element);
std::size_t native_element_bytes(NativeElement element);

inline constexpr int kMaxNativeTableSide = 1024;

struct NativeTableType {
    NativeElement element = NativeElement::float_;
    int max_width = kMaxNativeTableSide;
    int max_height = 1;
};

/// The values that native code computes, by effect.json.
struct NativeDeclaration {
    std::string effect_id;
    std::string effect_version;
    std::map<std::string, NativeUniformType> uniforms;
    std::map<std::string, NativeTableType> tables;
    std::vector<std::string> passes;  ///< that may be repeated or disabled
};

struct NativeImage {
    std::string name;
    std::string role;
    int width_px = 0;
    int height_px = 0;
    int channels = 0;
    bool present = false;
};

/// The arguments of one call of prepare.
struct NativeFrame {
    const std::vector<ParamSpec>* specs = nullptr;  ///< the manifest's; never null
    const ParamSet* params = nullptr;               ///< a value for each of them; never null
    const Camera* camera = nullptr;                 ///< null: nothing is known
    std::map<std::string, std::string> metadata;    ///< text attributes
    std::vector<NativeImage> images;                ///< one for each input of the effect
    int number = 0;
    double fps = 0;    ///< 0: not known
    int width_px = 0;  ///< the working grid
    int height_px = 0;
    int display_width_px = 0;
    int display_height_px = 0;
    bool history_valid = false;
    std::uint32_t step_seed = 0;
};

struct NativeTable {
    NativeElement element = NativeElement::float_;
    int width = 0;
    int height = 0;
    std::vector<std::byte> bytes;  ///< row by row, without padding
};

/// As many components as declared; of the declared scalar.
using NativeUniform = std::variant<std::vector<float>, std::vector<std::int32_t>, std::vector<std::uint32_t>>;

/// The numbers are the ABI's.
enum class NativeLogLevel { debug = 0, info, warning, error };

struct NativeLogLine {
    NativeLogLevel level = NativeLogLevel::info;
    std::string text;
};

/// The results of prepare: complete (every declared uniform and table) and within the declarations.
struct NativeResult {
    std::map<std::string, NativeUniform> uniforms;
    std::map<std::string, NativeTable> tables;
    std::map<std::string, int> repeats;   ///< passes that are not here run as the manifest says
    std::map<std::string, bool> enabled;  ///< likewise
    int warm_up_frames = 0;
    int overscan_px = 0;
    std::vector<NativeLogLine> log;  ///< since the last call
};

}  // namespace aftershade
