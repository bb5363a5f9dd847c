#include "framework/gpu/self_test.h"

#include <array>
#include <span>

#include <fmt/format.h>

#include "framework/core/error.h"
#include "framework/gpu/commands.h"

namespace aftershade::gpu {
namespace {

constexpr std::array<float, 4> kColour = {-1.5F, 3.25F, 1e6F, 0.1F};

constexpr const char* kVertex = R"(#version 450 core
void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
)";

constexpr const char* kFragment = R"(#version 450 core
layout(std140, binding = 0) uniform Colour { vec4 colour; };
layout(location = 0) out vec4 result;
void main() { result = colour; }
)";

}  // namespace

void self_test(Context& context) {
    const Program program = Program::draw(context, kVertex, kFragment, "self-test");
    const Texture target(context, {.width = 3, .height = 2, .format = TextureFormat::rgba32f}, "self-test");
    Buffer colour(context, sizeof(kColour), "self-test");
    colour.write(std::as_bytes(std::span(kColour)));

    const Target targets[] = {{.texture = &target}};
    const BufferBinding uniforms[] = {{&colour, 0}};
    draw(context, program, targets, {.uniforms = uniforms});
    const std::vector<float> got = target.read_floats();
    for (std::size_t i = 0; i < got.size(); ++i) {
        if (got[i] == kColour[i % 4]) continue;
        throw Error(ExitCode::gl,
                    fmt::format("self-test on {}: drew ({}), read back ({})", context.info().renderer,
                                fmt::join(kColour, ", "), fmt::join(got, ", ")));
    }
}

}  // namespace aftershade::gpu
