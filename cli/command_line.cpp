#include "cli/command_line.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <system_error>

#include "framework/core/atomic_file.h"
#include "framework/core/error.h"

namespace aftershade::cli {

std::vector<std::string> own_arguments() {
    const std::string text = read_text_file("/proc/self/cmdline", ExitCode::effect);
    std::vector<std::string> words;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\0', at), text.size());
        words.push_back(text.substr(at, end - at));
        at = end + 1;
    }
    return words;
}

std::vector<std::string> with_options(const std::vector<std::string>& words,
                                      const std::vector<OptionValue>& options) {
    constexpr std::size_t kBegin = 2;  // the program and its verb
    std::vector<std::string> result(words.begin(),
                                    words.begin() + std::ptrdiff_t(std::min(kBegin, words.size())));
    for (const auto& [name, value] : options)
        if (!value.empty()) result.insert(result.end(), {name, value});
    for (std::size_t i = kBegin; i < words.size(); ++i) {
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

}  // namespace aftershade::cli
