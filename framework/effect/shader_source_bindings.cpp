#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

#include "framework/document/param_type.h"
#include "framework/effect/manifest/manifest_when.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/std140.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// Of reads, writes or images those whose conditions hold.
template <typename Use>
std::vector<Use> present_uses(const std::vector<Use>& uses, const ParamReader& params,
                              const std::vector<std::string>& present_inputs) {
    std::vector<Use> present;
    std::copy_if(uses.begin(), uses.end(), std::back_inserter(present),
                 [&](const Use& use) { return conditions_hold(use.when, params, present_inputs); });
    return present;
}

bool is_written(const AccessSpec& access) {
    return access.kind != AccessSpec::Kind::read;
}

}  // namespace

std::vector<ReadSpec> present_reads(const EffectManifest& manifest, const PassSpec& pass,
                                    const ParamReader& params,
                                    const std::vector<std::string>& present_inputs) {
    std::vector<ReadSpec> present = present_uses(pass.reads, params, present_inputs);
    std::erase_if(present, [&](const ReadSpec& read) {
        const InputSpec* input = manifest.find_input(read.name);
        return input && input->optional &&
               std::find(present_inputs.begin(), present_inputs.end(), read.name) == present_inputs.end();
    });
    return present;
}

std::vector<WriteSpec> present_writes(const PassSpec& pass, const ParamReader& params,
                                      const std::vector<std::string>& present_inputs) {
    return present_uses(pass.writes, params, present_inputs);
}

bool pass_enabled(const PassSpec& pass, const ParamReader& params,
                  const std::vector<std::string>& present_inputs) {
    if (!conditions_hold(pass.when, params, present_inputs)) return false;
    const std::vector<AccessSpec> images = present_uses(pass.images, params, present_inputs);
    return !present_writes(pass, params, present_inputs).empty() ||
           std::any_of(images.begin(), images.end(), is_written) ||
           std::any_of(pass.buffers.begin(), pass.buffers.end(), is_written);
}

const ParamFile& ShaderContext::file_of(const std::string& param) const {
    static const ParamFile none;
    if (!files) return none;
    const auto found = files->find(param);
    return found == files->end() ? none : found->second;
}

PassBindings pass_bindings(const ShaderContext& context) {
    const EffectManifest& manifest = *context.manifest;
    PassBindings bindings;
    const PassSpec& pass = *context.pass;
    bindings.reads = present_reads(manifest, pass, context.params, context.present_inputs);
    bindings.writes = present_writes(pass, context.params, context.present_inputs);
    std::ranges::copy_if(bindings.writes, std::back_inserter(bindings.sized_writes),
                         [&](const WriteSpec& write) { return has_size_of_target(manifest, write); });
    bindings.images = present_uses(pass.images, context.params, context.present_inputs);
    bindings.buffers = pass.buffers;
    for (const ParamSpec& spec : manifest.params) {
        const bool has_file =
            is_file_type(spec.type) && !std::holds_alternative<std::monostate>(context.file_of(spec.name));
        if (has_file || is_param_texture(spec.type)) bindings.param_samplers.push_back(&spec);
        if (is_param_buffer(spec.type)) bindings.param_buffers.push_back(&spec);
    }
    if (manifest.native)
        for (const NativeTableSpec& table : manifest.native->tables) bindings.native_tables.push_back(&table);
    bindings.first_param_sampler = int(bindings.reads.size());
    bindings.first_native_sampler = bindings.first_param_sampler + int(bindings.param_samplers.size());
    bindings.first_param_buffer = int(bindings.buffers.size());
    bindings.has_param_block = has_param_block(manifest);
    bindings.has_pass_block = pass.repeat.has_value();
    bindings.has_tile_grid = (pass.over() && pass.vertex()) || pass.lists();
    bindings.has_native_block = has_native_block(manifest);
    return bindings;
}

bool has_size_of_target(const EffectManifest& manifest, const WriteSpec& write) {
    const TextureSpec* texture = manifest.find_texture(write.name);
    return texture && texture->grid.has_formula();
}

gpu::TextureFormat texture_format_of_role(const RoleId& id) {
    const auto role = find_role(id);
    if (role->type == ComponentType::uint32) return gpu::TextureFormat::r32ui;
    if (role->channels == 1) return gpu::TextureFormat::r32f;
    if (role->channels == 2) return gpu::TextureFormat::rg32f;
    return gpu::TextureFormat::rgba32f;
}

gpu::TextureFormat format_of_read(const EffectManifest& manifest, const std::string& name) {
    const TextureSpec* texture = manifest.find_texture(name);
    return texture ? texture->format : texture_format_of_role(manifest.find_input(name)->role);
}

