#include "framework/document/grammar_form.h"

#include <algorithm>
#include <cassert>
#include <map>

namespace aftershade::grammar {

namespace {

std::vector<std::string> names_of(const std::vector<Block>& kinds) {
    std::vector<std::string> names;
    for (const Block& kind : kinds) names.push_back(kind.name);
    return names;
}

/// "the camera", "objects[3]", "'detect'".
std::string thing_of(const Block& block, const Block* kind, const Spot& spot) {
    const std::string& thing = kind && !kind->thing.empty() ? kind->thing : block.thing;
    if (!thing.empty()) return filled(thing, spot.key);
    return spot.within == Spot::Within::object ? "'" + spot.key + "'" : spot.path;
}

const Key* find_key(const std::vector<const Key*>& keys, std::string_view name) {
    const auto found =
        std::find_if(keys.begin(), keys.end(), [&](const Key* key) { return key->name == name; });
    return found == keys.end() ? nullptr : *found;
}

/// "; it is a key of type 'area'", where the object would need to be of another kind.
std::string kinds_with(const Block& block, const std::string& name) {
    std::vector<std::string> kinds;
    for (const Block& kind : block.kinds)
        if (std::any_of(kind.keys.begin(), kind.keys.end(), [&](const Key& key) { return key.name == name; }))
            kinds.push_back(kind.name);
    return kinds.empty() ? "" : "; it is a key of " + block.selector + " " + list_of_names(kinds);
}

/// Checks one object, and what is inside it.
class BlockCheck {
public:
    BlockCheck(const Node& node, const Block& block, const Spot& spot, Diagnostics& diagnostics)
        : node_(node),
          block_(block),
          spot_(spot),
          kind_(kind_of(node, block)),
          thing_(thing_of(block, kind_, spot)),
          keys_(keys_of(block, kind_)),
          diagnostics_(diagnostics) {}

    void run() {
        if (!node_.is_object()) {
            diagnostics_.error(node_.place,
                               thing_ + " must be an object, not " + std::string(kind_name(node_.kind)));
            return;
        }
        if (!block_.selector.empty()) check_key(selector_key(block_));
        for (const Key* key : keys_) check_key(*key);
        for (const Rule& rule : block_.rules) rule.type().check(node_, thing_, diagnostics_);
        if (kind_)
            for (const Rule& rule : kind_->rules) rule.type().check(node_, thing_, diagnostics_);
        for (const Member& member : node_.members) check_member(member);
    }

private:
    void check_key(const Key& key) {
        const Node* value = node_.find(key.name);
        if (value) key.form.type().check(*value, spot_.member(key.name), diagnostics_);
        else if (key.required) diagnostics_.error(node_.place, thing_ + " has no '" + key.name + "'");
    }

    /// One that is not declared by its name.
    void check_member(const Member& member) {
        if (member.key == block_.selector || find_key(keys_, member.key)) return;
        for (const OtherKeys& other : block_.others)
            if (other.pattern.fits(member.key)) {
                other.form.type().check(member.value, spot_.entry(member.key), diagnostics_);
                return;
            }
        const std::string elsewhere = kinds_with(block_, member.key);
        // Which keys there are is not known of an object of no kind.
        if (!elsewhere.empty() && !kind_) return;
        std::vector<std::string> known;
        for (const Key* key : keys_) known.push_back(key->name);
        if (!block_.selector.empty()) known.push_back(block_.selector);
        diagnostics_.error(member.key_place,
                           (block_.unknown_key.empty() ? thing_ + " has no key '" + member.key + "'"
                                                       : filled(block_.unknown_key, member.key)) +
                               (elsewhere.empty() ? did_you_mean(member.key, known) : elsewhere));
    }

