#include "framework/effect/image_loads.h"

#include <algorithm>
#include <functional>
#include <set>
#include <string>
#include <utility>

#include "framework/effect/sampler_uses.h"

namespace aftershade {

namespace {

/// Before the unit: no author's word.
constexpr std::string_view kLoaded = "aftershade_image_";

class Rewriter {
public:
    Rewriter(ShaderSource& source, const std::map<int, gpu::TextureFormat>& formats)
        : source_(source), formats_(formats), tokens_(all_glsl_tokens(source)), uses_(tokens_) {}

    std::vector<ImageLoad> rewrite(int first_unit, int units) {
        std::vector<ImageLoad> loads;
        if (renames_fetches()) return loads;
        for (const int variable : chosen(std::size_t(std::max(0, units - first_unit)))) {
            loads.push_back(
                {uses_.variables()[std::size_t(variable)].binding, first_unit + int(loads.size())});
            to_image(variable, loads.back().unit);
        }
        for (int i = 0; i < int(uses_.variables().size()); ++i)
            if (!uses_.variables()[std::size_t(i)].is_uniform() && is_whole(i)) parameter_to_image(i);
        apply();
        return loads;
    }

private:
    const SamplerVariable& variable(int index) const { return uses_.variables()[std::size_t(index)]; }

    /// Behind a macro of the name a fetch is another function's.
    bool renames_fetches() const {
        for (std::size_t i = 2; i < tokens_.size(); ++i)
            if (tokens_[i - 1].text == "define" && tokens_[i - 2].text == "#" &&
                (tokens_[i].text == "texelFetch" || tokens_[i].text == "textureSize"))
                return true;
        return false;
    }

    /// Of which nothing stays a sampler's: all that are linked become images, or none.
    bool is_whole(int index) const { return whole_.contains(uses_.set_of(index)); }

    /// Uniforms that become images, those with most fetches first.
    std::vector<int> chosen(std::size_t units) {
        std::map<int, std::vector<int>> by_set;
        std::map<int, std::size_t> fetches;
        for (int i = 0; i < int(uses_.variables().size()); ++i) {
            fetches[uses_.set_of(i)] += variable(i).fetches.size();
            if (variable(i).is_uniform()) by_set[uses_.set_of(i)].push_back(i);
        }
        std::vector<std::pair<std::size_t, std::vector<int>>> groups;
        for (const auto& [set, uniforms] : by_set) {
            const auto is_known = [&](int i) { return formats_.contains(variable(i).binding); };
            if (fetches[set] > 0 && uses_.is_only_fetched(set) && std::ranges::all_of(uniforms, is_known)) {
                groups.emplace_back(fetches[set], uniforms);
                continue;
            }
            for (const int i : uniforms)
                if (!variable(i).fetches.empty() && !variable(i).is_redefined && is_known(i))
                    groups.emplace_back(variable(i).fetches.size(), std::vector{i});
        }
        std::ranges::stable_sort(groups, std::greater(), &decltype(groups)::value_type::first);
        std::vector<int> all;
        for (const auto& [count, uniforms] : groups) {
            if (all.size() + uniforms.size() > units) continue;
            all.insert(all.end(), uniforms.begin(), uniforms.end());
            const int set = uses_.set_of(uniforms.front());
            if (uniforms.size() == by_set[set].size() && uses_.is_only_fetched(set)) whole_.insert(set);
        }
        return all;
    }

    void to_image(int index, int unit) {
        const SamplerVariable& sampler = variable(index);
        const std::string image = std::string(kLoaded) + std::to_string(unit);
        std::string declared = "; layout(binding = " + std::to_string(unit) + ", ";
        declared += gpu::texture_format_name(formats_.at(sampler.binding));
        replace(sampler.declared,
                declared + ") restrict readonly uniform " + image_type(sampler) + " " + image + ";");
        for (const LevelZeroCall& fetch : sampler.fetches) {
            replace(fetch.name, image);
            drop_level(fetch, "imageLoad");
        }
        if (!is_whole(index)) return;
        for (const LevelZeroCall& size : sampler.sizes) {
            replace(size.name, image);
            drop_level(size, "imageSize");
        }
        for (const std::size_t name : sampler.handed_on) replace(name, image);
    }

    void parameter_to_image(int index) {
        const SamplerVariable& parameter = variable(index);
        // A macro that stands for a sampler has no type.
        if (parameter.declared > 0) replace(parameter.declared, "restrict readonly " + image_type(parameter));
        for (const LevelZeroCall& fetch : parameter.fetches) drop_level(fetch, "imageLoad");
        for (const LevelZeroCall& size : parameter.sizes) drop_level(size, "imageSize");
    }

    static std::string image_type(const SamplerVariable& sampler) {
        return std::string(sampler.type.prefix) + "image" + std::string(sampler.type.shape);
    }

    void drop_level(const LevelZeroCall& call, std::string function) {
        replace(call.call, std::move(function));
        replace(call.comma, "");
        replace(call.level, "");
    }

    void replace(std::size_t token, std::string text) {
        const std::string_view old = tokens_[token].text;
        edits_.push_back({std::size_t(old.data() - source_.text.data()), old.size(), std::move(text)});
    }

    void apply() {
        if (edits_.empty()) return;
        std::ranges::sort(edits_, {}, &Edit::at);
        std::string text;
        text.reserve(source_.text.size() + edits_.size() * kLoaded.size());
        std::size_t at = 0;
        for (const Edit& edit : edits_) {
            text.append(source_.text, at, edit.at - at).append(edit.text);
            at = edit.at + edit.bytes;
        }
        source_.text = text.append(source_.text, at);
    }

    struct Edit {
        std::size_t at = 0, bytes = 0;
        std::string text;
    };

    ShaderSource& source_;
    const std::map<int, gpu::TextureFormat>& formats_;
    const std::vector<Token> tokens_;
    const SamplerUses uses_;
    std::set<int> whole_;  // sets
    std::vector<Edit> edits_;
};

}  // namespace

std::vector<ImageLoad> load_as_images(ShaderSource& source, const std::map<int, gpu::TextureFormat>& formats,
                                      int first_unit, int units) {
    return Rewriter(source, formats).rewrite(first_unit, units);
}

}  // namespace aftershade
