#include "framework/gpu/program.h"

#include <memory>
#include <span>
#include <type_traits>

#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(std::is_nothrow_move_constructible_v<Program> && std::is_nothrow_move_assignable_v<Program>);
static_assert(!std::is_copy_constructible_v<Program> && !std::is_copy_assignable_v<Program>);

class ProgramOn : public SoftwareTest {};
ON_EACH_BACKEND(ProgramOn);

TEST_P(ProgramOn, ReportsTheLineOfAShaderError) {
    const std::string source = "layout(location = 0) out vec4 c;\nvoid main() {\n    c = vec4(parm);\n}\n";
    try {
        fragment(source);
        FAIL() << "compiled";
    } catch (const ShaderError& error) {
        EXPECT_EQ(error.kind(), ErrorKind::effect);
        EXPECT_EQ(error.stage(), "fragment");
        ASSERT_FALSE(error.messages().empty());
        EXPECT_EQ(error.messages()[0].line, 4);  // one more than in `source`: #version comes first
        EXPECT_EQ(error.messages()[0].column, 14);
        EXPECT_TRUE(error.messages()[0].error);
        EXPECT_NE(error.messages()[0].text.find("parm"), std::string::npos) << error.messages()[0].text;
        EXPECT_NE(std::string(error.what()).find("parm"), std::string::npos);
    }
    EXPECT_NO_THROW(context().check("the next pass"));
}

TEST_P(ProgramOn, NamesTheStageThatFailed) {
    const auto stage_of = [](const auto& action) -> std::string {
        try {
            action();
        } catch (const ShaderError& error) {
            return error.stage();
        }
        return "none";
    };
    const std::string good =
        "#version 450 core\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(1); }\n";
    const std::string unlinked =
        "#version 450 core\nvec4 f();\nlayout(location = 0) out vec4 c;\nvoid main() { c = f(); }\n";
    EXPECT_EQ(stage_of([&] { Program::draw(context(), "nonsense", good, "p"); }), "vertex");
    EXPECT_EQ(stage_of([&] { Program::draw(context(), kFullScreen, unlinked, "p"); }), "link");
    EXPECT_EQ(stage_of([&] { Program::compute(context(), "#version 450 core\nvoid main() { x; }", "p"); }),
              "compute");
    EXPECT_EQ(stage_of([&] { Program::draw(context(), kFullScreen, good, "p"); }), "none");
    EXPECT_EQ(stage_of([&] { Program::vertex(context(), "nonsense", "p"); }), "vertex");
    EXPECT_NO_THROW(context().check("the next pass"));
}

TEST_P(ProgramOn, KnowsItsKindAndLabel) {
    const Program draws = fragment("layout(location = 0) out vec4 c; void main() { c = vec4(1); }", "coc");
    EXPECT_EQ(draws.label(), "coc");
    EXPECT_FALSE(draws.is_compute());
    const Program computes = Program::compute(
        context(), "#version 450 core\nlayout(local_size_x = 1) in;\nvoid main() {}\n", "tiles");
    EXPECT_TRUE(computes.is_compute());
}

constexpr const char* kSharedVertex = R"(#version 450 core
out gl_PerVertex { vec4 gl_Position; };
layout(std140, binding = 3) uniform Block { float top; };
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : top, 0.0, 1.0); }
)";

std::string constant(const std::string& value) {
    return "#version 450 core\nlayout(location = 0) out vec4 c;\nvoid main() { c = vec4(" + value + "); }\n";
}

TEST_P(ProgramOn, DrawsFragmentsBehindOneVertexShader) {
    const auto vertex = std::make_shared<const Program>(Program::vertex(context(), kSharedVertex, "shared"));
    const Program two = Program::fragment(context(), vertex, constant("2.0"), "two");
    const Program three = Program::fragment(context(), vertex, constant("3.0"), "three");
    const Program whole = Program::draw(context(), kFullScreen, constant("5.0"), "whole");
    EXPECT_EQ(two.vertex_stage(), vertex.get());
    EXPECT_EQ(whole.vertex_stage(), nullptr);
    Buffer block(context(), 16, "block");
    const float top = -1;
    block.write(std::as_bytes(std::span(&top, 1)));
    const BufferBinding uniforms[] = {{&block, 3}};
    const Bindings bindings{.uniforms = uniforms};
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(drawn(two, 2, 1, bindings), std::vector<float>(8, 2.0F));
        EXPECT_EQ(drawn(whole, 2, 1), std::vector<float>(8, 5.0F)) << "a program of both stages between them";
        EXPECT_EQ(drawn(three, 2, 1, bindings), std::vector<float>(8, 3.0F));
    }
    try {
        drawn(*vertex, 2, 1, bindings);
        FAIL() << "drew without a fragment shader";
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "shared: a vertex shader cannot draw by itself");
    }
}