    const Node& node_;
    const Block& block_;
    const Spot& spot_;
    const Block* kind_;
    const std::string thing_;
    const std::vector<const Key*> keys_;
    Diagnostics& diagnostics_;
};

void collect(const Block& block, std::vector<const Block*>& found) {
    const auto is_same = [&](const Block* other) { return other->name == block.name; };
    if (!block.name.empty()) {
        if (std::any_of(found.begin(), found.end(), is_same)) return;
        found.push_back(&block);
    }
    const auto inside = [&](const Block& other) { collect(other, found); };
    for (const Key& key : block.keys) key.form.type().visit(inside);
    for (const OtherKeys& other : block.others) other.form.type().visit(inside);
    for (const Block& kind : block.kinds)
        for (const Key& key : kind.keys) key.form.type().visit(inside);
}

}  // namespace

Spot Spot::member(const std::string& name) const {
    return {name, path.empty() ? name : path + "." + name, Within::object};
}

Spot Spot::item(std::size_t index) const {
    return {key, path + "[" + std::to_string(index) + "]", Within::list};
}

Spot Spot::entry(const std::string& name) const {
    return {name, path.empty() ? name : path + "." + name, Within::map};
}

std::string filled(const std::string& text, const std::string& value) {
    std::string result = text;
    for (std::size_t at = 0; (at = result.find("{}", at)) != std::string::npos; at += value.size())
        result.replace(at, 2, value);
    return result;
}

Node parsed_json(const std::string& text) {
    Diagnostics diagnostics;
    const auto node = parse_document(text, "the grammar", diagnostics);
    assert(node && "JSON of a declaration");
    return *node;
}

bool equals(const Node& a, const Node& b) {
    if (a.is_number() && b.is_number()) return a.number == b.number;
    return a.kind == b.kind && a.boolean == b.boolean && a.string == b.string;
}

void wrong_kind(const Node& node, const Spot& spot, const Words& words, Diagnostics& diagnostics) {
    const bool item = spot.within == Spot::Within::list;
    diagnostics.error(node.place, "'" + spot.key + "' " +
                                      (item ? "holds " + words.nouns : "must be " + words.noun) + ", not " +
                                      std::string(kind_name(node.kind)));
}

Key required(std::string name, Form form, std::string doc) {
    return {std::move(name), std::move(form), std::move(doc), true, "", std::nullopt};
}

Key optional(std::string name, Form form, std::string doc, const std::string& default_text) {
    Key key{std::move(name), std::move(form), std::move(doc), false, default_text, std::nullopt};
    if (!default_text.empty()) key.default_value = parsed_json(default_text);
    return key;
}

const Key& Block::key(std::string_view key_name) const {
    for (const Key& one : keys)
        if (one.name == key_name) return one;
    for (const Block& kind : kinds)
        for (const Key& one : kind.keys)
            if (one.name == key_name) return one;
    assert(!"a key that the block does not declare");
    return keys.front();
}

const Block* kind_of(const Node& node, const Block& block) {
    const Node* selector = node.find(block.selector);
    const std::string& name = selector && selector->is_string() ? selector->string : block.default_kind;
    if (selector && !selector->is_string()) return nullptr;
    const auto found = std::find_if(block.kinds.begin(), block.kinds.end(),
                                    [&](const Block& kind) { return kind.name == name; });
    return found == block.kinds.end() ? nullptr : &*found;
}

Key selector_key(const Block& block) {
    constexpr const char* kDoc = "Kind, which decides the other keys.";
    const Form form = choice(names_of(block.kinds));
    if (block.default_kind.empty()) return required(block.selector, form, kDoc);
    return optional(block.selector, form, kDoc, "\"" + block.default_kind + "\"");
}

std::vector<const Key*> keys_of(const Block& block, const Block* kind) {
    std::vector<const Key*> keys;
    if (block.is_document)
        for (const Key& key : head_keys()) keys.push_back(&key);
    for (const Key& key : block.keys) keys.push_back(&key);
    if (kind)
        for (const Key& key : kind->keys) keys.push_back(&key);
    return keys;
}

void check_block(const Node& node, const Block& block, const Spot& spot, Diagnostics& diagnostics) {
    Spot inside = spot;
    if (!block.path.empty()) inside.path = block.path;
    BlockCheck(node, block, inside, diagnostics).run();
}

bool check(const Node& node, const Block& block, Diagnostics& diagnostics, const std::string& path) {
    const int errors_before = diagnostics.error_count();
    check_block(node, block, {"", path}, diagnostics);
    return diagnostics.error_count() == errors_before;
}

std::vector<const Block*> blocks_of(const Block& block) {
    std::vector<const Block*> found;
    collect(block, found);
    return found;
}

}  // namespace aftershade::grammar
