#include "framework/effect/isf/isf_names.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "framework/base/text.h"
#include "framework/effect/glsl_tokens.h"
#include "framework/effect/manifest/manifest_check.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

/// In GLSL: what a read or a target of the name takes beside it.
std::vector<std::string> relatives(const std::string& name) {
    return {name,          name + "_size",         name + "_prev", name + "_prev_size",
            "out_" + name, "out_" + name + "_size"};
}

}  // namespace

IsfWords::IsfWords(const IsfFile& file) {
    for (const std::string& text : {file.text, file.vertex_text}) {
        ShaderSource source{text, {}};
        source.lines.resize(std::size_t(std::ranges::count(text, '\n')) + 1, {"", 1});
        const std::vector<Token> tokens = glsl_tokens(source);
        for (std::size_t i = 0; i < tokens.size(); ++i) {
            if (!tokens[i].is_word()) continue;
            all.emplace(tokens[i].text);
            if (i >= 2 && tokens[i - 1].text == "define" && tokens[i - 2].text == "#")
                macros.emplace(tokens[i].text);
        }
    }
}

bool IsfWords::has_image(const std::string& name) const {
    return all.contains(name) || std::ranges::any_of(kImageWords, [&](const char* suffix) {
               return all.contains("_" + name + suffix);
           });
}

bool IsfWords::has_derivative() const {
    return std::ranges::any_of(
        all, [](const std::string& word) { return word.starts_with("dFd") || word.starts_with("fwidth"); });
}

IsfNames::IsfNames(const IsfFile& file, const IsfWords& words) : words_(words) {
    for (const std::string_view output : {kDisplayRole, kColorRole})
        for (const std::string& name : relatives(std::string(output))) taken_.insert(name);
    for (const IsfInput& input : file.inputs) {
        const bool is_global = input.type == IsfInput::Type::image || input.type == IsfInput::Type::audio;
        names_[input.name] = unique(snake_case(input.name), is_global, input.name);
    }
    for (const IsfImport& import : file.imports)
        names_[import.name] = unique(snake_case(import.label), true, import.name);
    for (const IsfPass& pass : file.passes)
        if (!pass.target.empty() && !names_.contains(pass.target))
            names_[pass.target] = unique(snake_case(pass.target), true, pass.target);
}

std::string IsfNames::unique(const std::string& wanted, bool is_global, const std::string& isf_name) {
    const bool is_of_host = is_global && (wanted == "isf" || wanted.starts_with("isf_"));
    const std::string base = (is_of_host ? "own_" : "") + wanted;
    for (int number = 1;; ++number) {
        std::string name = number == 1 ? base : base + "_" + std::to_string(number);
        if (is_glsl_word(name) || (is_global && hides_glsl(name))) continue;
        // The file's own words must not meet a sampler of ours; its image may have the name itself.
        const auto is_free = [&](const std::string& other) {
            return !taken_.contains(other) &&
                   (!is_global || other == isf_name || !words_.all.contains(other));
        };
        const std::vector<std::string> all = relatives(name);
        if (is_global ? !std::ranges::all_of(all, is_free) : !is_free(name)) continue;
        if (is_global) taken_.insert(all.begin(), all.end());
        else taken_.insert(name);
        return name;
    }
}

std::vector<std::string> names_of_labels(const std::vector<std::string>& labels) {
    std::vector<std::string> names;
    std::map<std::string, int> next;  // number of each name
    std::set<std::string> taken;
    for (const std::string& label : labels) {
        std::string name;
        const auto is_plain = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) && static_cast<unsigned char>(c) < 128;
        };
        // Labels such as -1 and 1 are two names.
        if (label.size() > 1 && label[0] == '-' && is_plain(label[1])) name = "minus_";
        for (const char c : lower_case(label))
            if (is_plain(c)) name += c;
            else if (!name.empty() && name.back() != '_') name += '_';
        while (name.ends_with('_')) name.pop_back();
        if (name.empty()) name = "value";
        std::string unique = name;
        int& number = next.try_emplace(name, 2).first->second;
        while (taken.contains(unique)) unique = name + "_" + std::to_string(number++);
        taken.insert(unique);
        names.push_back(unique);
    }
    return names;
}

}  // namespace aftershade
