// Compiled GLSL: a vertex and a fragment shader, one of them by itself, or a compute shader.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/gpu/context.h"
#include "framework/gpu/handle.h"

namespace aftershade::gpu {

/// One line of the driver's log. Mesa prints "0:17(6): error: ...", NVIDIA "0(17) : error C1008: ...".
struct ShaderMessage {
    int line = 0;    ///< 1-based line of the text given to Program, 0 where the log names none
    int column = 0;  ///< 1-based, 0 where unknown
    bool error = true;
    std::string text;
};

/// A shader that did not compile or link. what() is the whole log.
class ShaderError : public Error {
public:
    ShaderError(std::string stage, std::vector<ShaderMessage> messages, const std::string& log);
    const std::string& stage() const { return stage_; }  ///< "vertex", "fragment", "compute" or "link"
    const std::vector<ShaderMessage>& messages() const { return messages_; }

private:
    std::string stage_;
    std::vector<ShaderMessage> messages_;
};

/// Splits a driver's log into messages; public because its tests need no GL.
std::vector<ShaderMessage> parse_shader_log(const std::string& log);

/// A linked program as its driver writes it: of use to this driver in this version alone.
struct ProgramBinary {
    unsigned int format = 0;  ///< the driver's
    std::vector<std::byte> bytes;
};

/// The shaders of a program.
enum class Stages { draw, compute, vertex, fragment };

/// Bindings are fixed in the text by layout(binding = N); there is no lookup by name at draw time.
/// [the context's thread]
class Program {
public:
    /// Throws ShaderError.
    static Program draw(Context& context, const std::string& vertex, const std::string& fragment,
                        std::string label);
    static Program compute(Context& context, const std::string& source, std::string label);
    /// A vertex shader that many fragment shaders share: a driver then makes its machine code once. It
    /// redeclares what it writes: `out gl_PerVertex { vec4 gl_Position; };`. It cannot draw by itself.
    static Program vertex(Context& context, const std::string& source, std::string label);
    /// Draws behind `vertex`, a program of that stage alone, and takes nothing from it but the position.
    static Program fragment(Context& context, std::shared_ptr<const Program> vertex,
                            const std::string& source, std::string label);
    /// nullopt where the driver refuses it, as it may at any time (an update, other hardware): compile
    /// instead. The bytes must be as binary() gave them; drivers do not defend themselves against others.
    /// `vertex`: of a fragment shader.
    static std::optional<Program> from_binary(Context& context, const ProgramBinary& binary, Stages stages,
                                              std::string label,
                                              std::shared_ptr<const Program> vertex = nullptr);

    const std::string& label() const { return label_; }
    Stages stages() const { return stages_; }
    bool is_compute() const { return stages_ == Stages::compute; }
    /// Of a fragment shader by itself; else null.
    const Program* vertex_stage() const { return vertex_.get(); }
    /// llvmpipe makes two forms of a fragment shader's machine code, one for blocks of pixels that a draw
    /// covers whole, which need not be read. With the other alone, half is left to compile, and writing a
    /// pixel takes some instructions more: a frame of `dof` 0.3 % more, one of `motion_blur` 0.1 %.
    void use_one_form() { has_one_form_ = true; }
    bool has_one_form() const { return has_one_form_; }
    /// nullopt where the driver gives none.
    std::optional<ProgramBinary> binary() const;
    unsigned int handle() const { return handle_.name(); }  ///< for framework/gpu

private:
    static Program of_one_stage(Context& context, Stages stages, const std::string& source, std::string label,
                                std::shared_ptr<const Program> vertex = nullptr);
    Program(Context& context, unsigned int handle, Stages stages, std::string label,
            std::shared_ptr<const Program> vertex = nullptr);
    Handle<ObjectKind::program> handle_;
    Stages stages_ = Stages::draw;
    std::shared_ptr<const Program> vertex_;
    bool has_one_form_ = false;
    std::string label_;
};

}  // namespace aftershade::gpu
