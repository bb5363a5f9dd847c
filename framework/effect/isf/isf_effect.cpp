#include "framework/effect/isf/isf_effect.h"

#include <algorithm>
#include <utility>

#include "framework/base/text.h"
#include "framework/effect/glsl_names.h"
#include "framework/effect/isf/isf_file.h"
#include "framework/effect/isf/isf_formula.h"
#include "framework/effect/isf/isf_nodes.h"
#include "framework/effect/isf/isf_params.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Type = IsfInput::Type;

/// Words of GLSL 4.50 that older files may name things by.
const std::set<std::string> kNewWords = {"active",    "buffer", "coherent", "common",     "filter",
                                         "partition", "patch",  "precise",  "readonly",   "resource",
                                         "restrict",  "sample", "shared",   "subroutine", "writeonly"};
/// The blocks of the host's interface.
const std::set<std::string> kBlocks = {"param", "frame", "camera", "lights", "pass", "native"};

class EffectMaker {
public:
    EffectMaker(const IsfFile& file, std::string id, IsfSpace space)
        : file_(file), id_(std::move(id)), space_(space), words_(file), names_(file, words_) {
        output_ = space == IsfSpace::display ? kDisplayRole : kColorRole;
        nothing_ = names_.make("nothing");
        find_images();
    }

    IsfEffect make() {
        Node& manifest = effect_.manifest = object_node(file_.place);
        add_member(manifest, "aftershade", number_node(file_.place, 1));
        add_member(manifest, "id", text(id_));
        add_member(manifest, "version", text("1.0.0"));
        add_member(manifest, "summary",
                   text(file_.summary.empty() ? "The ISF filter " + stem() + "." : file_.summary));
        std::string source =
            "Interactive Shader Format, https://isf.video: " + file_.path.filename().string();
        if (!file_.credit.empty()) source += ", " + file_.credit;
        add_member(manifest, "sources", list_node(file_.place, {text(source)}));
        passes();  // says which textures there are
        // RENDERSIZE and places in the picture are those of all of it.
        add_member(manifest, "reach", text("all"));
        add_member(manifest, "inputs", inputs());
        add_member(manifest, "outputs",
                   object_node(file_.place, {{output_, object({{"role", text(output_)}})}}));
        add_member(manifest, "params", params());
        add_member(manifest, "textures", textures());
        add_member(manifest, "passes", list_node(file_.place, std::move(passes_)));
        effect_.shaders[id_ + ".frag"] = shader("fragment", file_.path.filename().string());
        if (has_vertex()) effect_.shaders[id_ + ".vert"] = shader("vertex", file_.vertex_file);
        return std::move(effect_);
    }

private:
    /// Something that the shader samples.
    struct Image {
        std::string isf_name = {}, name = {};
        const IsfInput* input = nullptr;  ///< of an image input
        const IsfPass* target = nullptr;  ///< the first pass that writes it
        bool is_file = false;             ///< an import or sound
        bool is_optional = false;
        std::string role = {};
    };

    Node text(std::string value) const { return text_node(file_.place, std::move(value)); }
    Node object(std::vector<std::pair<std::string, Node>> members) const {
        return object_node(file_.place, std::move(members));
    }
    std::string stem() const { return file_.path.stem().string(); }
    bool has_vertex() const { return !file_.vertex_file.empty(); }
    /// A role of a capture whose image is no picture: depth, motion, directions, masks.
    static bool is_data(const std::string& name) {
        const auto role = find_role(name);
        return role && (role->kind == RoleKind::distance || role->kind == RoleKind::motion ||
                        role->kind == RoleKind::direction || role->kind == RoleKind::coverage);
    }
    bool is_linear() const { return space_ == IsfSpace::linear; }

    void find_images() {
        for (const IsfInput& input : file_.inputs) {
            if (input.type != Type::image && input.type != Type::audio) continue;
            Image image{input.name, names_.of(input.name), &input, nullptr, input.type == Type::audio};
            const std::string& name = image.isf_name;
            image.is_optional = is_data(name);
            image.role = image.is_optional ? name : output_;
            if (words_.all.contains(name)) images_.push_back(std::move(image));
        }
        for (const IsfImport& import : file_.imports)
            images_.push_back({import.name, names_.of(import.name), nullptr, nullptr, true});
        for (const IsfPass& pass : file_.passes) {
            const auto same = [&](const Image& image) { return image.isf_name == pass.target; };
            if (!pass.target.empty() && std::ranges::none_of(images_, same))
                images_.push_back({pass.target, names_.of(pass.target), nullptr, &pass});
        }
    }

