// JSON with positions: looks, captures, manifests, profiles. `//` comments are accepted; duplicate keys and
// nesting deeper than 64 are errors. Built on nlohmann-json's SAX parser, which reports values as it passes
// them: its 3.11 tree keeps no positions.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/base/diagnostics.h"

namespace aftershade {

struct Member;

/// One JSON value and where it begins.
struct Node {
    enum class Kind { null, boolean, integer, number, string, array, object };

    Kind kind = Kind::null;
    Place place;
    bool boolean = false;
    std::int64_t integer = 0;  ///< kind integer
    double number = 0;         ///< kinds number and integer
    std::string string;
    std::vector<Node> items;      ///< array
    std::vector<Member> members;  ///< object, in the document's order

    bool is_number() const { return kind == Kind::integer || kind == Kind::number; }
    bool is_string() const { return kind == Kind::string; }
    bool is_array() const { return kind == Kind::array; }
    bool is_object() const { return kind == Kind::object; }
    const Node* find(std::string_view key) const;
};

struct Member {
    std::string key;
    Place key_place;
    Node value;
};

/// "an object", "a string", ... for messages.
std::string_view kind_name(Node::Kind kind);

inline constexpr int kMaxDocumentDepth = 64;
inline constexpr std::uintmax_t kMaxDocumentBytes = 1024 * 1024;

/// What becomes of a key that an object has twice: a fault, or the last value counts and a warning is given.
/// More than 100 such keys are a fault.
enum class SameKeys { refuse, keep_last };

/// nullopt after a syntax fault, which is the one error reported then.
std::optional<Node> parse_document(std::string_view text, const std::string& file, Diagnostics& diagnostics,
                                   SameKeys same_keys = SameKeys::refuse);

/// Reads and parses a regular file of at most kMaxDocumentBytes.
std::optional<Node> read_document(const std::filesystem::path& path, Diagnostics& diagnostics);

/// Takes an object apart and reports what is missing, of the wrong type, or unknown.
///
///     ObjectReader reader(node, "the step", diagnostics);
///     auto effect = reader.text("effect", Presence::required);
///     reader.finish();
class ObjectReader {
public:
    enum class Presence { optional, required };

    /// `thing` names the object in messages: "the step has no key 'efect'".
    ObjectReader(const Node& node, std::string thing, Diagnostics& diagnostics);

    bool is_object() const { return node_.is_object(); }
    const Node* any(const std::string& key, Presence presence = Presence::optional);
    const Node* object(const std::string& key, Presence presence = Presence::optional);
    const Node* array(const std::string& key, Presence presence = Presence::optional);
    std::optional<std::string> text(const std::string& key, Presence presence = Presence::optional);
    std::optional<double> number(const std::string& key, Presence presence = Presence::optional);
    std::optional<std::int64_t> integer(const std::string& key, Presence presence = Presence::optional);
    std::optional<bool> boolean(const std::string& key, Presence presence = Presence::optional);
    /// A string that is one of `values`; anything else is an error that lists them.
    std::optional<std::string> choice(const std::string& key, std::span<const std::string> values,
                                      Presence presence = Presence::optional);
    std::vector<std::string> texts(const std::string& key);

    /// Reports every key that was not asked for. Call once, last.
    void finish();

private:
    const Node* typed(const std::string& key, Presence presence, Node::Kind kind);

    const Node& node_;
    std::string thing_;
    Diagnostics& diagnostics_;
    std::vector<std::string> known_;
};

/// Requires `"aftershade": 1`, the version of every document of this project.
void check_document_version(ObjectReader& reader, const Node& node, Diagnostics& diagnostics);

}  // namespace aftershade
