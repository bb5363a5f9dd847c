#include "framework/effect/pass_program.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <string>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/document/glsl_text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/isf/isf_vocabulary.h"
#include "framework/effect/usage_check.h"

namespace aftershade {

namespace {

/// The place that a message without a line names, as linkers write them: "function `float f(float)' has
/// static recursion".
Place named_place(const ShaderSource& source, const std::string& message) {
    const std::size_t quote = message.find('`'), bracket = message.find('(', quote);
    if (quote != std::string::npos && bracket != std::string::npos) {
        const std::size_t before = message.find_last_of("` ", bracket);
        const std::string name = message.substr(before + 1, bracket - before - 1);
        for (const Token& token : glsl_tokens(source))
            if (token.text == name) return token.place();
    }
    return source.lines.empty() ? Place{"shader"} : Place{source.lines.front().file.text()};
}

Place author_place(const ShaderSource& source, const gpu::ShaderMessage& message) {
    // The host renames the main() of an ISF file, to draw around it.
    if (message.text.find("isf_main") != std::string::npos)
        for (const Token& token : glsl_tokens(source))
            if (token.text == "isf_main" && is_isf_shader(*token.file)) return token.place();
    if (message.line < 1 || message.line > int(source.lines.size())) return named_place(source, message.text);
    const SourceLine& line = source.lines[std::size_t(message.line) - 1];
    // What an ISF file leaves open is found in the host's text behind it.
    if (line.file.text().ends_with("isf/fragment_main.glsl") ||
        line.file.text().ends_with("isf/vertex_main.glsl"))
        for (std::size_t before = std::size_t(message.line) - 1; before > 0; --before)
            if (const SourceLine& last = source.lines[before - 1]; is_isf_shader(last.file.text()))
                return {last.file.text(), last.line, 1};
    return {line.file.text(), line.line, message.column};
}

constexpr const char* kMain = R"(
#undef main
$declarations
void main() {
    $before
    aftershade_author_main();
    $after
}
)";

/// llvmpipe (Mesa 22.3 to 25: lp_bld_limits.h) counts the iterations of all loops of an invocation together,
/// and ends each loop after its first once 65,535 are over, without an error. So does it with a loop of two
/// behind the author's main, whose bound no compiler can know.
constexpr const char* kLoopGuardBlock =
    "layout(std430, binding = $binding) restrict buffer AftershadeLoopGuard { uint aftershade_loops_ended; "
    "};";
constexpr const char* kLoopGuard = R"(
    int wanted = 2 + int(aftershade_loops_ended >> 1), turns = 0;
    while (turns < wanted) ++turns;
    if (turns < wanted) aftershade_loops_ended = 1u;)";

/// A main around the author's: targets that this one leaves out are 0, not what was left in memory.
void wrap_main(ShaderSource& source, const std::string& before, bool guards) {
    source.text.insert(source.text.find('\n') + 1, "#define main aftershade_author_main\n");
    source.lines.insert(source.lines.begin() + 1, SourceLine{"<generated>", 1});
    const std::string block = filled(kLoopGuardBlock, {{"binding", std::to_string(kLoopGuardBinding)}});
    source.text += filled(
        kMain,
        {{"declarations", guards ? block : ""}, {"before", before}, {"after", guards ? kLoopGuard : ""}});
}

/// A text that has a target's name once only declares it.
bool has_twice(const std::string& text, const std::string& word) {
    return text.find(word, text.find(word) + 1) != std::string::npos;
}

/// Host programs, which have no lines, are short.
bool has_loop(const ShaderSource& source) {
    return has_any_word(source, {"for", "while"});
}

std::string with_includes(const std::filesystem::path& file, const std::filesystem::path& glsl_folder) {
    std::istringstream lines(read_text_file(file, ErrorKind::effect));
    std::string text, line;
    while (std::getline(lines, line)) {
        const std::optional<ShaderInclude> include = parse_include(line);
        text += include ? read_text_file(glsl_folder / include->name, ErrorKind::effect) : line + "\n";
    }
    return text;
}

}  // namespace

ProgramCache::ProgramCache(gpu::Context& context, std::filesystem::path glsl_folder, ProgramStore store)
    : context_(context),
      glsl_folder_(std::move(glsl_folder)),
      store_(std::move(store)),
      full_screen_(read_text_file(glsl_folder_ / "fullscreen.vert", ErrorKind::effect)),
      over_tiles_(with_includes(glsl_folder_ / "host" / "tiles.vert", glsl_folder_)) {}

