// Words of GLSL's versions and of the host's text, which an ISF file may use as names. Internal to
// framework/effect.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace aftershade::isf_words {

using Words = std::set<std::string, std::less<>>;

/// Stands before a name of the file's own where the name cannot stand by itself.
inline constexpr std::string_view kOwn = "isf_own_";
/// Stands before a function that has the name of a variable or an image, too.
inline constexpr std::string_view kCall = "isf_call_";
/// Stands before an image's name in IMG_THIS_PIXEL(), where the pixel need not be sampled.
inline constexpr std::string_view kHere = "isf_here_";

/// Keywords of GLSL 4.50 that stand before another word where they are meant as such.
extern const Words kQualifiers;
/// Functions that glsl/isf/ has macros for.
extern const Words kSampling;
/// Variables of ISF, which files written for other hosts declare.
extern const Words kOfIsf;

/// Names that some hosts give to an output and a coordinate of GLSL, for files that do not declare them.
extern const Words kAliases;

/// Letters, digits and _, as GLSL takes them for a name of the file's own.
bool is_name(std::string_view word);
/// A word of GLSL 1.20, which nothing can have as its name.
bool is_old_word(std::string_view word);
/// Types of GLSL 4.50 that 1.20 has not.
bool is_new_type(std::string_view word);
/// A keyword of GLSL 4.50 that GLSL 1.20 did not have, so that older files may use it as a name.
bool is_keyword(std::string_view word);
/// "switch" and its like, after which another word may follow.
bool is_statement_word(std::string_view word);
/// Names of the host's own text, but for those that ISF has.
bool is_host_name(std::string_view word);
/// Components that may stand behind a dot.
bool is_swizzle(std::string_view word);

}  // namespace aftershade::isf_words

namespace aftershade {

/// A driver's message with the names that the author wrote.
std::string with_isf_names(const std::string& message);

}  // namespace aftershade
