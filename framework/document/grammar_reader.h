// Values out of an object that a block declares.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/document/document.h"
#include "framework/document/grammar.h"
#include "framework/document/param.h"

namespace aftershade::grammar {

/// Each value is the document's where it is there and sound, else the declared default, else nothing: 0, "",
/// false, an empty list. It reports no fault: check() has. The block must declare each key that is read;
/// its selector is kind(). Node and block outlive the reader. [any thread]
class Reader {
public:
    Reader(const Node& node, const Block& block);
    Reader(const Node& node, Block&& block) = delete;

    const Node& node() const { return *node_; }
    const Block& block() const { return *block_; }
    /// The name of the object's kind; "" where its selector is wrong.
    std::string kind() const { return kind_ ? kind_->name : ""; }

    /// The document's value where it is sound, else the declared default; nullptr where there is neither. A
    /// list or an object is sound by its kind of JSON alone: what is in it is judged when it is read.
    const Node* find(std::string_view key) const;
    /// Whether the document itself has a sound value.
    bool has(std::string_view key) const;
    /// Place of the document's value, else of the object.
    const Place& place(std::string_view key) const;

    bool boolean(std::string_view key) const;
    std::int64_t integer(std::string_view key) const;
    double number(std::string_view key) const;
    std::string text(std::string_view key) const;
    std::vector<std::string> texts(std::string_view key) const;
    /// Numbers of a list, or the one of a number that stands in its place.
    std::vector<double> numbers(std::string_view key) const;
    /// The place of the word among the declared ones.
    template <class Enum = std::size_t>
    Enum choice(std::string_view key) const {
        return Enum(choice_index(key));
    }

    /// A literal's numbers by frame, in the declared unit.
    Keyed keyed(std::string_view key) const;
    /// The numbers of a literal that holds for every frame.
    std::vector<double> components(std::string_view key) const { return keyed(key).values.at(0); }
    /// The numbers of a list of such literals, without those that have faults.
    std::vector<std::vector<double>> component_list(std::string_view key) const;
    std::optional<ParamValue> value(std::string_view key) const;

    /// nullopt where there is no object.
    std::optional<Reader> object(std::string_view key) const;
    std::vector<Reader> objects(
        std::string_view key) const;              ///< of a list; what is not an object is left out
    std::size_t index() const { return index_; }  ///< of one of objects(), in its list
    struct Named;
    std::vector<Named> named(std::string_view key) const;  ///< of a map

private:
    const Key& key_of(std::string_view key) const;
    std::size_t choice_index(std::string_view key) const;
    const Block* block_of(std::string_view key) const;

    const Node* node_;
    const Block* block_;
    const Block* kind_;
    std::vector<const Key*> keys_;
    std::size_t index_ = 0;
};

/// A member of a map and its object.
struct Reader::Named {
    const Member* member;
    Reader reader;
};

}  // namespace aftershade::grammar
