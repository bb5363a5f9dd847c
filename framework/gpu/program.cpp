#include "framework/gpu/program.h"

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

/// The 1-based line `number` of `text`; empty past its end.
std::string_view nth_line(std::string_view text, int number) {
    for (int i = 1; i < number; ++i) {
        const std::size_t end = text.find('\n');
        if (end == std::string_view::npos) return {};
        text.remove_prefix(end + 1);
    }
    return text.substr(0, text.find('\n'));
}

/// Mesa counts columns after its preprocessor has made one blank of each run of blanks: counts them in `line`
/// instead.
int written_column(std::string_view line, int column) {
    const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
    int mesa_column = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0 && is_blank(line[i]) && is_blank(line[i - 1])) continue;
        if (++mesa_column == column) return static_cast<int>(i) + 1;
    }
    return column;
}

std::vector<ShaderMessage> messages_of(const GladGLContext& gl, const std::string& source,
                                       const std::string& log) {
    std::vector<ShaderMessage> messages = parse_shader_log(log);
    const std::string_view version = reinterpret_cast<const char*>(gl.GetString(GL_VERSION));
    if (version.find("Mesa") == std::string_view::npos || source.find("#line") != std::string::npos)
        return messages;
    for (ShaderMessage& message : messages) {
        if (message.line > 0 && message.column > 0) {
            message.column = written_column(nth_line(source, message.line), message.column);
        }
    }
    return messages;
}

/// The log of a shader or a program, by GL's functions for the one or the other.
std::string info_log(GLuint object, PFNGLGETSHADERIVPROC get, PFNGLGETSHADERINFOLOGPROC get_log) {
    GLint size = 0;
    get(object, GL_INFO_LOG_LENGTH, &size);
    std::string log(static_cast<std::size_t>(std::max(size, 1)), '\0');
    GLsizei length = 0;
    get_log(object, static_cast<GLsizei>(log.size()), &length, log.data());
    log.resize(static_cast<std::size_t>(length));
    return log;
}

/// A compiled shader until it is in its program.
class Stage {
public:
    Stage(const GladGLContext& gl, GLenum kind, std::string name, const std::string& source,
          const std::string& label)
        : gl_(gl), handle_(gl.CreateShader(kind)) {
        const char* text = source.c_str();
        const auto length = static_cast<GLint>(source.size());
        gl_.ShaderSource(handle_, 1, &text, &length);
        gl_.CompileShader(handle_);
        GLint compiled = 0;
        gl_.GetShaderiv(handle_, GL_COMPILE_STATUS, &compiled);
        if (compiled) {
            set_label(gl_, GL_SHADER, handle_, label);
            return;
        }
        const std::string log = info_log(handle_, gl_.GetShaderiv, gl_.GetShaderInfoLog);
        gl_.DeleteShader(handle_);
        throw ShaderError(std::move(name), messages_of(gl_, source, log), log);
    }
    ~Stage() { gl_.DeleteShader(handle_); }
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;

    GLuint handle() const { return handle_; }

private:
    const GladGLContext& gl_;
    GLuint handle_;
};

bool is_separable(Stages stages) {
    return stages == Stages::vertex || stages == Stages::fragment;
}

GLuint new_program(const GladGLContext& gl, Stages stages) {
    const GLuint program = gl.CreateProgram();
    gl.ProgramParameteri(program, GL_PROGRAM_BINARY_RETRIEVABLE_HINT, GL_TRUE);
    if (is_separable(stages)) gl.ProgramParameteri(program, GL_PROGRAM_SEPARABLE, GL_TRUE);
    return program;
}

GLuint link(const GladGLContext& gl, Stages kind, std::initializer_list<const Stage*> stages,
            const std::string& label) {
    const GLuint program = new_program(gl, kind);
    for (const Stage* stage : stages) gl.AttachShader(program, stage->handle());
    gl.LinkProgram(program);
    for (const Stage* stage : stages) gl.DetachShader(program, stage->handle());
    GLint linked = 0;
    gl.GetProgramiv(program, GL_LINK_STATUS, &linked);
    if (!linked) {
        const std::string log = info_log(program, gl.GetProgramiv, gl.GetProgramInfoLog);
        gl.DeleteProgram(program);
        throw ShaderError("link", parse_shader_log(log), log);
    }
    set_label(gl, GL_PROGRAM, program, label);
    return program;
}

/// glProgramBinary reports an error for a format that it does not know, and only then.
bool knows_format(const GladGLContext& gl, GLenum format) {
    GLint count = 0;
    gl.GetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &count);
    std::vector<GLint> formats(static_cast<std::size_t>(std::max(count, 0)));
    if (!formats.empty()) gl.GetIntegerv(GL_PROGRAM_BINARY_FORMATS, formats.data());
    return std::find(formats.begin(), formats.end(), static_cast<GLint>(format)) != formats.end();
}

}  // namespace

