// Small things that text needs in several places.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade {

/// a-z, 0-9 and _, beginning with a letter: what ids, parameters and steps are named by.
bool is_snake_case(std::string_view name);
/// The text of an error after an invalid name: "<thing> 'Name' " and this.
inline constexpr const char* kMustBeSnakeCase = "must be snake_case: a-z, 0-9 and _, beginning with a letter";

/// Words of letters and digits, as "halfSize", "Half Size" and "half-size" have them, as "half_size".
std::string snake_case(std::string_view text);

/// A-Z as a-z; every other byte unchanged, in any locale.
std::string lower_case(std::string_view text);

/// Without the spaces at its ends.
std::string_view trimmed(std::string_view text);
/// The pieces between the separators: one more than separators; pieces may be empty.
std::vector<std::string_view> split(std::string_view text, char separator);
/// The pieces would outlive a string that nothing holds.
template <std::same_as<std::string> Text>
std::string_view trimmed(Text&&) = delete;
template <std::same_as<std::string> Text>
std::vector<std::string_view> split(Text&&, char) = delete;
/// "a, b and c" with `last` " and ".
std::string joined(std::span<const std::string> parts, std::string_view last,
                   std::string_view between = ", ");

/// "1 frame", "0 frames"; the plural of `noun` ends in s.
std::string counted(std::size_t count, std::string_view noun);

/// For people: every byte of a control character, and of what is not UTF-8 (RFC 3629), becomes '?'. Names in
/// files can be anything, a terminal's commands too.
std::string printable(std::string_view text);
/// The same of several lines: their ends and tabs are kept.
std::string printable_lines(std::string_view text);
/// A JSON string with its quotation marks; what is not UTF-8 becomes U+FFFD.
std::string json_string(std::string_view text);
/// The content of an element or an attribute of XML 1.0, SVG or HTML. Tabs and ends of lines are kept; other
/// control characters, which XML does not have, become '?', and so does what is not UTF-8.
std::string xml_text(std::string_view text);
/// Words as a POSIX shell takes them apart again, quoted where it would read them otherwise.
std::string shell_line(const std::vector<std::string>& words);
/// The same for people to copy, in one line: control characters, and what is not UTF-8, are escaped as bash,
/// ksh and zsh read them ($'\012'). In a script shell_line() is right, since other shells lack that.
std::string printed_command(const std::vector<std::string>& words);

/// FNV-1a (Fowler, Noll and Vo 1991). It names files and finds damage; it does not resist intent.
inline constexpr std::uint64_t kFnvBegin = 14695981039346656037ull;
std::uint64_t fnv1a(std::span<const std::byte> bytes, std::uint64_t hash = kFnvBegin);
std::uint64_t fnv1a(std::string_view text, std::uint64_t hash = kFnvBegin);
/// As 16 hexadecimal digits.
std::string fnv1a_hex(std::string_view text);
/// The same with 32 bits.
std::uint32_t fnv1a_32(std::string_view text);

}  // namespace aftershade
