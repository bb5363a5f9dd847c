#include "framework/capture/channel_names.h"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "framework/base/diagnostics.h"
#include "framework/base/text.h"
#include "framework/image/role.h"

namespace aftershade {

std::string canonical_name(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kInFull = {
        {{"red", "r"}, {"green", "g"}, {"blue", "b"}, {"alpha", "a"}}};
    std::string canonical = lower_case(name);
    for (char& c : canonical)
        if (c == '_' || c == '-' || c == ' ') c = '.';
    canonical.erase(0, std::min(canonical.find_first_not_of('.'), canonical.size()));
    const std::size_t begin = canonical.rfind('.') + 1;
    for (const auto& [word, letter] : kInFull)
        if (canonical.substr(begin) == word) return canonical.substr(0, begin) + std::string(letter);
    return canonical;
}

ChannelName split_channel_name(const std::string& name) {
    if (const std::size_t dot = name.rfind('.'); dot != std::string::npos)
        return {name.substr(0, dot), canonical_name(name.substr(dot + 1))};
    constexpr std::string_view kColor = "rgba";
    const std::size_t mark = name.find_last_of("_ ");
    const std::string component = mark == std::string::npos ? "" : canonical_name(name.substr(mark + 1));
    const bool is_of_color = component.size() == 1 && kColor.find(component) != std::string_view::npos;
    if (mark > 0 && is_of_color) return {name.substr(0, mark), component};
    return {"", canonical_name(name)};
}

std::string channel_list(const ExrPart& part) {
    constexpr std::size_t kMost = 16;
    std::vector<std::string> names;
    for (const ExrChannel& channel : part.channels) names.push_back(channel.name);
    if (names.size() <= kMost) return list_of_names(names, "and");
    std::string text;
    for (std::size_t i = 0; i < kMost; ++i) text += (i == 0 ? "'" : ", '") + names[i] + "'";
    return text + " and " + std::to_string(names.size() - kMost) + " more";
}

std::vector<std::string> channels_of_motion(const std::vector<std::string>& channels) {
    constexpr std::array kWords = {"velocity", "motion", "mvec", "vector", "forward", "backward"};
    std::vector<std::string> found;
    for (const std::string& channel : channels) {
        const std::string name = canonical_name(channel);
        const bool is_motion = std::ranges::any_of(
            kWords, [&](const char* word) { return name.find(word) != std::string::npos; });
        if (is_motion) found.push_back(channel);
    }
    return found;
}

std::string role_in_file_name(std::string_view stem) {
    static const std::map<std::string, RoleKind, std::less<>> kOtherWords = {{"zdepth", RoleKind::distance},
                                                                             {"z", RoleKind::distance},
                                                                             {"motion", RoleKind::motion},
                                                                             {"vector", RoleKind::motion},
                                                                             {"vectors", RoleKind::motion}};
    const std::string name = canonical_name(stem);
    std::string word;
    for (const std::string_view part : split(name, '.'))
        if (!part.empty() && part.find_first_not_of("0123456789") != std::string_view::npos) word = part;
    const auto other = kOtherWords.find(word);
    for (const ChannelRole& role : channel_roles()) {
        const bool is_data = role.kind == RoleKind::distance || role.kind == RoleKind::motion ||
                             role.kind == RoleKind::direction || role.kind == RoleKind::place;
        const bool is_other = other != kOtherWords.end() && other->second == role.kind;
        if (is_data && (is_other || word == role.name || word == role.name + "s")) return role.name;
    }
    return "";
}

}  // namespace aftershade
