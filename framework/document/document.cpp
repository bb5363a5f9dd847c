#include "framework/document/document.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <nlohmann/json.hpp>
#include <unordered_set>
#include <utility>

#include "framework/base/atomic_file.h"
#include "framework/base/lfs_pointer.h"

namespace aftershade {

const Node* Node::find(std::string_view key) const {
    for (const Member& member : members)
        if (member.key == key) return &member.value;
    return nullptr;
}

std::string_view kind_name(Node::Kind kind) {
    switch (kind) {
        case Node::Kind::null: return "null";
        case Node::Kind::boolean: return "true or false";
        case Node::Kind::integer: return "an integer";
        case Node::Kind::number: return "a number";
        case Node::Kind::string: return "a string";
        case Node::Kind::array: return "an array";
        case Node::Kind::object: return "an object";
    }
    return "a value";
}

namespace {

/// Each moves the members behind it.
constexpr int kMostEqualKeys = 100;

/// Counts how far the lexer has read.
class CountingIterator {
public:
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    CountingIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}
    reference operator*() const { return *at_; }
    CountingIterator& operator++() {
        ++at_;
        *reached_ = at_;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator before = *this;
        ++*this;
        return before;
    }
    bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
    bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

private:
    const char* at_;
    const char** reached_;
};

/// Builds nodes from SAX events. Each event comes right after its token was read, so the token's first
/// character is found by walking back from there.
class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
    TreeBuilder(std::string_view text, const std::string& file, Diagnostics& diagnostics, SameKeys same_keys)
        : text_(text), file_(file), diagnostics_(diagnostics), same_keys_(same_keys) {
        for (std::size_t i = 0; i < text.size(); ++i)
            if (text[i] == '\n') line_starts_.push_back(i + 1);
    }

    const char** reached() { return &reached_; }
    Node take_root() { return std::move(root_); }