    // ---- what the effect declares ----

    Node inputs() const {
        Node inputs = object({});
        for (const Image& image : images_) {
            if (!image.input || image.is_file) continue;
            Node input = object_node(image.input->place, {{"role", text(image.role)}});
            if (image.is_optional) add_member(input, "optional", bool_node(file_.place, true));
            add_member(input, "doc",
                       text((image.input->label.empty() ? image.isf_name : image.input->label) + "."));
            inputs.members.push_back({image.name, image.input->place, std::move(input)});
        }
        return inputs;
    }

    Node params() const {
        Node params = object({});
        for (const IsfInput& input : file_.inputs)
            if (input.type != Type::image && (input.type != Type::audio || words_.all.contains(input.name)))
                add_member(params, names_.of(input.name), param_of_input(file_, input));
        for (const IsfImport& import : file_.imports)
            add_member(params, names_.of(import.name), param_of_import(import));
        return params;
    }

    Node textures() {
        for (const Image& image : images_) {
            if (!image.target) continue;
            const IsfPass& pass = *image.target;
            const bool is_float = std::ranges::any_of(file_.passes, [&](const IsfPass& other) {
                return other.target == pass.target && other.is_float;
            });
            // Hosts have targets of 8 bits, which would cut light.
            const char* const format = is_float ? "rgba32f" : is_linear() ? "rgba16f" : "rgba8";
            Node texture = object_node(pass.place, {{"format", text(format)}});
            if (has_size(pass))
                add_member(texture, "size",
                           list_node(pass.place, {text(formula(pass, 0)), text(formula(pass, 1))}));
            if (keeps(image)) add_member(texture, "history", bool_node(pass.place, true));
            add_member(
                texture, "doc",
                text("The target " + image.isf_name + (pass.doc.empty() ? "." : ": " + pass.doc + ".")));
            textures_.members.push_back({image.name, pass.place, std::move(texture)});
        }
        return std::move(textures_);
    }

    static bool is_whole(const IsfPass& pass, int axis) {
        const std::string side(trimmed(pass.side[axis]));
        return side.empty() || side == (axis == 0 ? "$WIDTH" : "$HEIGHT");
    }
    static bool has_size(const IsfPass& pass) { return !is_whole(pass, 0) || !is_whole(pass, 1); }
    std::string formula(const IsfPass& pass, int axis) const {
        if (is_whole(pass, axis)) return axis == 0 ? "width" : "height";
        return native_formula(pass.side[axis], names_.all());
    }

    /// What no shader names need not last.
    bool keeps(const Image& image) const {
        return words_.all.contains(image.isf_name) &&
               std::ranges::any_of(file_.passes, [&](const IsfPass& pass) {
                   return pass.target == image.isf_name && pass.is_persistent;
               });
    }

    // ---- passes ----

    void passes() {
        textures_ = object({});
        for (Image& image : images_)
            if (is_linear() && image.input && !image.is_file && image.role == output_) straighten(image);
        std::set<std::string> written;
        for (std::size_t i = 0; i < file_.passes.size(); ++i) {
            const IsfPass& pass = file_.passes[i];
            const bool is_last = i + 1 == file_.passes.size();
            // Nothing can read what a later pass draws over.
            if (pass.target.empty() && !is_last) continue;
            passes_.push_back(pass_of(pass, int(i), written));
            written.insert(pass.target);
        }
        if (const IsfPass& last = file_.passes.back(); !last.target.empty()) present(last);
        if (!needs_nothing_) return;
        textures_.members.push_back({nothing_, file_.place,
                                     object({{"format", text("rgba8")},
                                             {"size", list_node(file_.place, {number_node(file_.place, 1),
                                                                              number_node(file_.place, 1)})},
                                             {"doc", text("Stands for images that are not there.")}})});
        passes_.insert(passes_.begin(), object({{"name", text("nothing")},
                                                {"kind", text("clear")},
                                                {"writes", list_node(file_.place, {text(nothing_)})},
                                                {"value", number_node(file_.place, 0)}}));
    }