TEST_P(ProgramOn, TakesEachStageFromItsBinary) {
    const Program vertex_made = Program::vertex(context(), kSharedVertex, "vertex");
    const auto vertex_binary = vertex_made.binary();
    if (!vertex_binary) GTEST_SKIP() << "the driver writes no programs";
    auto loaded = Program::from_binary(context(), *vertex_binary, Stages::vertex, "vertex");
    ASSERT_TRUE(loaded);
    const auto vertex = std::make_shared<const Program>(std::move(*loaded));
    const Program made = Program::fragment(context(), vertex, constant("7.0"), "seven");
    const auto seven = Program::from_binary(context(), *made.binary(), Stages::fragment, "seven", vertex);
    ASSERT_TRUE(seven);
    Buffer block(context(), 16, "block");
    const float top = -1;
    block.write(std::as_bytes(std::span(&top, 1)));
    const BufferBinding uniforms[] = {{&block, 3}};
    EXPECT_EQ(drawn(*seven, 1, 1, {.uniforms = uniforms}), std::vector<float>(4, 7.0F));
}

void expect_message(const ShaderMessage& message, int line, int column, bool error, const std::string& text) {
    EXPECT_EQ(message.line, line);
    EXPECT_EQ(message.column, column);
    EXPECT_EQ(message.error, error);
    EXPECT_EQ(message.text, text);
}

TEST(ShaderLog, ReadsMesa) {
    const auto messages = parse_shader_log(
        "0:17(6): error: `parm' undeclared\n0:3(10): preprocessor error: syntax error\n0:20(1): warning: "
        "unused\n");
    ASSERT_EQ(messages.size(), 3U);
    expect_message(messages[0], 17, 6, true, "`parm' undeclared");
    expect_message(messages[1], 3, 10, true, "preprocessor: syntax error");
    expect_message(messages[2], 20, 1, false, "unused");
}

TEST(ShaderLog, ReadsNvidia) {
    const auto messages = parse_shader_log(
        "Fragment info\n-------------\n0(17) : error C1008: undefined variable \"parm\"\n"
        "0(2) : warning C7050: \"x\" might be used before being initialized\n");
    ASSERT_EQ(messages.size(), 2U);
    expect_message(messages[0], 17, 0, true, "undefined variable \"parm\"");
    expect_message(messages[1], 2, 0, false, "\"x\" might be used before being initialized");
}

TEST(ShaderLog, ReadsTheFormWithTheSeverityFirst) {
    const auto messages = parse_shader_log(
        "ERROR: 0:17: 'parm' : undeclared identifier\nWARNING: 0:3: odd\nERROR: 1 compilation errors. No "
        "code generated.\n");
    ASSERT_EQ(messages.size(), 2U);
    expect_message(messages[0], 17, 0, true, "'parm' : undeclared identifier");
    expect_message(messages[1], 3, 0, false, "odd");
}

TEST(ShaderLog, FoldsTheOverloadsOfACall) {
    std::string log = "0:3(5): error: no matching function for call to `f(int)'; candidates are:\n";
    for (const char* type : {"float", "vec2", "vec3", "vec4", "uint"})
        log += std::string("0:3(5): error:    ") + type + " f(" + type + ")\n";
    const auto messages = parse_shader_log(log + "0:4(1): error: type mismatch\n" + log);
    ASSERT_EQ(messages.size(), 3U);
    const std::string folded =
        "no matching function for call to `f(int)'; candidates are: float f(float); vec2 f(vec2); vec3 "
        "f(vec3); and 2 more";
    expect_message(messages[0], 3, 5, true, folded);
    expect_message(messages[1], 4, 1, true, "type mismatch");
    expect_message(messages[2], 3, 5, true, folded);
}

TEST(ShaderLog, KeepsLinkMessagesAndContinuationLines) {
    const auto messages =
        parse_shader_log("error: unresolved reference to function `f'\n  candidates are: g\n");
    ASSERT_EQ(messages.size(), 1U);
    expect_message(messages[0], 0, 0, true, "unresolved reference to function `f'\n  candidates are: g");
    EXPECT_TRUE(parse_shader_log("").empty());
    const auto unknown = parse_shader_log("something went wrong\r\n");
    ASSERT_EQ(unknown.size(), 1U);
    expect_message(unknown[0], 0, 0, true, "something went wrong");
}

}  // namespace
}  // namespace aftershade::gpu