gpu::TextureFormat format_of_write(const EffectManifest& manifest, const std::string& name) {
    const TextureSpec* texture = manifest.find_texture(name);
    return texture ? texture->format : texture_format_of_role(manifest.find_output(name)->role);
}

namespace {

bool is_in_block(const ParamSpec& spec) {
    return spec.bind == ParamBind::uniform && is_block_type(spec.type);
}

void add_param(Std140Writer& block, const ParamSpec& spec, const ParamValue& value) {
    const std::vector<double> numbers = numbers_of(spec, value);
    if (spec.type->is_integer)
        for (const double number : numbers) block.add(std::int32_t(number));
    else if (numbers.size() == 1) block.add(float(numbers[0]));
    else {
        const std::vector<float> vector(numbers.begin(), numbers.end());
        block.add(std::span<const float>(vector));
    }
}

}  // namespace

bool has_param_block(const EffectManifest& manifest) {
    return std::any_of(manifest.params.begin(), manifest.params.end(), is_in_block);
}

std::vector<std::byte> param_block(const EffectManifest& manifest, const ParamSet& params) {
    Std140Writer block;
    for (const ParamSpec& spec : manifest.params)
        if (is_in_block(spec)) add_param(block, spec, params.get(spec.name));
    return block.finish();
}

std::size_t param_block_bytes(const EffectManifest& manifest) {
    Std140Writer block;
    for (const ParamSpec& spec : manifest.params)
        if (is_in_block(spec)) add_param(block, spec, spec.default_value);
    return block.finish().size();
}

bool has_native_block(const EffectManifest& manifest) {
    return manifest.native && !manifest.native->uniforms.empty();
}

std::vector<std::byte> native_block(const EffectManifest& manifest, const NativeValues& values) {
    Std140Writer block;
    if (!manifest.native) return block.finish();
    for (const NativeUniformSpec& uniform : manifest.native->uniforms) {
        const bool is_vector = uniform.type.starts_with("vec");
        std::vector<double> given(is_vector ? std::size_t(uniform.type.back() - '0') : 1, 0.0);
        if (const auto found = values.find(uniform.name); found != values.end()) {
            assert(found->second.size() == given.size());
            given = found->second;
        }
        if (uniform.type == "int") block.add(std::int32_t(given[0]));
        else if (uniform.type == "uint") block.add(std::uint32_t(given[0]));
        else if (!is_vector) block.add(float(given[0]));
        else {
            const std::vector<float> vector(given.begin(), given.end());
            block.add(std::span<const float>(vector));
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
           "    float fps;\n"
           "    bool history_valid;\n"
           "    mat3 rec709_from_color;\n"
           "    ivec2 size;\n"
           "    ivec2 full_display_size;\n"
           "    float scale;\n"
           "    int subframe;\n"
           "    int subframe_count;\n"
           "    float subframe_time;\n"
           "} frame;\n";
}

std::string_view camera_block_glsl() {
    return "layout(std140, binding = 3) uniform CameraBlock {\n"
           "    mat4 view_from_world;\n"
           "    mat4 world_from_view;\n"
           "    mat4 clip_from_view;\n"
           "    mat4 view_from_clip;\n"
           "    mat4 clip_from_world;\n"
           "    mat4 world_from_clip;\n"
           "    mat4 prev_clip_from_world;\n"
           "    mat4 prev_view_from_world;\n"
           "    mat4 prev_clip_from_view;\n"
           "    mat4 prev_view_from_view;\n"
           "    vec3 position_m;\n"
           "    vec2 jitter_px;\n"
           "    vec2 prev_jitter_px;\n"
           "    float focal_length;\n"
           "    float sensor_width;\n"
           "    float focus_distance;\n"
           "    float f_number;\n"
           "    bool has_matrices;\n"
           "    bool has_prev_matrices;\n"
           "} camera;\n";
}

std::string_view lights_block_glsl() {
    static_assert(kMaxShaderLights == 16, "the text below says how many");
    return "#define LIGHT_POINT 0\n"
           "#define LIGHT_DIRECTIONAL 1\n"
           "#define LIGHT_AREA 2\n"
           "struct Light {\n"
           "    vec3 position_m;\n"
           "    int kind;\n"
           "    vec3 direction;\n"
           "    vec3 intensity;\n"
           "    vec2 size_m;\n"
           "};\n"
           "layout(std140, binding = 6) uniform LightsBlock {\n"
           "    int count;\n"
           "    Light light[16];\n"
           "} lights;\n";
}

}  // namespace aftershade
