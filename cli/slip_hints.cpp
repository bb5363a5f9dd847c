#include "cli/slip_hints.h"

#include <algorithm>
#include <cstddef>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

bool is_file_name(const std::string& word) {
    return word.ends_with(".exr") || word.ends_with(".png") || word.ends_with(".json");
}

std::vector<std::string> pictures_of(const std::vector<std::string>& words) {
    std::vector<std::string> pictures;
    for (std::size_t i = 1; i < words.size(); ++i)
        if (words[i].ends_with(".exr") && words[i - 1] != "-o" && !words[i].starts_with("-"))
            pictures.push_back(words[i]);
    return pictures;
}

}  // namespace

std::string frame_pattern(const std::string& name) {
    constexpr const char* kDigits = "0123456789";
    constexpr const char* kFourDigits = "####";
    if (const std::size_t star = name.rfind('*'); star != std::string::npos)
        return name.substr(0, star) + kFourDigits + name.substr(star + 1);
    const std::size_t dot = name.rfind('.'), last = name.find_last_of(kDigits, dot);
    const std::size_t slash = name.rfind('/');
    if (last == std::string::npos || (slash != std::string::npos && last < slash)) return "";
    const std::size_t before = name.find_last_not_of(kDigits, last);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    return name.substr(0, first) + std::string(last + 1 - first, '#') + name.substr(last + 1);
}

std::string slip_hint(const std::vector<std::string>& words, const std::vector<std::string>& verbs) {
    if (words.empty()) return "";
    const auto verb = std::ranges::find_first_of(words, verbs);
    if (verb != words.begin() && verb != words.end() && words.front().starts_with("-")) {
        const std::vector<std::string> before(words.begin(), verb), after(verb + 1, words.end());
        return "options come after the command: aftershade " + *verb + " " + printed_command(after) +
               (after.empty() ? "" : " ") + printed_command(before);
    }
    for (const std::string& word : words)
        if (word.starts_with("-") && !word.starts_with("--") && is_file_name(word))
            return "a file whose name begins with - is written with ./ before it: ./" + word;
    const std::vector<std::string> pictures = pictures_of(words);
    const bool takes_look = words.front() == "run" || words.front() == "serve";
    if ((takes_look || words.front() == "inspect") && pictures.size() > 1)
        if (const std::string pattern = frame_pattern(pictures.front()); !pattern.empty())
            return "a sequence is one pattern, in quotes, so that the shell does not expand it: '" + pattern +
                   "'";
    return "";
}

}  // namespace aftershade::cli
