#include "framework/base/text.h"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace aftershade {

namespace {

/// Bytes of the character that `text` begins with; 0 where it is a control character or no UTF-8 (RFC 3629).
std::size_t utf8_length(std::string_view text) {
    const auto byte = [&](std::size_t i) {
        return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
    };
    const unsigned first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4) return 0;
    unsigned code = first & (0x7fu >> length);
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
        code = code << 6 | (byte(i) & 0x3f);
    }
    constexpr unsigned kSmallest[] = {0, 0, 0x80, 0x800, 0x10000};
    const bool surrogate = code >= 0xd800 && code <= 0xdfff;
    const bool no_character = code == 0xfffe || code == 0xffff;
    const bool fits = code >= kSmallest[length] && code <= 0x10ffff && code >= 0xa0;
    return fits && !surrogate && !no_character ? length : 0;
}

/// Takes one character off the front; "" for a byte that is none to print.
std::string_view take_character(std::string_view& rest) {
    const std::size_t length = utf8_length(rest);
    const std::string_view taken = rest.substr(0, length);
    rest.remove_prefix(std::max<std::size_t>(1, length));
    return taken;
}

/// As a shell takes it for one word.
std::string shell_word(const std::string& word) {
    constexpr std::string_view kPlain =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./=,:@%+";
    if (!word.empty() && word.find_first_not_of(kPlain) == std::string::npos) return word;
    std::string text = "'";
    for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

}  // namespace

bool is_snake_case(std::string_view name) {
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto fits = [&](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; };
    return !name.empty() && is_letter(name.front()) && std::all_of(name.begin(), name.end(), fits);
}

std::string snake_case(std::string_view text) {
    const auto is_upper = [](char c) { return c >= 'A' && c <= 'Z'; };
    const auto is_lower = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    std::string name;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        const bool fits = is_upper(c) || is_lower(c) || is_digit(c);
        const char before = i > 0 ? text[i - 1] : '_', after = i + 1 < text.size() ? text[i + 1] : '_';
        // "aB", "3B", and the last of "ABCd".
        const bool begins_word =
            is_upper(c) && (is_lower(before) || is_digit(before) || (is_upper(before) && is_lower(after)));
        if ((!fits || begins_word) && !name.empty() && name.back() != '_') name += '_';
        if (fits) name += is_upper(c) ? char(c - 'A' + 'a') : c;
    }
    while (name.ends_with('_')) name.pop_back();
    if (name.empty()) return "unnamed";
    return is_digit(name.front()) ? "n" + name : name;
}

std::string lower_case(std::string_view text) {
    std::string result(text);
    for (char& c : result)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return result;
}

std::string_view trimmed(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return text.substr(0, text.find_last_not_of(' ') + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> pieces;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        pieces.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return pieces;
}

std::string joined(std::span<const std::string> parts, std::string_view last, std::string_view between) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (i > 0) text += i + 1 == parts.size() ? last : between;
        text += parts[i];
    }
    return text;
}

std::string counted(std::size_t count, std::string_view noun) {
    return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string printable(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const std::string_view character = take_character(text);
        result += character.empty() ? "?" : character;
    }
    return result;
}

std::string printable_lines(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const char first = text.front();
        const std::string_view character = take_character(text);
        if (first == '\n' || first == '\t') result += first;
        else result += character.empty() ? "?" : character;
    }
    return result;
}

std::string json_string(std::string_view text) {
    constexpr int kOneLine = -1;
    return nlohmann::json(text).dump(kOneLine, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string xml_text(std::string_view text) {
    std::string result;
    while (!text.empty()) {
        const char first = text.front();
        const std::string_view character = take_character(text);
        if (first == '&') result += "&amp;";
        else if (first == '<') result += "&lt;";
        else if (first == '>') result += "&gt;";
        else if (first == '"') result += "&quot;";
        else if (first == '\n') result += "&#10;";
        else if (first == '\t') result += first;
        else result += character.empty() ? "?" : character;
    }
    return result;
}

std::string shell_line(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
    return line;
}

std::string printed_command(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) {
        if (!line.empty()) line += ' ';
        if (printable(word) == word) {
            line += shell_word(word);
            continue;
        }
        line += "$'";
        for (std::string_view rest = word; !rest.empty();) {
            const unsigned char first = rest.front();
            const std::string_view character = take_character(rest);
            if (first == '\'' || first == '\\') line += '\\';
            line += character;
            if (!character.empty()) continue;
            line += '\\';
            for (const int shift : {6, 3, 0}) line += char('0' + (first >> shift & 7));
        }
        line += '\'';
    }
    return line;
}

std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash) {
    for (const std::byte byte : bytes) hash = (hash ^ std::uint64_t(byte)) * 1099511628211ull;
    return hash;
}

std::uint64_t fnv1a(std::string_view text, std::uint64_t hash) {
    return fnv1a(std::as_bytes(std::span(text)), hash);
}

std::string fnv1a_hex(std::string_view text) {
    constexpr int kDigits = 16, kBits = 4;
    const std::uint64_t hash = fnv1a(text);
    std::string digits;
    for (int digit = kDigits - 1; digit >= 0; --digit)
        digits += "0123456789abcdef"[hash >> (digit * kBits) & 0xf];
    return digits;
}

std::uint32_t fnv1a_32(std::string_view text) {
    std::uint32_t hash = 2166136261u;
    for (const unsigned char c : text) hash = (hash ^ c) * 16777619u;
    return hash;
}

}  // namespace aftershade
