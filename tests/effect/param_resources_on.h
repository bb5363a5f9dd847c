// What the GLSL of parameters that are textures or buffers computes, for tests.
#pragma once

#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "framework/effect/param_resources.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::test {

using Vec4 = std::array<float, 4>;

inline ObjectIds ids_of(const std::map<std::string, std::uint32_t>& ids) {
    return [ids](const std::string& name) {
        const auto found = ids.find(name);
        return found == ids.end() ? std::nullopt : std::optional(found->second);
    };
}

class ParamResourcesOn : public gpu::SoftwareTest {
protected:
    /// What `expression`, of type vec4, gives for each `v` of the inputs, in a compute shader with
    /// `declared`.
    std::vector<Vec4> computed(const std::string& declared, const std::string& expression,
                               const std::vector<Vec4>& inputs, const gpu::Texture* texture,
                               const gpu::Buffer* table = nullptr) {
        const std::string source = "#version 450 core\nlayout(local_size_x = 1) in;\n" + declared +
                                   "layout(std430, binding = 0) readonly buffer In { vec4 inputs[]; };\n"
                                   "layout(std430, binding = 1) buffer Out { vec4 outputs[]; };\n"
                                   "void main() {\n"
                                   "    vec4 v = inputs[gl_GlobalInvocationID.x];\n"
                                   "    outputs[gl_GlobalInvocationID.x] = " +
                                   expression + ";\n}\n";
        const gpu::Program program = gpu::Program::compute(context(), source, "test");
        gpu::Buffer in(context(), inputs.size() * sizeof(Vec4), "in"),
            out(context(), inputs.size() * sizeof(Vec4), "out");
        in.write(std::as_bytes(std::span(inputs)));
        std::vector<gpu::BufferBinding> storage = {{&in, 0}, {&out, 1}};
        if (table) storage.push_back({table, 3});
        const gpu::SampledTexture sampled{texture, 5};
        gpu::Bindings bindings;
        bindings.storage = storage;
        if (texture) bindings.textures = {&sampled, 1};
        gpu::dispatch(context(), program, int(inputs.size()), 1, 1, bindings);
        std::vector<Vec4> outputs(inputs.size());
        std::memcpy(outputs.data(), out.read().data(), out.size());
        return outputs;
    }

    gpu::Texture uploaded(const ParamTexture& data) {
        gpu::Texture made(
            context(),
            {.width = data.width, .height = data.height, .format = data.format, .layers = data.layers},
            "param");
        const std::size_t layer = data.texels.size() / std::size_t(data.layers);
        for (int i = 0; i < data.layers; ++i)
            made.upload(std::span(data.texels).subspan(std::size_t(i) * layer, layer), i);
        return made;
    }

    gpu::Buffer uploaded(const std::vector<std::byte>& bytes) {
        gpu::Buffer made(context(), bytes.size(), "table");
        made.write(bytes);
        return made;
    }
};
}  // namespace aftershade::test