ShaderError::ShaderError(std::string stage, std::vector<ShaderMessage> messages, const std::string& log)
    : Error(ErrorKind::effect, log), stage_(std::move(stage)), messages_(std::move(messages)) {}

Program Program::draw(Context& context, const std::string& vertex, const std::string& fragment,
                      std::string label) {
    context.make_current();
    const GladGLContext& gl = context.gl();
    const Stage vertex_stage(gl, GL_VERTEX_SHADER, "vertex", vertex, label);
    const Stage fragment_stage(gl, GL_FRAGMENT_SHADER, "fragment", fragment, label);
    const GLuint handle = link(gl, Stages::draw, {&vertex_stage, &fragment_stage}, label);
    Program program(context, handle, Stages::draw, std::move(label));
    context.check(fmt::format("program '{}'", program.label()));
    return program;
}

Program Program::of_one_stage(Context& context, Stages stages, const std::string& source, std::string label,
                              std::shared_ptr<const Program> vertex) {
    context.make_current();
    const GladGLContext& gl = context.gl();
    const bool is_vertex = stages == Stages::vertex, is_compute = stages == Stages::compute;
    const Stage stage(gl,
                      is_vertex    ? GL_VERTEX_SHADER
                      : is_compute ? GL_COMPUTE_SHADER
                                   : GL_FRAGMENT_SHADER,
                      is_vertex    ? "vertex"
                      : is_compute ? "compute"
                                   : "fragment",
                      source, label);
    const GLuint handle = link(gl, stages, {&stage}, label);
    Program program(context, handle, stages, std::move(label), std::move(vertex));
    context.check(fmt::format("program '{}'", program.label()));
    return program;
}

Program Program::vertex(Context& context, const std::string& source, std::string label) {
    return of_one_stage(context, Stages::vertex, source, std::move(label));
}

Program Program::fragment(Context& context, std::shared_ptr<const Program> vertex, const std::string& source,
                          std::string label) {
    assert(vertex && vertex->stages() == Stages::vertex);
    return of_one_stage(context, Stages::fragment, source, std::move(label), std::move(vertex));
}

Program Program::compute(Context& context, const std::string& source, std::string label) {
    return of_one_stage(context, Stages::compute, source, std::move(label));
}

std::optional<Program> Program::from_binary(Context& context, const ProgramBinary& binary, Stages stages,
                                            std::string label, std::shared_ptr<const Program> vertex) {
    assert((stages == Stages::fragment) == (vertex != nullptr));
    context.make_current();
    const GladGLContext& gl = context.gl();
    if (!knows_format(gl, binary.format)) return std::nullopt;
    const GLuint handle = new_program(gl, stages);
    gl.ProgramBinary(handle, binary.format, binary.bytes.data(), static_cast<GLsizei>(binary.bytes.size()));
    GLint linked = 0;
    gl.GetProgramiv(handle, GL_LINK_STATUS, &linked);
    Program program(context, handle, stages, std::move(label), std::move(vertex));
    context.check(fmt::format("program '{}' from its binary", program.label()));
    if (!linked) return std::nullopt;
    set_label(gl, GL_PROGRAM, handle, program.label());
    return program;
}

std::optional<ProgramBinary> Program::binary() const {
    handle_.context().make_current();
    const GladGLContext& gl = handle_.context().gl();
    GLint size = 0;
    gl.GetProgramiv(handle(), GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0) return std::nullopt;
    ProgramBinary binary;
    binary.bytes.resize(static_cast<std::size_t>(size));
    GLsizei written = 0;
    GLenum format = 0;
    gl.GetProgramBinary(handle(), size, &written, &format, binary.bytes.data());
    handle_.context().check(fmt::format("the binary of program '{}'", label_));
    binary.bytes.resize(static_cast<std::size_t>(std::max(written, 0)));
    binary.format = format;
    if (binary.bytes.empty()) return std::nullopt;
    return binary;
}

template <>
void Handle<ObjectKind::program>::remove(Context& context, unsigned int name) noexcept {
    if (context.impl().try_make_current()) context.gl().DeleteProgram(name);
}

Program::Program(Context& context, unsigned int handle, Stages stages, std::string label,
                 std::shared_ptr<const Program> vertex)
    : handle_(context, handle), stages_(stages), vertex_(std::move(vertex)), label_(std::move(label)) {}

}  // namespace aftershade::gpu
