#include "framework/effect/isf/isf_effect.h"

#include <algorithm>
#include <utility>

#include "framework/base/text.h"
#include "framework/effect/isf/isf_file.h"
#include "framework/effect/isf/isf_formula.h"
#include "framework/effect/isf/isf_nodes.h"
#include "framework/effect/isf/isf_params.h"
#include "framework/effect/isf/isf_shaders.h"
#include "framework/effect/isf/isf_text.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "framework/image/role.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

using Type = IsfInput::Type;

class EffectMaker {
public:
    EffectMaker(const IsfFile& file, std::string id, IsfSpace space)
        : file_(file), id_(std::move(id)), space_(space), words_(file), texts_(file), names_(file, words_) {
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
        // RENDERSIZE and places in the picture are those of all of it, and hosts know no other pixels.
        add_member(manifest, "reach", text("all"));
        add_member(manifest, "window", text("display"));
        add_member(manifest, "inputs", inputs());
        add_member(manifest, "outputs",
                   object_node(file_.place, {{output_, object({{"role", text(output_)}})}}));
        add_member(manifest, "params", params());
        add_member(manifest, "textures", textures());
        add_member(manifest, "passes", list_node(file_.place, std::move(passes_)));
        const IsfShaders shaders{file_, words_, texts_, names_, images_};
        author_text(file_.path.filename().string(), file_.written_text, texts_.fragment());
        effect_.shaders[id_ + ".frag"] = shaders.text("fragment", file_.path.filename().string());
        if (has_vertex()) {
            author_text(file_.vertex_file, file_.written_vertex_text, texts_.vertex());
            effect_.shaders[id_ + ".vert"] = shaders.text("vertex", file_.vertex_file);
        } else if (is_sparse_) {
            effect_.shaders[id_ + ".vert"] =
                "#version 450 core\n#include <pass>\n#include <isf/vertex.glsl>\n"
                "void isf_main() {}\n#include <isf/vertex_main.glsl>\n";
        }
        return std::move(effect_);
    }

private:
    using Image = IsfImage;

