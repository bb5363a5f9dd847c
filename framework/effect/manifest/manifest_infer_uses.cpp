// Reads and writes of passes that leave them to their shaders' text.
#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "framework/base/data_path.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/manifest/manifest_check.h"
#include "framework/effect/manifest/manifest_expand.h"
#include "framework/effect/shader_source.h"
#include "framework/effect/shader_uses.h"

namespace aftershade {

namespace {

namespace fs = std::filesystem;

class UseInference {
public:
    UseInference(const EffectManifest& manifest, fs::path glsl_folder, Diagnostics& diagnostics)
        : manifest_(manifest), glsl_folder_(std::move(glsl_folder)), diagnostics_(diagnostics) {}

    void infer(PassSpec& pass) {
        // The author's own file: of a tile list, whose shader is the host's, the predicate.
        if (!fs::is_regular_file(pass.folder / pass.shader)) return;  // told later
        pass_ = &pass;
        const ShaderUses& main = uses_of(ShaderFile::main);
        if (pass.infers_reads) {
            add_reads(main);
            if (pass.vertex() && fs::is_regular_file(pass.folder / *pass.vertex()))
                add_reads(uses_of(ShaderFile::vertex));
            put_in_order(pass.reads, manifest_.inputs);
        }
        if (pass.infers_writes) {
            for (const OutputSpec& output : manifest_.outputs) add_write(main, output.name);
            for (const TextureSpec& texture : manifest_.textures) add_write(main, texture.name);
            put_in_order(pass.writes, manifest_.outputs);
        }
    }

private:
    /// Passes of one shader with different defines share its text. A tile list's shader includes its
    /// predicate.
    const ShaderUses& uses_of(ShaderFile file) {
        const std::pair path(shader_path(*pass_, file, glsl_folder_).string(),
                             (pass_->folder / pass_->shader).string());
        const auto found = uses_.find(path);
        if (found != uses_.end()) return found->second;
        ShaderUses uses(author_text(manifest_, *pass_, glsl_folder_, diagnostics_, file, &texts_));
        return uses_.emplace(path, std::move(uses)).first->second;
    }

    /// Where the text uses a name, by itself or as the value of one of the pass's defines.
    std::optional<Place> place_in(const ShaderUses::Uses& uses, const std::string& name) const {
        if (const auto found = uses.find(name); found != uses.end()) return found->second;
        for (const auto& [define, value] : pass_->defines)
            if (const auto found = uses.find(define); value == name && found != uses.end())
                return found->second;
        return std::nullopt;
    }

    void add_reads(const ShaderUses& uses) {
        tell_unknown(uses);
        for (const InputSpec& input : manifest_.inputs) add_read_and_previous(uses, input.name);
        for (const TextureSpec& texture : manifest_.textures) add_read_and_previous(uses, texture.name);
    }
    void add_read_and_previous(const ShaderUses& uses, const std::string& name) {
        add_read(uses, name, false);
        const std::string previous = name + "_prev";
        if (!manifest_.find_input(previous) && !manifest_.find_texture(previous)) add_read(uses, name, true);
    }
    void add_read(const ShaderUses& uses, const std::string& name, bool previous) {
        ReadSpec read;
        read.name = name;
        read.previous = previous;
        const auto fetched = place_in(uses.samplers, read.glsl_name());
        const auto place = fetched ? fetched : size_in(uses, read.glsl_name());
        const auto same = [&](const ReadSpec& other) { return other.glsl_name() == read.glsl_name(); };
        if (!place || std::any_of(pass_->reads.begin(), pass_->reads.end(), same)) return;
        read.place = *place;
        pass_->reads.push_back(std::move(read));
    }
    /// What a texture function takes must be there, or be something else that shaders have.
    void tell_unknown(const ShaderUses& uses) {
        std::vector<std::string> known;
        for (const InputSpec& input : manifest_.inputs) known.push_back(input.name);
        for (const TextureSpec& texture : manifest_.textures) known.push_back(texture.name);
        for (const auto& [word, place] : uses.plain_samplers) {
            const auto define = pass_->defines.find(word);
            const std::string& name = define == pass_->defines.end() ? word : define->second;
            const std::string base = name.ends_with("_prev") ? name.substr(0, name.size() - 5) : name;
            const auto is_named = [&](const std::string& other) { return other == name || other == base; };
            if (std::any_of(known.begin(), known.end(), is_named) || uses.own.contains(name) ||
                is_of_param(name) || is_native_table(name))
                continue;
            const std::string text = label_of(manifest_, *pass_) + ": its shader reads '" + name +
                                     "', which is neither an input nor a texture" + did_you_mean(name, known);
            if (told_.insert(to_string(place) + text).second) diagnostics_.error(place, text);
        }
    }

