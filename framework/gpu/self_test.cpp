#include "framework/gpu/self_test.h"

#include <array>
#include <memory>
#include <span>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "framework/base/error.h"
#include "framework/gpu/commands.h"

namespace aftershade::gpu {
namespace {

constexpr std::array<float, 4> kColour = {-1.5F, 3.25F, 1e6F, 0.1F};

/// glsl/fullscreen.vert to the letter: most passes then find its machine code in the driver's cache.
constexpr const char* kVertex = R"(#version 450 core
// One triangle that covers the target; gl_FragCoord (0.5, 0.5) is texel (0, 0), the top left of the image.
out gl_PerVertex { vec4 gl_Position; };
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)";

/// All of kColour but alpha as literals: llvmpipe takes a millisecond to compile each further value of a
/// block.
std::string fragment_text() {
    return fmt::format(R"(#version 450 core
layout(std140, binding = 0) uniform Block {{ float alpha; }};
layout(location = 0) out vec4 result;
void main() {{ result = vec4({}, {}, {}, alpha) + vec4(gl_FragCoord.xy, 0.0, 0.0); }}
)",
                       kColour[0], kColour[1], kColour[2]);
}

constexpr int kWidth = 3, kHeight = 2;

/// Of a channel at a texel, as the shader gives it: exact in floats.
float expected(int x, int y, int channel) {
    const float place = channel == 0 ? float(x) + 0.5F : channel == 1 ? float(y) + 0.5F : 0.0F;
    return kColour[std::size_t(channel)] + place;
}

}  // namespace

void self_test(Context& context) {
    const auto vertex = std::make_shared<const Program>(Program::vertex(context, kVertex, "self-test"));
    Program program = Program::fragment(context, vertex, fragment_text(), "self-test");
    program.use_one_form();
    const Texture target(context, {.width = kWidth, .height = kHeight, .format = TextureFormat::rgba32f},
                         "self-test");
    Buffer block(context, 4 * sizeof(float), "self-test");
    const std::array<float, 4> alpha = {kColour[3]};
    block.write(std::as_bytes(std::span(alpha)));

    const Target targets[] = {{.texture = &target}};
    const BufferBinding uniforms[] = {{&block, 0}};
    draw(context, program, targets, {.uniforms = uniforms});
    const std::vector<float> got = target.read_floats();
    for (std::size_t i = 0; i < got.size(); ++i) {
        const int texel = int(i) / 4;
        if (got[i] == expected(texel % kWidth, texel / kWidth, int(i) % 4)) continue;
        throw Error(ErrorKind::gl,
                    fmt::format("self-test on {}: drew ({}) and the texel's place, read back ({})",
                                context.info().renderer, fmt::join(kColour, ", "), fmt::join(got, ", ")));
    }
}

}  // namespace aftershade::gpu
