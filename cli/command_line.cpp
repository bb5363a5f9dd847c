#include "cli/command_line.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

/// What the program reads from its environment.
constexpr std::array<std::string_view, 9> kVariables{
    "AFTERSHADE_ALLOW_PATH",  "AFTERSHADE_BACKEND",   "AFTERSHADE_CACHE",
    "AFTERSHADE_DATA",        "AFTERSHADE_DEVICE",    "AFTERSHADE_DRAW_WITH",
    "AFTERSHADE_PLUGIN_PATH", "AFTERSHADE_TRANSFERS", "OCIO"};

/// Words that a zero ends.
std::vector<std::string> words_of(const char* file) {
    const std::string text = read_text_file(file, ErrorKind::effect);
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\0', at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

}  // namespace

std::vector<std::string> own_arguments() {
    return words_of("/proc/self/cmdline");
}

std::vector<std::string> with_options(const std::vector<std::string>& words,
                                      const std::vector<OptionValue>& options) {
    constexpr std::size_t kBegin = 2;  // the program and its verb
    std::vector<std::string> result(words.begin(),
                                    words.begin() + std::ptrdiff_t(std::min(kBegin, words.size())));
    for (const auto& [name, value] : options)
        if (!value.empty()) result.insert(result.end(), {name, value});
    for (std::size_t i = kBegin; i < words.size(); ++i) {
        if (words[i] == "--") {  // what follows are names
            result.insert(result.end(), words.begin() + std::ptrdiff_t(i), words.end());
            break;
        }
        const auto is_word = [&](const OptionValue& option) { return words[i] == option.name; };
        const auto has_value = [&](const OptionValue& option) {
            return words[i].starts_with(option.name + "=");
        };
        if (std::ranges::any_of(options, has_value)) continue;
        if (std::ranges::any_of(options, is_word)) ++i;  // its value goes, too
        else result.push_back(words[i]);
    }
    // A worker knows the program by its entry in /proc alone.
    std::error_code failure;
    if (!result.empty() && result[0] == "/proc/self/exe")
        result[0] = std::filesystem::read_symlink(result[0], failure).string();
    return result;
}

std::map<std::string, std::string> own_variables() {
    std::map<std::string, std::string> variables;
    for (const std::string& entry : words_of("/proc/self/environ"))
        for (const std::string_view name : kVariables)
            if (const std::size_t end = name.size(); entry.starts_with(name) && entry[end] == '=')
                variables[std::string(name)] = entry.substr(end + 1);
    return variables;
}

std::string command_to_repeat(const std::vector<OptionValue>& options) {
    std::error_code failure;
    const std::filesystem::path folder = std::filesystem::current_path(failure);
    std::string text = failure ? "" : printed_command({"cd", folder.string()}) + " && ";
    for (const auto& [name, value] : own_variables()) text += name + "=" + printed_command({value}) + " ";
    return text + printed_command(with_options(own_arguments(), options));
}

}  // namespace aftershade::cli
