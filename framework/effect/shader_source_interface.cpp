// What `#include <pass>` stands for.
#include <algorithm>
#include <locale>
#include <sstream>
#include <utility>

#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/shader_source.h"

namespace aftershade {

namespace {

/// What the sampler of a read by the pixel is called, before the read's name: no author's word.
constexpr std::string_view kTexelsOf = "aftershade_texels_of_";

/// A float literal: "3" would divide as an integer, and without brackets "x -SKEW" might become "x --3".
std::string float_literal(double value) {
    std::string text = format_number(value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return value < 0 ? "(" + text + ")" : text;
}

std::string define_value(const ParamSpec& spec, const ParamValue& value) {
    if (spec.type->is_choice) return upper_case(spec.name) + "_" + upper_case(std::get<std::string>(value));
    const auto text = [&](double number) {
        if (!spec.type->is_integer) return float_literal(number);
        const std::string digits = std::to_string(std::int64_t(number));
        return number < 0 ? "(" + digits + ")" : digits;
    };
    std::string components;
    for (const double number : numbers_of(spec, value))
        components += (components.empty() ? "" : ", ") + text(number);
    return component_count(spec.type) == 1 ? components
                                           : std::string(spec.type->glsl_type) + "(" + components + ")";
}

/// "u" for unsigned, "i" for signed integers, "" for floats: the beginning of usampler2D, uimage2D and uvec4.
std::string type_prefix(gpu::TextureFormat format) {
    if (!gpu::is_integer(format)) return "";
    return gpu::is_signed_integer(format) ? "i" : "u";
}

std::string_view qualifier(AccessSpec::Kind kind) {
    switch (kind) {
        case AccessSpec::Kind::read: return "readonly ";
        case AccessSpec::Kind::write: return "writeonly ";
        case AccessSpec::Kind::atomic: break;
    }
    return "";
}

/// A host's global locale may write 1024 as 1.024.
std::ostringstream text_without_locale() {
    std::ostringstream text;
    text.imbue(std::locale::classic());
    return text;
}

class InterfaceWriter {
public:
    explicit InterfaceWriter(const ShaderContext& context)
        : context_(context),
          manifest_(*context.manifest),
          part_(context.part ? *context.part : FusedPart{}),
          bindings_(pass_bindings(context)) {}

    std::string write(ShaderFile file) {
        if (context_.pass->lists())
            if (const TileListSpec& list = *manifest_.tile_list_of(*context_.pass); list.has_common_text())
                return listing(list);
        defines();
        if (bindings_.has_param_block && has(kParamBinding)) params();
        shared_block(kFrameBinding, frame_block_glsl());
        shared_block(kCameraBinding, camera_block_glsl());
        if (manifest_.uses_lights) shared_block(kLightsBinding, lights_block_glsl());
        if (bindings_.has_pass_block && has(kPassBinding))
            text_ << "layout(std140, binding = " << block(kPassBinding) << ") uniform PassBlock {\n"
                  << "    int index;\n    int count;\n} pass;\n";
        if (bindings_.has_native_block && has(kNativeBinding)) native_uniforms();
        reads();
        param_resources();
        native_tables();
        images();
        buffers();
        if (file == ShaderFile::main) writes();
        return text_.str();
    }

private:
    /// Names and blocks are the same in every effect, so that its passes share a program and its machine
    /// code.
    std::string listing(const TileListSpec& list) {
        text_ << "#define TILE_RUNS tile_runs\n#define TILE_ARGS tile_args\n#define TILE_SIDE "
              << list.tile.number << "\nlayout(binding = 0) uniform "
              << type_prefix(format_of_read(manifest_, list.of->texture)) << "sampler2D " << kListedSampler
              << ";\nlayout(std140, binding = " << kSizeBinding
              << ") uniform SizeBlock {\n    vec4 listed_size;\n    vec4 tile_grid_size;\n};\n"
              << "layout(std430, binding = 0) writeonly buffer TileRunsBuffer { uvec4 tile_runs[]; };\n"
              << "layout(std430, binding = 1) buffer TileArgsBuffer { uint tile_args[]; };\n";
        return text_.str();
    }

    bool has(int block) const { return !part_.leaves_out(block); }
    int block(int binding) const { return part_.first_block + binding; }

    void shared_block(int binding, std::string_view glsl) {
        if (!has(binding)) return;
        const std::string own = "binding = " + std::to_string(binding);
        std::string text(glsl);
        text.replace(text.find(own), own.size(), "binding = " + std::to_string(block(binding)));
        text_ << text;
    }

    void defines() {
        presence();
        if (bindings_.has_tile_grid) tiles();
        for (const auto& [name, value] : context_.pass->defines)
            text_ << "#define " << name << " " << value << "\n";
        for (const ParamSpec& spec : manifest_.params) {
            const std::string name = upper_case(spec.name);
            for (std::size_t i = 0; i < spec.values.size(); ++i)
                text_ << "#define " << name << "_" << upper_case(spec.values[i]) << " " << i << "\n";
            if (spec.type->has_defines) text_ << context_.params.defines(spec);
            if (spec.bind == ParamBind::define)
                text_ << "#define " << name << " " << define_value(spec, context_.params.get(spec.name))
                      << "\n";
        }
    }

    /// HAS_... for what may be absent and is there.
    void presence() {
        std::vector<std::string> names;
        const auto add = [&](const std::string& name) {
            if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
        };
        for (const std::string& name : context_.present_inputs)
            if (manifest_.find_input(name)->optional && !is_left_out(name)) add(name);
        for (const ReadSpec& read : bindings_.reads)
            if (!read.when.empty()) add(read.glsl_name());
        for (const AccessSpec& image : bindings_.images)
            if (!image.when.empty()) add(image.name);
        for (const WriteSpec& write : bindings_.writes)
            if (!write.when.empty()) add("out_" + write.name);
        for (const std::string& name : names) text_ << "#define HAS_" << upper_case(name) << " 1\n";
    }

    /// Whether the pass reads this input, but not with these parameters.
    bool is_left_out(const std::string& input) const {
        const auto reads = [&](const ReadSpec& read) { return read.name == input && !read.previous; };
        const std::vector<ReadSpec>& all = context_.pass->reads;
        return std::any_of(all.begin(), all.end(), reads) &&
               std::none_of(bindings_.reads.begin(), bindings_.reads.end(), reads);
    }

    /// What glsl/host/list_tiles.comp and glsl/tile_runs.glsl go by.
    void tiles() {
        const TileListSpec& list = *manifest_.tile_list_of(*context_.pass);
        const ParamSpec* side = manifest_.find_param(list.tile.param);
        text_ << "#define TILE_RUNS " << list.runs() << "\n#define TILE_ARGS " << list.args()
              << "\n#define TILE_SIDE ";
        if (!side) text_ << list.tile.number << "\n";
        else if (side->bind == ParamBind::define) text_ << upper_case(side->name) << "\n";
        else text_ << "param." << side->name << "\n";
    }

    void params() {
        text_ << "layout(std140, binding = " << block(kParamBinding) << ") uniform ParamBlock {\n";
        for (const ParamSpec& spec : manifest_.params)
            if (spec.bind == ParamBind::uniform && is_block_type(spec.type))
                text_ << "    " << spec.type->glsl_type << " " << spec.name << ";\n";
        text_ << "} param;\n";
    }

    void native_uniforms() {
        text_ << "layout(std140, binding = " << block(kNativeBinding) << ") uniform NativeBlock {\n";
        for (const NativeUniformSpec& uniform : manifest_.native->uniforms)
            text_ << "    " << uniform.type << " " << uniform.name << ";\n";
        text_ << "} native;\n";
    }

    bool is_array(const std::string& name) const {
        const TextureSpec* texture = manifest_.find_texture(name);
        return texture && texture->layers > 1;
    }

    void reads() {
        const auto& reads = bindings_.reads;
        for (const ReadSpec& read : reads) {
            const std::string prefix = type_prefix(format_of_read(manifest_, read.name));
            const std::string name = read.glsl_name(), texel = prefix + "vec4 " + name;
            if (part_.is_held(name)) {
                text_ << texel << ";\n";
                continue;
            }
            text_ << "layout(binding = " << next_sampler_++ << ") uniform " << prefix
                  << (is_array(read.name) ? "sampler2DArray " : "sampler2D ")
                  << (read.is_pixel ? kTexelsOf : "") << name << ";\n";
            if (read.is_pixel)
                text_ << texel << " = texelFetch(" << kTexelsOf << name << ", ivec2(gl_FragCoord.xy), 0);\n";
        }
        if (!bindings_.has_sizes() || !has(kSizeBinding)) return;
        text_ << "layout(std140, binding = " << block(kSizeBinding) << ") uniform SizeBlock {\n";
        for (const ReadSpec& read : reads) text_ << "    vec4 " << read.glsl_name() << "_size;\n";
        for (const WriteSpec& write : bindings_.sized_writes)
            text_ << "    vec4 out_" << write.name << "_size;\n";
        if (bindings_.has_tile_grid) text_ << "    vec4 tile_grid_size;\n";
        text_ << "};\n";
    }

    void param_resources() {
        for (const ParamSpec* spec : bindings_.param_samplers)
            text_ << param_sampler_glsl(*spec, context_.file_of(spec->name), next_sampler_++);
        int binding = part_.first_buffer + bindings_.first_param_buffer;
        for (const ParamSpec* spec : bindings_.param_buffers)
            text_ << param_table_glsl(*spec, binding++, has_rows(*spec));
    }

    bool has_rows(const ParamSpec& spec) const {
        return !context_.params.has(spec.name) || context_.params.table_entries(spec) > 0;
    }

    void native_tables() {
        for (const NativeTableSpec* table : bindings_.native_tables)
            text_ << "layout(binding = " << next_sampler_++ << ") uniform "
                  << (table->element.starts_with('u') ? "usampler2D " : "sampler2D ") << table->name << ";\n";
    }

    void images() {
        const auto& images = bindings_.images;
        for (std::size_t i = 0; i < images.size(); ++i) {
            const gpu::TextureFormat format = format_of_write(manifest_, images[i].name);
            text_ << "layout(binding = " << i << ", " << gpu::texture_format_name(format) << ") "
                  << qualifier(images[i].kind) << "uniform " << type_prefix(format)
                  << (is_array(images[i].name) ? "image2DArray " : "image2D ") << images[i].name << ";\n";
        }
    }

    void buffers() {
        const auto& buffers = bindings_.buffers;
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            const std::string name = buffers[i].glsl_name();
            text_ << "layout(std430, binding = " << part_.first_buffer + int(i) << ") "
                  << qualifier(buffers[i].kind) << "buffer " << storage_block_name(name) << " { "
                  << manifest_.find_buffer(buffers[i].name)->element << " " << name << "[]; };\n";
        }
    }

    void writes() {
        const auto& writes = bindings_.writes;
        for (std::size_t i = 0; i < writes.size(); ++i) {
            const std::string type = texel_type(format_of_write(manifest_, writes[i].name));
            text_ << (context_.part ? "" : "layout(location = " + std::to_string(i) + ") out ") << type
                  << " out_" << writes[i].name << (context_.part ? " = " + type + "(0);\n" : ";\n");
        }
    }

    const ShaderContext& context_;
    const EffectManifest& manifest_;
    const FusedPart part_;
    const PassBindings bindings_;
    int next_sampler_ = part_.first_sampler;
    std::ostringstream text_ = text_without_locale();
};

}  // namespace

std::string texel_type(gpu::TextureFormat format) {
    const int channels = gpu::channel_count(format);
    const std::string prefix = type_prefix(format);
    if (channels == 1) return prefix == "u" ? "uint" : prefix == "i" ? "int" : "float";
    return prefix + "vec" + std::to_string(channels);
}

std::string interface_glsl(const ShaderContext& context, ShaderFile file) {
    return InterfaceWriter(context).write(file);
}

}  // namespace aftershade
