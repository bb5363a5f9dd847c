#include "framework/effect/pass_program.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "framework/core/error.h"

namespace aftershade {

namespace {

std::string read_text(const std::filesystem::path& file) {
    std::ifstream in(file);
    std::ostringstream text;
    text << in.rdbuf();
    if (!in) throw Error(ExitCode::effect, file.string() + ": cannot be read");
    return text.str();
}

Place author_place(const ShaderSource& source, const gpu::ShaderMessage& message) {
    if (message.line < 1 || message.line > int(source.lines.size())) return {"shader"};
    const SourceLine& line = source.lines[std::size_t(message.line) - 1];
    return {line.file, line.line, message.column};
}

std::string trimmed(std::ostringstream& text) {
    std::string result = text.str();
    while (result.ends_with('\n')) result.pop_back();
    return result;
}

}  // namespace

ProgramCache::ProgramCache(gpu::Context& context, std::filesystem::path glsl_folder)
    : context_(context),
      glsl_folder_(std::move(glsl_folder)),
      vertex_(read_text(glsl_folder_ / "fullscreen.vert")) {}

const gpu::Program& ProgramCache::get(const ShaderContext& context) {
    const std::string where = "pass " + context.pass->name + ", " + context_.info().renderer;
    Diagnostics faults;
    const ShaderSource source = assemble_shader(context, faults);
    if (!faults.has_errors()) {
        const auto known = programs_.find(source.text);
        if (known != programs_.end()) return known->second;
        try {
            const std::string label = context.manifest->id + "." + context.pass->name;
            auto program = gpu::Program::draw(context_, vertex_, source.text, label);
            return programs_.emplace(source.text, std::move(program)).first->second;
        } catch (const gpu::ShaderError& error) {
            for (const gpu::ShaderMessage& message : error.messages())
                if (message.error)
                    faults.error(author_place(source, message), message.text + "   [" + where + "]");
            if (!faults.has_errors())
                faults.error({(context.manifest->folder / context.pass->shader).string()}, error.what());
        }
    }
    std::ostringstream text;
    faults.print(text);
    throw Error(ExitCode::effect, trimmed(text));
}

}  // namespace aftershade