ProgramSources ProgramCache::sources_of(const ShaderContext& context, Diagnostics& faults) {
    ProgramSources sources;
    sources.label = context.manifest->id + "." + context.pass->name;
    sources.is_compute = context.pass->compute() != nullptr;
    sources.main = assemble_shader(context, faults);
    const bool guards = guards_loops_ && !faults.has_errors();
    std::string zeros;
    for (const WriteSpec& write : pass_bindings(context).writes) {
        const std::string target = "out_" + write.name;
        zeros += target + " = " + texel_type(format_of_write(*context.manifest, write.name)) + "(0); ";
        if (!faults.has_errors() && !has_twice(sources.main.text, target))
            warnings_.push_back("pass '" + context.pass->name + "': '" + context.pass->shader +
                                "' writes nothing to '" + target +
                                "', which is 0 (aftershade check finds such faults)");
    }
    if (!faults.has_errors() && (guards || !zeros.empty())) wrap_main(sources.main, zeros, guards);
    if (sources.is_compute) return sources;
    const bool has_vertex = context.pass->vertex() != nullptr;
    if (has_vertex) sources.vertex_lines = assemble_shader(context, faults, ShaderFile::vertex);
    if (has_vertex && guards && !faults.has_errors()) wrap_main(sources.vertex_lines, "", true);
    sources.vertex = has_vertex             ? sources.vertex_lines.text
                     : context.pass->over() ? over_tiles_
                                            : full_screen_;
    return sources;
}

namespace {

gpu::Stages stages_of(const ProgramSources& sources) {
    if (sources.is_compute) return gpu::Stages::compute;
    return sources.shares_vertex() ? gpu::Stages::fragment : gpu::Stages::draw;
}

const char* name_of(gpu::Stages stages) {
    switch (stages) {
        case gpu::Stages::draw: return "draw";
        case gpu::Stages::compute: return "compute";
        case gpu::Stages::vertex: return "vertex";
        case gpu::Stages::fragment: break;
    }
    return "fragment";
}

}  // namespace

std::string ProgramCache::key_of(gpu::Stages stages, const std::string& vertex,
                                 const std::string& main) const {
    const gpu::ContextInfo& gl = context_.info();
    std::string key = "aftershade " AFTERSHADE_VERSION "\n" + gl.vendor + "\n" + gl.renderer + "\n" +
                      gl.version + "\n" + name_of(stages) + "\n";
    // The length keeps the two texts apart.
    key += std::to_string(vertex.size()) + "\n" + vertex + main;
    return key;
}

/// With the text of a vertex shader that it shares: programs are held by this key, too.
std::string ProgramCache::key_of(const ProgramSources& sources) const {
    return key_of(stages_of(sources), sources.vertex, sources.main.text);
}

/// From the store, else by `make`, and then kept there.
template <typename Make>
ProgramCache::Kept ProgramCache::kept(const std::string& key, gpu::Stages stages, const std::string& label,
                                      const std::shared_ptr<const gpu::Program>& vertex, const Make& make) {
    if (const auto binary = store_.load(key))
        if (auto program = gpu::Program::from_binary(context_, *binary, stages, label, vertex))
            return {std::move(*program), binary->bytes.size(), true};
    Kept made{make(), 0, false};
    if (store_.is_on())
        if (const auto binary = made.program.binary()) {
            store_.save(key, *binary);
            made.binary_bytes = binary->bytes.size();
        }
    return made;
}

std::shared_ptr<const gpu::Program> ProgramCache::vertex_stage(const std::string& text) {
    std::shared_ptr<const gpu::Program>& stage = vertex_stages_[text];
    if (stage) return stage;
    const std::string label = "host.vertex";
    Kept found = kept(key_of(gpu::Stages::vertex, text, ""), gpu::Stages::vertex, label, nullptr,
                      [&] { return gpu::Program::vertex(context_, text, label); });
    return stage = std::make_shared<const gpu::Program>(std::move(found.program));
}

gpu::Program ProgramCache::make(const ProgramSources& sources, const std::string& key,
                                std::size_t& binary_bytes) {
    const gpu::Stages stages = stages_of(sources);
    const std::shared_ptr<const gpu::Program> vertex =
        stages == gpu::Stages::fragment ? vertex_stage(sources.vertex) : nullptr;
    Kept found = kept(key, stages, sources.label, vertex, [&] {
        const std::string& main = sources.main.text;
        if (vertex) return gpu::Program::fragment(context_, vertex, main, sources.label);
        return sources.is_compute ? gpu::Program::compute(context_, main, sources.label)
                                  : gpu::Program::draw(context_, sources.vertex, main, sources.label);
    });
    ++(found.is_loaded ? loaded_ : compiled_);
    binary_bytes = found.binary_bytes;
    return std::move(found.program);
}

std::size_t ProgramCache::binary_bytes(const ProgramSources& sources) const {
    const auto found = programs_.find(key_of(sources));
    return found == programs_.end() ? 0 : found->second.binary_bytes;
}