    Node text(std::string value) const { return text_node(file_.place, std::move(value)); }
    Node object(std::vector<std::pair<std::string, Node>> members) const {
        return object_node(file_.place, std::move(members));
    }
    std::string stem() const { return file_.path.stem().string(); }
    bool has_vertex() const { return !file_.vertex_file.empty(); }
    /// Whether its passes draw a quad. A draw without one must write every pixel.
    bool is_instanced() const { return has_vertex() || is_sparse_; }
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
            image.has_one_name = !is_linear();
            if (words_.has_image(name)) images_.push_back(std::move(image));
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
            if (input.type != Type::image && (input.type != Type::audio || words_.has_image(input.name)))
                add_member(params, names_.of(input.name), param_of_input(file_, input));
        for (const IsfImport& import : file_.imports)
            add_member(params, names_.of(import.name), param_of_import(import));
        return params;
    }

    Node textures() {
        for (const Image& image : images_) {
            if (!image.target) continue;
            const IsfPass& pass = *image.target;
            Node texture = texture_of(pass);
            if (keeps(pass.target)) add_member(texture, "history", bool_node(pass.place, true));
            add_member(
                texture, "doc",
                text("The target " + image.isf_name + (pass.doc.empty() ? "." : ": " + pass.doc + ".")));
            textures_.members.push_back({image.name, pass.place, std::move(texture)});
        }
        return std::move(textures_);
    }

    Node texture_of(const IsfPass& pass) const {
        const bool is_float = std::ranges::any_of(file_.passes, [&](const IsfPass& other) {
            return other.target == pass.target && other.is_float;
        });
        // Hosts have targets of 8 bits, which would cut light.
        const char* const format = is_float ? "rgba32f" : is_linear() ? "rgba16f" : "rgba8";
        Node texture = object_node(pass.place, {{"format", text(format)}});
        if (has_size(pass))
            add_member(texture, "size",
                       list_node(pass.place, {text(formula(pass, 0)), text(formula(pass, 1))}));
        return texture;
    }

    /// The texture that the pass draws into. If several passes draw into one persistent target, only the last
    /// one's picture lasts; an earlier one draws into a texture of its own, which the passes between them
    /// read.
    std::string texture_name(std::size_t index) {
        const IsfPass& pass = file_.passes[index];
        if (pass.target.empty()) return output_;
        const auto is_same = [&](const IsfPass& other) { return other.target == pass.target; };
        const bool is_last =
            std::none_of(file_.passes.begin() + std::ptrdiff_t(index) + 1, file_.passes.end(), is_same);
        const std::string& name = names_.of(pass.target);
        if (is_last || !keeps(pass.target)) return name;
        const std::string between = names_.make(name + "_" + std::to_string(index));
        Node texture = texture_of(pass);
        add_member(texture, "doc",
                   text("The target " + pass.target + " after pass " + std::to_string(index) + "."));
        textures_.members.push_back({between, pass.place, std::move(texture)});
        return between;
    }

    static bool is_whole(const IsfPass& pass, int axis) {
        const std::string side(trimmed(pass.side[axis]));
        return side.empty() || side == (axis == 0 ? "$WIDTH" : "$HEIGHT");
    }
    static bool has_size(const IsfPass& pass) { return !is_whole(pass, 0) || !is_whole(pass, 1); }
    /// The last pass draws the picture, whose size no pass decides.
    static bool has_own_size(const IsfPass& pass) { return !pass.target.empty() && has_size(pass); }
    /// Whether the image has the size of what the pass draws into, so that its pixel lies on a texel.
    static bool is_alike(const IsfPass& pass, const Image& image) {
        if (!image.target || !has_size(*image.target)) return !has_own_size(pass);
        return has_own_size(pass) && std::ranges::equal(pass.side, image.target->side);
    }
    std::string formula(const IsfPass& pass, int axis) const {
        if (is_whole(pass, axis)) return axis == 0 ? "width" : "height";
        return native_formula(pass.side[axis], names_.all());
    }

    /// What no shader names need not last.
    bool keeps(const std::string& target) const {
        return words_.has_image(target) && std::ranges::any_of(file_.passes, [&](const IsfPass& pass) {
                   return pass.target == target && pass.is_persistent;
               });
    }

    // ---- passes ----

    void passes() {
        textures_ = object({});
        for (Image& image : images_)
            if (is_linear() && image.input && !image.is_file && image.role == output_) straighten(image);
        std::map<std::string, std::string> written;
        for (std::size_t i = 0; i < file_.passes.size(); ++i) {
            const IsfPass& pass = file_.passes[i];
            const bool is_last = i + 1 == file_.passes.size();
            // Nothing can read what a later pass draws over.
            if (pass.target.empty() && !is_last) continue;
            const std::string texture = texture_name(i);
            if (is_sparse_)
                passes_.push_back(object({{"name", text("clear_" + std::to_string(i))},
                                          {"kind", text("clear")},
                                          {"writes", list_node(pass.place, {text(texture)})},
                                          {"value", number_node(pass.place, 0)}}));
            passes_.push_back(pass_of(pass, int(i), texture, written));
            written[pass.target] = texture;
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

    /// `written`: textures by the targets that earlier passes of the frame have drawn.
    Node pass_of(const IsfPass& pass, int index, const std::string& target,
                 const std::map<std::string, std::string>& written) {
        std::vector<Node> reads;
        Node defines = object({{"ISF_PASS", text(std::to_string(index))}});
        bool lacks_any = false;
        for (std::size_t i = 0; i < images_.size(); ++i) {
            const Image& image = images_[i];
            if (image.is_file || image.is_optional) lacks_any = true;
            if (image.is_file || (image.target && !words_.has_image(image.isf_name))) continue;
            std::string name = image.name;
            if (const auto straight = straight_.find(name); straight != straight_.end())
                name = straight->second;
            if (const auto drawn = written.find(image.isf_name); image.target && drawn != written.end())
                name = drawn->second;
            else if (image.target) {
                lacks_any |= !keeps(image.isf_name);
                if (!keeps(image.isf_name)) continue;
                name += ".prev";
            }
            const bool is_exact = image.is_optional && !find_role(image.role)->filterable;
            const bool is_pixel = is_alike(pass, image) && !has_own_size(pass) && !is_instanced() &&
                                  !words_.has_derivative() && texts_.is_read_by_pixel(image.isf_name);
            reads.push_back(is_exact && !is_pixel ? text(name) : read(name, is_pixel ? "pixel" : "linear"));
            const std::string sampler = name.ends_with(".prev") ? image.name + "_prev" : name;
            add_member(defines, "ISF_IMAGE_" + std::to_string(i), text(sampler));
            if (!texts_.name_here(image.isf_name).empty() && is_alike(pass, image) && !texts_.moves_corners())
                add_member(defines, "ISF_HERE_" + std::to_string(i), text("1"));
        }
        if (lacks_any) {
            needs_nothing_ = true;
            reads.push_back(text(nothing_));
            add_member(defines, "ISF_NOTHING", text(nothing_));
        }
        add_output(defines, target, pass.target.empty(), has_own_size(pass));
        if (std::ranges::any_of(file_.passes, &IsfPass::is_persistent))
            add_member(defines, "ISF_HISTORY", text("1"));
        Node node = object_node(pass.place, {{"name", text("pass_" + std::to_string(index))},
                                             {"shader", text(id_ + ".frag")},
                                             {"reads", list_node(pass.place, std::move(reads))},
                                             {"writes", list_node(pass.place, {text(target)})},
                                             {"defines", std::move(defines)}});
        if (!is_instanced()) return node;
        add_member(node, "vertex", text(id_ + ".vert"));
        add_member(node, "instances",
                   object({{"of", text("quads")},
                           {"count", number_node(pass.place, 1)},
                           {"covers", bool_node(pass.place, !is_sparse_)}}));
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

    /// A file that needs no other words is read where it lies.
    void author_text(const std::string& name, const std::string& written, std::string text) {
        if (text != written) effect_.shaders[name] = std::move(text);
    }

    const IsfFile& file_;
    const std::string id_;
    const IsfSpace space_;
    const IsfWords words_;
    const IsfTexts texts_;
    const bool is_sparse_ = texts_.moves_corners() || texts_.discards();  // pixels that are not drawn are 0
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
