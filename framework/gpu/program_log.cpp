#include "framework/gpu/program.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace aftershade::gpu {
namespace {

/// Reads a log line from its start; each take_* moves on only where it matches.
class Scanner {
public:
    explicit Scanner(std::string_view text) : rest_(text) {}

    bool take(std::string_view prefix) {
        if (!rest_.starts_with(prefix)) return false;
        rest_.remove_prefix(prefix.size());
        return true;
    }

    bool take_number(int& value) {
        const auto [end, fault] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (fault != std::errc()) return false;
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return true;
    }

    void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t"), rest_.size())); }

    std::string_view rest() const { return rest_; }

private:
    std::string_view rest_;
};

/// "0:17(6): " (Mesa), "0:17: " (glslang and others) and "0(17) : " (NVIDIA).
bool take_place(Scanner& scanner, ShaderMessage& message) {
    Scanner attempt = scanner;
    int source = 0;
    if (!attempt.take_number(source)) return false;
    if (attempt.take(":")) {
        if (!attempt.take_number(message.line)) return false;
        if (attempt.take("(") && !(attempt.take_number(message.column) && attempt.take(")"))) return false;
    } else if (!(attempt.take("(") && attempt.take_number(message.line) && attempt.take(")"))) {
        return false;
    }
    attempt.skip_blanks();
    if (!attempt.take(":")) return false;
    attempt.skip_blanks();
    scanner = attempt;
    return true;
}

/// "error: ", "error C1008: ", "warning: ", "preprocessor error: "; false where the line states no severity.
bool take_severity(Scanner& scanner, ShaderMessage& message) {
    Scanner attempt = scanner;
    const bool preprocessor = attempt.take("preprocessor ");
    if (attempt.take("error") || attempt.take("ERROR") || attempt.take("fatal error")) {
        message.error = true;
    } else if (attempt.take("warning") || attempt.take("WARNING")) {
        message.error = false;
    } else {
        return false;
    }
    const std::size_t colon = attempt.rest().find(':');
    const std::string_view code = attempt.rest().substr(0, colon);
    if (colon == std::string_view::npos || code.size() > 8) return false;
    attempt.take(attempt.rest().substr(0, colon + 1));
    attempt.skip_blanks();
    if (preprocessor) message.text = "preprocessor: ";
    scanner = attempt;
    return true;
}

bool is_noise(std::string_view line) {
    return line.empty() || line.find_first_not_of("- \t") == std::string_view::npos ||
           line.ends_with(" info") || line.find("compilation errors. ") != std::string_view::npos ||
           line.find("compilation terminated") != std::string_view::npos;
}

/// Mesa lists the overloads of a function that was called wrongly, up to 40, each as an error of its own.
/// Three show what it takes.
class OverloadFolder {
public:
    /// Whether the message belongs to the last one of `messages`, and now is part of it.
    bool take(const ShaderMessage& message, std::vector<ShaderMessage>& messages) {
        if (messages.empty()) return false;
        ShaderMessage& call = messages.back();
        if (count_ == 0 && !call.text.ends_with("candidates are:")) return false;
        if (call.line != message.line || call.column != message.column || !message.text.ends_with(')'))
            return false;
        if (++count_ <= kShown) call.text += (count_ == 1 ? " " : "; ") + message.text;
        return true;
    }

    /// Call it before another message follows, and at the end.
    void close(std::vector<ShaderMessage>& messages) {
        if (count_ > kShown) messages.back().text += fmt::format("; and {} more", count_ - kShown);
        count_ = 0;
    }

private:
    static constexpr int kShown = 3;
    int count_ = 0;
};

}  // namespace

std::vector<ShaderMessage> parse_shader_log(const std::string& log) {
    std::vector<ShaderMessage> messages;
    OverloadFolder overloads;
    std::string_view rest = log;
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find('\n'), rest.size());
        std::string_view line = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\0'))
            line.remove_suffix(1);
        if (is_noise(line)) continue;

        // The severity stands before the place ("ERROR: 0:17: ...") or behind it.
        Scanner scanner(line);
        ShaderMessage message;
        const bool severity = take_severity(scanner, message);
        const bool place = take_place(scanner, message);
        const bool known = severity || (place && (take_severity(scanner, message), true));
        if (!known && !messages.empty()) {
            messages.back().text += fmt::format("\n{}", line);
            continue;
        }
        message.text += scanner.rest();
        if (overloads.take(message, messages)) continue;
        overloads.close(messages);
        messages.push_back(std::move(message));
    }
    overloads.close(messages);
    return messages;
}

}  // namespace aftershade::gpu