    bool null() override { return add(literal(Node::Kind::null, 4)); }
    bool boolean(bool value) override {
        Node node = literal(Node::Kind::boolean, value ? 4 : 5);
        node.boolean = value;
        return add(std::move(node));
    }
    bool number_integer(number_integer_t value) override { return add_integer(value); }
    bool number_unsigned(number_unsigned_t value) override {
        if (value > number_unsigned_t(INT64_MAX)) return add_number(double(value));
        return add_integer(std::int64_t(value));
    }
    bool number_float(number_float_t value, const string_t&) override { return add_number(value); }
    bool string(string_t& value) override {
        Node node;
        node.kind = Node::Kind::string;
        node.place = place(string_start(offset() - 1));
        node.string = value;
        // A path would end there for the system, and not for who looks at it.
        if (value.find('\0') != std::string::npos) {
            diagnostics_.error(node.place, "a text holds no zero byte (\\u0000)");
            return false;
        }
        return add(std::move(node));
    }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Node::Kind::object); }
    bool start_array(std::size_t) override { return open(Node::Kind::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& value) override {
        const Place at = place(string_start(offset() - 1));
        Node& object = *stack_.back();
        if (!keys_.back().insert(value).second) {
            const auto first = std::ranges::find(object.members, value, &Member::key);
            const std::string message = "the key '" + value + "' occurs twice in one object; first at line " +
                                        std::to_string(first->key_place.line);
            if (same_keys_ == SameKeys::refuse) {
                diagnostics_.error(at, message);
                return false;
            }
            diagnostics_.warning(at, message + " (the last one counts)");
            if (++equal_keys_ > kMostEqualKeys) {
                diagnostics_.error(at, "more than " + std::to_string(kMostEqualKeys) +
                                           " keys occur twice in their objects (remove the first of each)");
                return false;
            }
            object.members.erase(first);
        }
        object.members.push_back({value, at, {}});
        return true;
    }
    bool parse_error(std::size_t position, const std::string&,
                     const nlohmann::detail::exception& e) override {
        const std::string message = plain_message(e.what());
        const std::size_t last = std::min(position == 0 ? 0 : position - 1, text_.size());
        // "invalid" speaks of one character; any other fault is a whole token out of place.
        const bool inside_token = message.find(" - invalid ") != std::string::npos;
        const std::size_t at = inside_token ? last : token_start(last);
        const std::string_view before = std::string_view(text_).substr(0, at);
        const std::size_t comma = before.find_last_not_of(" \t\r\n");
        const bool is_trailing = at < text_.size() && (text_[at] == ']' || text_[at] == '}') &&
                                 comma != std::string_view::npos && before[comma] == ',';
        diagnostics_.error(place(at), message + (is_trailing ? "; remove the comma before it" : ""));
        return false;
    }

    Place place(std::size_t at) const {
        const auto next = std::upper_bound(line_starts_.begin(), line_starts_.end(), at);
        const std::size_t line = std::size_t(next - line_starts_.begin());
        return {file_, int(line), int(at - line_starts_[line - 1]) + 1};
    }

private:
    std::size_t offset() const { return reached_ ? std::size_t(reached_ - text_.data()) : 0; }

    /// The opening quote of the string that ends with the quote at `closing`.
    std::size_t string_start(std::size_t closing) const {
        std::size_t at = closing - 1;
        const auto is_escaped = [&](std::size_t quote) {
            std::size_t backslashes = 0;
            while (quote > backslashes && text_[quote - 1 - backslashes] == '\\') ++backslashes;
            return backslashes % 2 == 1;
        };
        while (text_[at] != '"' || is_escaped(at)) --at;
        return at;
    }

    /// The first character of the token whose last one is at `last`.
    std::size_t token_start(std::size_t last) const {
        if (last >= text_.size()) return last;
        if (text_[last] == '"') return string_start(last);
        const auto belongs = [](char c) {
            return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '+' || c == '.';
        };
        std::size_t at = last;
        while (at > 0 && belongs(text_[last]) && belongs(text_[at - 1])) --at;
        return at;
    }

    Node literal(Node::Kind kind, std::size_t length) const {
        Node node;
        node.kind = kind;
        node.place = place(offset() - length);
        return node;
    }

    /// The lexer has to read one character past a number to know that it ended, unless the text ended first.
    std::size_t number_start() const {
        const auto belongs = [](char c) { return std::strchr("+-.0123456789eE", c) != nullptr && c != '\0'; };
        std::size_t end = offset();
        while (end > 0 && !belongs(text_[end - 1])) --end;
        while (end > 0 && belongs(text_[end - 1])) --end;
        return end;
    }
    bool add_integer(std::int64_t value) {
        Node node;
        node.kind = Node::Kind::integer;
        node.place = place(number_start());
        node.integer = value;
        node.number = double(value);
        return add(std::move(node));
    }
    bool add_number(double value) {
        Node node;
        node.kind = Node::Kind::number;
        node.place = place(number_start());
        node.number = value;
        return add(std::move(node));
    }

    Node* slot() {
        if (stack_.empty()) return &root_;
        Node& parent = *stack_.back();
        if (parent.is_object()) return &parent.members.back().value;
        return &parent.items.emplace_back();
    }
    bool add(Node node) {
        *slot() = std::move(node);
        return true;
    }
    bool open(Node::Kind kind) {
        Node* node = slot();
        node->kind = kind;
        node->place = place(offset() - 1);
        stack_.push_back(node);
        keys_.emplace_back();
        if (stack_.size() <= std::size_t(kMaxDocumentDepth)) return true;
        diagnostics_.error(node->place,
                           "nested deeper than " + std::to_string(kMaxDocumentDepth) + " levels");
        return false;
    }
    bool close() {
        stack_.pop_back();
        keys_.pop_back();
        return true;
    }

    /// "[json.exception.parse_error.101] parse error at line 3, column 5: syntax error while ..." without its
    /// head.
    static std::string plain_message(std::string_view what) {
        const std::size_t column = what.find("column ");
        const std::size_t colon = what.find(": ", column == std::string_view::npos ? 0 : column);
        if (colon != std::string_view::npos) what.remove_prefix(colon + 2);
        else if (const std::size_t bracket = what.find("] "); bracket != std::string_view::npos)
            what.remove_prefix(bracket + 2);
        return std::string(what);
    }

    std::string_view text_;
    const std::string& file_;
    Diagnostics& diagnostics_;
    const SameKeys same_keys_;
    int equal_keys_ = 0;
    std::vector<std::size_t> line_starts_{0};
    const char* reached_ = nullptr;
    Node root_;
    std::vector<Node*> stack_;  // a parent's vector never grows while one of its children is open
    std::vector<std::unordered_set<std::string>> keys_;  // of each open object
};

}  // namespace

std::optional<Node> parse_document(std::string_view text, const std::string& file, Diagnostics& diagnostics,
                                   SameKeys same_keys) {
    if (text.size() > kMaxDocumentBytes) {
        diagnostics.error({file}, "is larger than " + std::to_string(kMaxDocumentBytes) + " bytes");
        return std::nullopt;
    }
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    // No editor counts the mark as a column.
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    TreeBuilder builder(text, file, diagnostics, same_keys);
    if (text.starts_with("\x76\x2f\x31\x01") || text.starts_with("\x89PNG")) {
        diagnostics.error({file},
                          "is a picture, and this place takes a JSON document; the look comes before the "
                          "capture");
        return std::nullopt;
    }
    // The lexer takes a NUL for the end of the text, and would leave what follows unread.
    if (const std::size_t nul = text.find('\0'); nul != std::string_view::npos) {
        diagnostics.error(builder.place(nul), "a NUL byte: a document is UTF-8 text");
        return std::nullopt;
    }
    // The library's word for it changes from version to version.
    if (text.empty()) {
        diagnostics.error(builder.place(0), "unexpected end of input; the document is empty");
        return std::nullopt;
    }
    const CountingIterator begin(text.data(), builder.reached());
    const CountingIterator end(text.data() + text.size(), builder.reached());
    const bool strict = true;  // nothing may follow the value
    const bool ignore_comments = true;
    if (!nlohmann::json::sax_parse(begin, end, &builder, nlohmann::json::input_format_t::json, strict,
                                   ignore_comments))
        return std::nullopt;
    return builder.take_root();
}