bool ProgramCache::has(const ProgramSources& sources) const {
    const std::string key = key_of(sources);
    std::error_code failure;
    return programs_.contains(key) ||
           (store_.is_on() && std::filesystem::exists(store_.file_of(key), failure));
}

std::shared_ptr<const gpu::Program> ProgramCache::get(const ProgramSources& sources) {
    const std::string key = key_of(sources);
    Cached& cached = programs_[key];
    if (!cached.program) {
        try {
            gpu::Program program = make(sources, key, cached.binary_bytes);
            if (has_loop(sources.main)) program.use_one_form();
            cached.program = std::make_shared<const gpu::Program>(std::move(program));
        } catch (...) {
            programs_.erase(key);
            throw;
        }
    }
    cached.last_use = ++uses_;
    const std::shared_ptr<const gpu::Program> program = cached.program;
    drop_idle();
    return program;
}

/// Values that are compiled in leave a program behind with each step of a slider.
void ProgramCache::drop_idle() {
    const auto is_idle = [](const auto& entry) { return entry.second.program.use_count() == 1; };
    if (std::ranges::count_if(programs_, is_idle) <= std::ptrdiff_t(kMostIdlePrograms)) return;
    auto oldest = programs_.end();
    for (auto entry = programs_.begin(); entry != programs_.end(); ++entry)
        if (is_idle(*entry) &&
            (oldest == programs_.end() || entry->second.last_use < oldest->second.last_use))
            oldest = entry;
    programs_.erase(oldest);
}

ProgramSources ProgramCache::host_sources(const std::string& file,
                                          const std::vector<std::string>& defines) const {
    std::string text = read_text_file(glsl_folder_ / "host" / file, ErrorKind::effect), symbols;
    for (const std::string& define : defines) symbols += "#define " + define + " 1\n";
    text.insert(text.find('\n') + 1, symbols);
    return full_screen(std::move(text), "host." + file);
}

ProgramSources ProgramCache::full_screen(std::string text, std::string label) const {
    ProgramSources sources;
    sources.vertex = full_screen_;
    sources.main.text = std::move(text);
    sources.label = std::move(label);
    return sources;
}

std::optional<ProgramSources> in_compute_form(ProgramSources draw, const DrawShape& shape,
                                              std::string& why_not) {
    // What the host has written behind the author's text has none, nor has a text of its own.
    draw.main.lines.resize(std::size_t(std::ranges::count(draw.main.text, '\n')), {"<generated>", 1});
    why_not = to_compute_form(draw.main, shape);
    if (!why_not.empty()) return std::nullopt;
    draw.is_compute = true;
    draw.vertex.clear();
    return draw;
}

ProgramSources ProgramCache::sources_of(const FusedProgram& passes, Diagnostics& faults) const {
    ProgramSources sources;
    sources.vertex = full_screen_;
    sources.main = assemble_fused(passes, faults);
    for (const FusedShader& part : passes.parts)
        sources.label +=
            (sources.label.empty() ? "" : "+") + part.shader.manifest->id + "." + part.shader.pass->name;
    return sources;
}

namespace {

/// A wrong name in the shader is found by its text, too, which offers the right one.
void add_hints(const EffectManifest& manifest, const std::filesystem::path& glsl_folder,
               const ShaderSource& source, Diagnostics& faults) {
    std::set<std::string> files;
    for (const SourceLine& line : source.lines) files.insert(line.file.text());
    Diagnostics hints;
    check_declared_used(manifest, glsl_folder, hints);
    for (const Diagnostic& hint : hints.all())
        if (files.contains(hint.place.file)) faults.error(hint.place, hint.message);
}

}  // namespace

std::shared_ptr<const gpu::Program> ProgramCache::get(const ShaderContext& context) {
    Diagnostics faults;
    const ProgramSources sources = sources_of(context, faults);
    return get(context, sources, faults);
}

std::shared_ptr<const gpu::Program> ProgramCache::get(const ShaderContext& context,
                                                      const ProgramSources& sources, Diagnostics& faults) {
    const PassSpec& pass = *context.pass;
    const std::string where = "pass " + pass.name + ", " + context_.info().renderer;
    if (!faults.has_errors()) {
        try {
            return get(sources);
        } catch (const gpu::ShaderError& error) {
            const ShaderSource& source = sources.of_stage(error.stage());
            add_hints(*context.manifest, glsl_folder_, source, faults);
            for (const gpu::ShaderMessage& message : error.messages())
                if (message.error)
                    faults.error(author_place(source, message),
                                 (is_isf_path(context.manifest->document) ? with_isf_names(message.text)
                                                                          : message.text) +
                                     "   [" + where + "]");
            if (!faults.has_errors()) faults.error({(pass.folder / pass.shader).string()}, error.what());
        }
    }
    throw Error(ErrorKind::effect, faults);
}

}  // namespace aftershade
