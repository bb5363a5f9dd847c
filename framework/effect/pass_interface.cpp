#include <algorithm>
#include <array>

#include "framework/effect/shader_source.h"
#include "framework/effect/std140.h"
#include "framework/image/role.h"

namespace aftershade {

std::vector<ReadSpec> present_reads(const EffectManifest& manifest, const PassSpec& pass,
                                    const std::vector<std::string>& present_inputs) {
    std::vector<ReadSpec> present;
    for (const ReadSpec& read : pass.reads) {
        const InputSpec* input = manifest.find_input(read.name);
        const bool absent =
            input && input->optional &&
            std::find(present_inputs.begin(), present_inputs.end(), read.name) == present_inputs.end();
        if (!absent) present.push_back(read);
    }
    return present;
}

bool pass_enabled(const PassSpec& pass, const ParamSet& params,
                  const std::vector<std::string>& present_inputs) {
    constexpr std::string_view kHas = "has.";
    const auto holds = [&](const WhenSpec& condition) {
        ParamValue actual;
        if (condition.subject.starts_with(kHas)) {
            const std::string input = condition.subject.substr(kHas.size());
            actual = std::find(present_inputs.begin(), present_inputs.end(), input) != present_inputs.end();
        } else {
            actual = params.get(condition.subject);
        }
        return std::find(condition.values.begin(), condition.values.end(), actual) != condition.values.end();
    };
    return std::all_of(pass.when.begin(), pass.when.end(), holds);
}

gpu::TextureFormat texture_format_of_role(const std::string& role_name) {
    const auto role = find_role(role_name);
    if (role->type == ComponentType::uint32) return gpu::TextureFormat::r32ui;
    if (role->channels == 1) return gpu::TextureFormat::r32f;
    if (role->channels == 2) return gpu::TextureFormat::rg32f;
    return gpu::TextureFormat::rgba32f;
}

bool has_param_block(const EffectManifest& manifest) {
    return std::any_of(manifest.params.begin(), manifest.params.end(),
                       [](const ParamSpec& spec) { return spec.bind == ParamBind::uniform; });
}

std::vector<std::byte> param_block(const EffectManifest& manifest, const ParamSet& params) {
    Std140Writer block;
    for (const ParamSpec& spec : manifest.params) {
        if (spec.bind != ParamBind::uniform) continue;
        const ParamValue& value = params.get(spec.name);
        switch (spec.type) {
            case ParamType::bool_: block.add(std::int32_t(std::get<bool>(value))); break;
            case ParamType::int_: block.add(std::int32_t(std::get<std::int64_t>(value))); break;
            case ParamType::enum_: {
                const auto found =
                    std::find(spec.values.begin(), spec.values.end(), std::get<std::string>(value));
                block.add(std::int32_t(found - spec.values.begin()));
                break;
            }
            case ParamType::float_:
            case ParamType::angle: block.add(float(std::get<double>(value))); break;
            case ParamType::color:
            case ParamType::vec2:
            case ParamType::vec3:
            case ParamType::vec4: {
                std::vector<float> vector;
                for (const double component : std::get<std::vector<double>>(value))
                    vector.push_back(float(component));
                block.add(std::span<const float>(vector));
                break;
            }
        }
    }
    return block.finish();
}

std::string_view frame_block_glsl() {
    return "layout(std140, binding = 1) uniform FrameBlock {\n"
           "    ivec2 display_size;\n"
           "    ivec2 origin;\n"
           "    int number;\n"
           "    uint step_seed;\n"
           "    mat3 rec709_from_color;\n"
           "} frame;\n";
}

}  // namespace aftershade
