// Programs and pictures of a few texels for tests that run a graph.
#pragma once

#include <cstring>
#include <span>

#include "framework/graph/executor.h"
#include "tests/gpu/gpu_test.h"
#include "tests/graph/graph_test.h"

namespace aftershade::graph {

using Floats = std::vector<float>;

constexpr int kWidth = 5, kHeight = 3;
inline const gpu::TextureDesc kSmall{.width = kWidth, .height = kHeight, .format = gpu::TextureFormat::r32f};

inline std::vector<std::byte> block_of(float value) {
    std::vector<std::byte> bytes(16);  // std140 rounds a block up to 16 bytes
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

inline std::vector<std::uint32_t> words_of(const gpu::Buffer& buffer) {
    const std::vector<std::byte> bytes = buffer.read();
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t));
    return words;
}

class GraphOn : public gpu::SoftwareTest {
protected:
    /// A draw whose target is what `body` leaves in `float result`; `source` is the sampler at binding 0.
    gpu::Program draws(const std::string& body) {
        return fragment(R"(
layout(binding = 0) uniform sampler2D source;
layout(binding = 1) uniform sampler2D other;
layout(std140, binding = 1) uniform Block { float add; };
layout(location = 0) out float result;
void main() {
    ivec2 p = ivec2(gl_FragCoord.xy);
)" + body + "\n}");
    }

    gpu::Program computes(const std::string& declarations, const std::string& body) {
        return gpu::Program::compute(
            context(), "#version 450 core\n" + declarations + "\nvoid main() {\n" + body + "\n}\n",
            "compute");
    }

    /// out = source * 2 + add, texel by texel.
    gpu::Program twice_plus() { return draws("result = texelFetch(source, p, 0).r * 2.0 + add;"); }

    static Pass with(Pass pass, const gpu::Program& program) {
        pass.program = kept_by_caller(program);
        return pass;
    }

    static Pass draw_of(const std::string& name, const gpu::Program& program,
                        std::initializer_list<TextureHandle> reads, TextureHandle target) {
        Pass pass = with(pass_named(name, PassKind::draw, reads), program);
        pass.targets = {{target}};
        return pass;
    }

    /// A pass of twice_plus().
    static Pass adding(const std::string& name, const gpu::Program& program, TextureHandle source,
                       TextureHandle target, float add) {
        Pass pass = draw_of(name, program, {source}, target);
        pass.uniforms = {{1, block_of(add)}};
        return pass;
    }

    static Floats ramp(float step) {
        Floats values(kWidth * kHeight);
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = step * float(i);
        return values;
    }
};

}  // namespace aftershade::graph