    /// The image without its premultiplication, under the image's name for the shader.
    void straighten(Image& image) {
        const std::string straight = names_.make("straight_" + image.name);
        textures_.members.push_back(
            {straight, file_.place,
             object({{"format", text("rgba32f")}, {"doc", text(image.isf_name + " with straight alpha.")}})});
        effect_.shaders[id_ + "_straight.frag"] =
            "#version 450 core\n#include <pass>\n#include <isf/straight.glsl>\n";
        passes_.push_back(object({{"name", text(straight)},
                                  {"shader", text(id_ + "_straight.frag")},
                                  {"reads", list_node(file_.place, {read(image.name, "pixel")})},
                                  {"writes", list_node(file_.place, {text(straight)})},
                                  {"defines", object({{"ISF_IMAGE_0", text(image.name)},
                                                      {"ISF_OUT", text("out_" + straight)}})}}));
        straight_[image.name] = straight;
    }

    Node read(const std::string& name, const char* filter) const { return object({{name, text(filter)}}); }

    Node pass_of(const IsfPass& pass, int index, const std::set<std::string>& written) {
        std::vector<Node> reads;
        Node defines = object({{"ISF_PASS", text(std::to_string(index))}});
        bool lacks_any = false;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const Image& image = images_[i];
            if (image.is_file || image.is_optional) lacks_any = true;
            if (image.is_file || (image.target && !words_.all.contains(image.isf_name))) continue;
            std::string name = image.name;
            if (const auto straight = straight_.find(name); straight != straight_.end())
                name = straight->second;
            if (image.target && !written.contains(image.isf_name)) {
                lacks_any |= !keeps(image);
                if (!keeps(image)) continue;
                name += ".prev";
            }
            const bool is_exact = image.is_optional && !find_role(image.role)->filterable;
            reads.push_back(is_exact ? text(name) : read(name, "linear"));
            add_member(defines, "ISF_IMAGE_" + std::to_string(i),
                       text(name.ends_with(".prev") ? image.name + "_prev" : name));
        }
        if (lacks_any) {
            needs_nothing_ = true;
            reads.push_back(text(nothing_));
            add_member(defines, "ISF_NOTHING", text(nothing_));
        }
        const auto is_sized = [&](const IsfPass& other) { return has_size(other); };
        if (!lacks_any && std::ranges::none_of(file_.passes, is_sized))
            add_member(defines, "ISF_ALIKE", text("1"));
        const std::string target = pass.target.empty() ? output_ : names_.of(pass.target);
        add_output(defines, target, pass.target.empty(), !pass.target.empty() && has_size(pass));
        if (std::ranges::any_of(file_.passes, &IsfPass::is_persistent))
            add_member(defines, "ISF_HISTORY", text("1"));
        Node node = object_node(pass.place, {{"name", text("pass_" + std::to_string(index))},
                                             {"shader", text(id_ + ".frag")},
                                             {"reads", list_node(pass.place, std::move(reads))},
                                             {"writes", list_node(pass.place, {text(target)})},
                                             {"defines", std::move(defines)}});
        if (!has_vertex()) return node;
        add_member(node, "vertex", text(id_ + ".vert"));
        add_member(node, "instances",
                   object({{"of", text("quads")},
                           {"count", number_node(pass.place, 1)},
                           {"covers", bool_node(pass.place, true)}}));
        return node;
    }

    void add_output(Node& defines, const std::string& target, bool is_picture, bool has_size) const {
        add_member(defines, "ISF_OUT", text("out_" + target));
        add_member(defines, "ISF_SIZE", text(has_size ? "out_" + target + "_size.xy" : "vec2(frame.size)"));
        add_member(defines, "ISF_RESULT",
                   text(!is_picture   ? "isf_target"
                        : is_linear() ? "isf_linear"
                                      : "isf_display"));
    }

    void present(const IsfPass& last) {
        effect_.shaders[id_ + "_present.frag"] =
            "#version 450 core\n#include <pass>\n#include <isf/present.glsl>\n";
        Node defines = object({{"ISF_IMAGE_0", text(names_.of(last.target))}});
        add_output(defines, output_, true, false);
        passes_.push_back(object({{"name", text("present")},
                                  {"shader", text(id_ + "_present.frag")},
                                  {"reads", list_node(file_.place, {read(names_.of(last.target), "linear")})},
                                  {"writes", list_node(file_.place, {text(output_)})},
                                  {"defines", std::move(defines)}}));
    }

    // ---- shaders ----

    /// A name of the file's that would meet a word of GLSL 4.50 or of the host.
    std::string own_name(const std::string& word) const {
        return kBlocks.contains(word) || kNewWords.contains(word) ? "isf_own_" + word : word;
    }

    std::string shader(const std::string& stage, const std::string& file_name) const {
        std::string text = "#version 450 core\n#include <pass>\n#include <isf/" + stage + ".glsl>\n";
        for (const IsfInput& input : file_.inputs)
            text += global_of_input(file_, input, names_.of(input.name), own_name(input.name));
        text += "#include <isf/" + stage + "_names.glsl>\n";
        for (std::size_t i = 0; i < images_.size(); ++i) text += image_names(images_[i], i);
        for (const std::string& word : words_.all)
            if (own_name(word) != word && !words_.macros.contains(word) && !is_image(word))
                text += "#define " + word + " " + own_name(word) + "\n";
        for (const std::string& word : words_.macros) text += "#undef " + word + "\n";
        for (const std::string& word : symbols()) text += "#undef " + word + "\n";
        return text + "#include \"" + file_name + "\"\n#include <isf/" + stage + "_main.glsl>\n";
    }

    bool is_image(const std::string& word) const {
        return std::ranges::any_of(images_, [&](const Image& image) { return image.isf_name == word; });
    }

    std::string image_names(const Image& image, std::size_t index) const {
        const std::string number = "ISF_IMAGE_" + std::to_string(index), &name = image.isf_name;
        const std::string there =
            image.is_file       ? "defined(HAS_" + upper_case(image.name) + ")"
            : image.is_optional ? "defined(" + number + ") && defined(HAS_" + upper_case(image.name) + ")"
                                : "defined(" + number + ")";
        std::string text = "#if " + there + "\n#define " + name + " " +
                           (image.is_file ? image.name : number) + "\n#else\n#define " + name +
                           " ISF_NOTHING\n#endif\n";
        // What hosts make of IMG_... some files have themselves.
        for (const auto& [suffix, meaning] : {std::pair("_imgRect", "vec4(0.0, 0.0, 1.0, 1.0)"),
                                              {"_imgSize", "isf_size("},
                                              {"_flip", "false"}})
            if (const std::string word = "_" + name + suffix; words_.all.contains(word))
                text += "#define " + word + " " + meaning +
                        (std::string_view(meaning).ends_with('(') ? name + ")" : "") + "\n";
        return text;
    }

    /// Preprocessor symbols of enums that are words of the file.
    std::vector<std::string> symbols() const {
        std::vector<std::string> symbols;
        for (const IsfInput& input : file_.inputs)
            for (const std::string& label : names_of_labels(input.labels))
                if (const std::string symbol = upper_case(names_.of(input.name)) + "_" + upper_case(label);
                    words_.all.contains(symbol))
                    symbols.push_back(symbol);
        return symbols;
    }

    const IsfFile& file_;
    const std::string id_;
    const IsfSpace space_;
    const IsfWords words_;
    IsfNames names_;
    std::string output_, nothing_;
    std::vector<Image> images_;
    std::map<std::string, std::string> straight_;  // by image
    std::vector<Node> passes_;
    Node textures_;
    bool needs_nothing_ = false;
    IsfEffect effect_;
};

}  // namespace

IsfEffect effect_of_isf(const IsfFile& file, const std::string& id, IsfSpace space) {
    return EffectMaker(file, id, space).make();
}

std::optional<EffectManifest> read_isf_manifest(const fs::path& path, IsfSpace space,
                                                const fs::path& glsl_folder, Diagnostics& diagnostics) {
    const auto file = read_isf(path, diagnostics);
    if (!file) return std::nullopt;
    IsfEffect effect = effect_of_isf(*file, snake_case(path.stem().string()), space);
    return parse_manifest(effect.manifest, path.parent_path(), diagnostics, glsl_folder,
                          ForeignEffect{path, std::move(effect.shaders)});
}

}  // namespace aftershade