std::optional<Node> read_document(const std::filesystem::path& path, Diagnostics& diagnostics) {
    std::string fault;
    const std::string text = read_regular_file(path, kMaxDocumentBytes, fault);
    diagnostics.note_document(path);
    if (fault.empty()) fault = lfs_fault(path);
    if (fault.empty()) return parse_document(text, path.string(), diagnostics);
    diagnostics.error({path.string()}, fault);
    return std::nullopt;
}

ObjectReader::ObjectReader(const Node& node, std::string thing, Diagnostics& diagnostics)
    : node_(node), thing_(std::move(thing)), diagnostics_(diagnostics) {
    if (!node.is_object())
        diagnostics.error(node.place,
                          thing_ + " must be an object, not " + std::string(kind_name(node.kind)));
}

const Node* ObjectReader::any(const std::string& key, Presence presence) {
    known_.push_back(key);
    const Node* value = node_.find(key);
    if (!value && presence == Presence::required && node_.is_object())
        diagnostics_.error(node_.place, thing_ + " has no '" + key + "'");
    return value;
}

const Node* ObjectReader::typed(const std::string& key, Presence presence, Node::Kind kind) {
    const Node* value = any(key, presence);
    if (!value) return nullptr;
    const bool fits = value->kind == kind || (kind == Node::Kind::number && value->is_number());
    if (fits) return value;
    diagnostics_.error(value->place, "'" + key + "' must be " + std::string(kind_name(kind)) + ", not " +
                                         std::string(kind_name(value->kind)));
    return nullptr;
}

const Node* ObjectReader::object(const std::string& key, Presence presence) {
    return typed(key, presence, Node::Kind::object);
}
const Node* ObjectReader::array(const std::string& key, Presence presence) {
    return typed(key, presence, Node::Kind::array);
}
std::optional<std::string> ObjectReader::text(const std::string& key, Presence presence) {
    const Node* value = typed(key, presence, Node::Kind::string);
    return value ? std::optional(value->string) : std::nullopt;
}
std::optional<double> ObjectReader::number(const std::string& key, Presence presence) {
    const Node* value = typed(key, presence, Node::Kind::number);
    return value ? std::optional(value->number) : std::nullopt;
}
std::optional<std::int64_t> ObjectReader::integer(const std::string& key, Presence presence) {
    const Node* value = typed(key, presence, Node::Kind::integer);
    return value ? std::optional(value->integer) : std::nullopt;
}
std::optional<bool> ObjectReader::boolean(const std::string& key, Presence presence) {
    const Node* value = typed(key, presence, Node::Kind::boolean);
    return value ? std::optional(value->boolean) : std::nullopt;
}

std::optional<std::string> ObjectReader::choice(const std::string& key, std::span<const std::string> values,
                                                Presence presence) {
    const Node* value = typed(key, presence, Node::Kind::string);
    if (!value) return std::nullopt;
    if (std::find(values.begin(), values.end(), value->string) != values.end()) return value->string;
    diagnostics_.error(value->place, "'" + key + "' is '" + value->string + "' but must be " +
                                         list_of_names(values) + did_you_mean(value->string, values));
    return std::nullopt;
}

std::vector<std::string> ObjectReader::texts(const std::string& key) {
    std::vector<std::string> found;
    const Node* list = array(key);
    if (!list) return found;
    for (const Node& item : list->items) {
        if (item.is_string()) found.push_back(item.string);
        else
            diagnostics_.error(item.place,
                               "'" + key + "' holds strings, not " + std::string(kind_name(item.kind)));
    }
    return found;
}

void ObjectReader::finish() {
    for (const Member& member : node_.members) {
        if (std::find(known_.begin(), known_.end(), member.key) != known_.end()) continue;
        diagnostics_.error(member.key_place,
                           thing_ + " has no key '" + member.key + "'" + did_you_mean(member.key, known_));
    }
}

void check_document_version(ObjectReader& reader, const Node& node, Diagnostics& diagnostics) {
    const auto version = reader.integer("aftershade", ObjectReader::Presence::required);
    if (version && *version != 1)
        diagnostics.error(node.find("aftershade")->place, "document version " + std::to_string(*version) +
                                                              " is not known; this program reads version 1");
}

}  // namespace aftershade
