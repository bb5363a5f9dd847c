// Where each value of a JSON text begins and ends, so that an edit changes its bytes and no others.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace aftershade::serve {

/// Bytes begin .. end - 1.
struct Span {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::string_view of(std::string_view text) const { return text.substr(begin, end - begin); }
};

struct SpanMember;

struct SpanNode {
    enum class Kind { scalar, array, object };
    Kind kind = Kind::scalar;
    Span span;
    std::vector<SpanNode> items;      ///< array
    std::vector<SpanMember> members;  ///< object

    const SpanMember* find(std::string_view key) const;
};

struct SpanMember {
    std::string key;  ///< without its escapes
    Span key_span;    ///< with its quotes
    SpanNode value;
};

/// `text` must be one that parse_document() takes. Throws Error(ErrorKind::usage) where it is not.
SpanNode spans_of(std::string_view text);

/// The first byte from `from` on that is neither white space nor of a comment; text.size() where there is
/// none.
std::size_t skip_blank(std::string_view text, std::size_t from);

}  // namespace aftershade::serve