    /// A curve, a file or a table has samplers of its own name, or that begin with it.
    bool is_of_param(const std::string& name) const {
        return std::any_of(manifest_.params.begin(), manifest_.params.end(), [&](const ParamSpec& param) {
            return !is_block_type(param.type) && (name == param.name || name.starts_with(param.name + "_"));
        });
    }

    bool is_native_table(const std::string& name) const {
        if (!manifest_.native) return false;
        const std::vector<NativeTableSpec>& tables = manifest_.native->tables;
        const auto is_it = [&](const NativeTableSpec& table) { return table.name == name; };
        return std::any_of(tables.begin(), tables.end(), is_it);
    }

    /// A define's value may also be the whole word: "SIZE": "near_size".
    std::optional<Place> size_in(const ShaderUses& uses, const std::string& name) const {
        if (const auto found = uses.sizes.find(name); found != uses.sizes.end()) return found->second;
        for (const auto& [define, value] : pass_->defines)
            if (value == name + "_size" && uses.words.contains(define)) return pass_->place;
        return std::nullopt;
    }

    /// Images of the effect in the order of their declarations, then textures in theirs.
    template <typename Use, typename Image>
    void put_in_order(std::vector<Use>& uses, const std::vector<Image>& images) const {
        const auto place_of = [](const auto& list, const std::string& name) {
            const auto is_it = [&](const auto& item) { return item.name == name; };
            return std::find_if(list.begin(), list.end(), is_it) - list.begin();
        };
        const auto rank = [&](const Use& use) {
            const auto image = place_of(images, use.name);
            return image < std::ssize(images) ? image : image + place_of(manifest_.textures, use.name);
        };
        std::stable_sort(uses.begin(), uses.end(),
                         [&](const Use& a, const Use& b) { return rank(a) < rank(b); });
    }

    void add_write(const ShaderUses& uses, const std::string& name) {
        const auto same = [&](const WriteSpec& other) { return other.name == name; };
        if (std::any_of(pass_->writes.begin(), pass_->writes.end(), same)) return;
        const std::string word = std::string(kOut) + name;
        std::optional<Place> place;
        if (const auto found = uses.outputs.find(name); found != uses.outputs.end()) place = found->second;
        for (const auto& [define, value] : pass_->defines)
            if (!place && value == word && uses.words.contains(define)) place = pass_->place;
        if (!place) return;
        WriteSpec write;
        write.name = name;
        write.place = *place;
        pass_->writes.push_back(std::move(write));
    }

    const EffectManifest& manifest_;
    const fs::path glsl_folder_;
    Diagnostics& diagnostics_;
    ShaderTexts texts_;
    std::map<std::pair<std::string, std::string>, ShaderUses> uses_;
    PassSpec* pass_ = nullptr;  // whose uses are inferred
    std::set<std::string> told_;
};

}  // namespace

bool is_pointwise(const EffectManifest& manifest) {
    return std::ranges::all_of(manifest.passes, [](const PassSpec& pass) {
        return pass.fills_screen() && pass.images.empty() && pass.buffers.empty() &&
               std::ranges::all_of(pass.reads, &ReadSpec::is_pixel);
    });
}

bool counts_from_part(const EffectManifest& manifest, const fs::path& glsl_folder) {
    const fs::path shared = glsl_folder.empty() ? data_path() / "glsl" : glsl_folder;
    ShaderTexts texts;
    return std::ranges::any_of(manifest.passes, [&](const PassSpec& pass) {
        Diagnostics told_later;
        if (!pass.draw()) return false;
        const ShaderSource text = author_text(manifest, pass, shared, told_later, ShaderFile::main, &texts);
        const std::vector<Token> tokens = glsl_tokens(text);
        bool has_place = false, has_origin = false, has_size = false;
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            has_place |= tokens[i].text == "gl_FragCoord";
            const bool is_of_frame = i > 1 && tokens[i - 1].text == "." && tokens[i - 2].text == "frame";
            has_origin |= is_of_frame && tokens[i].text == "origin";
            has_size |= is_of_frame && tokens[i].text == "size";
        }
        return has_size || (has_place && !has_origin);
    });
}

bool infer_uses(EffectManifest& manifest, const fs::path& glsl_folder, Diagnostics& diagnostics) {
    const auto infers = [](const PassSpec& pass) { return pass.infers_reads || pass.infers_writes; };
    if (std::none_of(manifest.passes.begin(), manifest.passes.end(), infers)) return true;
    const int errors_before = diagnostics.error_count();
    UseInference inference(manifest, glsl_folder.empty() ? data_path() / "glsl" : glsl_folder, diagnostics);
    for (PassSpec& pass : manifest.passes)
        if (infers(pass)) inference.infer(pass);
    return diagnostics.error_count() == errors_before;
}

}  // namespace aftershade
