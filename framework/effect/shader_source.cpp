#include "framework/effect/shader_source.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "framework/core/units.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

std::string_view glsl_type(const ParamSpec& spec) {
    switch (spec.type) {
        case ParamType::bool_: return "bool";
        case ParamType::int_:
        case ParamType::enum_: return "int";
        case ParamType::float_:
        case ParamType::angle: return "float";
        case ParamType::vec2: return "vec2";
        case ParamType::color:
        case ParamType::vec3: return "vec3";
        case ParamType::vec4: return "vec4";
    }
    return "float";
}

/// A float literal: "3" would divide as an integer, and without brackets "x -SKEW" might become "x --3".
std::string float_literal(double value) {
    std::string text = format_number(value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return value < 0 ? "(" + text + ")" : text;
}

std::string define_value(const ParamSpec& spec, const ParamValue& value) {
    if (spec.type == ParamType::enum_) return upper(spec.name) + "_" + upper(std::get<std::string>(value));
    if (spec.type == ParamType::bool_) return std::get<bool>(value) ? "1" : "0";
    if (const auto* number = std::get_if<double>(&value)) return float_literal(*number);
    if (const auto* integer = std::get_if<std::int64_t>(&value))
        return *integer < 0 ? "(" + std::to_string(*integer) + ")" : std::to_string(*integer);
    std::string components;
    for (const double component : std::get<std::vector<double>>(value))
        components += (components.empty() ? "" : ", ") + float_literal(component);
    return std::string(glsl_type(spec)) + "(" + components + ")";
}

gpu::TextureFormat format_of(const EffectManifest& manifest, const std::string& name, bool written) {
    if (const TextureSpec* texture = manifest.find_texture(name)) return texture->format;
    return texture_format_of_role(written ? manifest.find_output(name)->role
                                          : manifest.find_input(name)->role);
}

std::string sampler_type(gpu::TextureFormat format) {
    if (!gpu::is_integer(format)) return "sampler2D";
    return gpu::is_signed_integer(format) ? "isampler2D" : "usampler2D";
}

std::string output_type(gpu::TextureFormat format) {
    const int channels = gpu::channel_count(format);
    const char* prefix = !gpu::is_integer(format) ? "" : gpu::is_signed_integer(format) ? "i" : "u";
    if (channels == 1) return *prefix == 'u' ? "uint" : *prefix == 'i' ? "int" : "float";
    return prefix + std::string("vec") + std::to_string(channels);
}

/// What `#include <pass>` stands for.
class InterfaceWriter {
public:
    explicit InterfaceWriter(const ShaderContext& context)
        : context_(context), manifest_(*context.manifest) {}

    std::string write() {
        defines();
        if (has_param_block(manifest_)) params();
        text_ << frame_block_glsl();
        reads();
        writes();
        return text_.str();
    }

private:
    void defines() {
        for (const std::string& name : context_.present_inputs)
            if (manifest_.find_input(name)->optional) text_ << "#define HAS_" << upper(name) << " 1\n";
        for (const auto& [name, value] : context_.pass->defines)
            text_ << "#define " << name << " " << value << "\n";
        for (const ParamSpec& spec : manifest_.params) {
            for (std::size_t i = 0; i < spec.values.size(); ++i)
                text_ << "#define " << upper(spec.name) << "_" << upper(spec.values[i]) << " " << i << "\n";
            if (spec.bind == ParamBind::define)
                text_ << "#define " << upper(spec.name) << " "
                      << define_value(spec, context_.params->get(spec.name)) << "\n";
        }
    }

    void params() {
        text_ << "layout(std140, binding = " << kParamBinding << ") uniform ParamBlock {\n";
        for (const ParamSpec& spec : manifest_.params)
            if (spec.bind == ParamBind::uniform)
                text_ << "    " << glsl_type(spec) << " " << spec.name << ";\n";
        text_ << "} param;\n";
    }

    void reads() {
        const auto reads = present_reads(manifest_, *context_.pass, context_.present_inputs);
        for (std::size_t i = 0; i < reads.size(); ++i)
            text_ << "layout(binding = " << i << ") uniform "
                  << sampler_type(format_of(manifest_, reads[i].name, false)) << " " << reads[i].name
                  << ";\n";
        if (reads.empty()) return;
        text_ << "layout(std140, binding = " << kSizeBinding << ") uniform SizeBlock {\n";
        for (const ReadSpec& read : reads) text_ << "    vec4 " << read.name << "_size;\n";
        text_ << "};\n";
    }

    void writes() {
        const auto& writes = context_.pass->writes;
        for (std::size_t i = 0; i < writes.size(); ++i)
            text_ << "layout(location = " << i << ") out "
                  << output_type(format_of(manifest_, writes[i], true)) << " out_" << writes[i] << ";\n";
    }

    const ShaderContext& context_;
    const EffectManifest& manifest_;
    std::ostringstream text_;
};

/// Expands includes into one text and remembers where each line came from: Mesa keeps the line of #line but
/// always prints source string 0, so a table of our own is the only way back.
class Assembler {
public:
    Assembler(const ShaderContext& context, Diagnostics& diagnostics)
        : context_(context), diagnostics_(diagnostics) {}

    ShaderSource assemble() {
        const fs::path file = context_.manifest->folder / context_.pass->shader;
        add_file(file, Place{file.string()});
        if (!has_version_ || !has_pass_)
            diagnostics_.error({file.string(), 1, 1},
                               "a shader begins with '#version 450 core' and then has '#include <pass>'");
        return std::move(source_);
    }

private:
    void add_line(const std::string& text, const std::string& file, int line) {
        source_.text += text + "\n";
        source_.lines.push_back({file, line});
    }

    void add_file(const fs::path& file, const Place& from) {
        if (!included_.insert(file).second) return;
        std::ifstream in(file);
        if (!in) {
            diagnostics_.error(from, "cannot read " + file.string());
            return;
        }
        std::string line;
        for (int number = 1; std::getline(in, line); ++number) {
            if (line.ends_with('\r')) line.pop_back();
            add_source_line(line, {file.string(), number, 1});
        }
    }

    void add_source_line(const std::string& line, const Place& place) {
        static const std::regex include(R"(^\s*#\s*include\s*([<"])([^">]*)[>"]\s*(//.*)?$)");
        static const std::regex version(R"(^\s*#\s*version\b.*)");
        std::smatch match;
        if (std::regex_match(line, match, include)) {
            add_include(match[1] == "<", match[2], place);
        } else if (std::regex_match(line, version)) {
            if (source_.lines.empty() && line == "#version 450 core") has_version_ = true;
            else diagnostics_.error(place, "'#version 450 core' stands once, as the first line of a shader");
            add_line(line, place.file, place.line);
        } else {
            add_line(line, place.file, place.line);
        }
    }

    void add_include(bool shared, const std::string& name, const Place& place) {
        if (shared && name == "pass") {
            if (std::exchange(has_pass_, true)) return;
            std::istringstream lines(InterfaceWriter(context_).write());
            for (std::string line; std::getline(lines, line);) add_line(line, "<generated>", place.line);
            return;
        }
        // Only plain file names: a shader cannot reach outside its own folder and glsl/.
        if (name.empty() || name.find('/') != std::string::npos || name.starts_with('.')) {
            diagnostics_.error(place, "'" + name + "' is not a plain file name");
            return;
        }
        add_file((shared ? context_.glsl_folder : context_.manifest->folder) / name, place);
    }

    const ShaderContext& context_;
    Diagnostics& diagnostics_;
    ShaderSource source_;
    std::set<fs::path> included_;
    bool has_version_ = false;
    bool has_pass_ = false;
};

}  // namespace

ShaderSource assemble_shader(const ShaderContext& context, Diagnostics& diagnostics) {
    return Assembler(context, diagnostics).assemble();
}

}  // namespace aftershade
