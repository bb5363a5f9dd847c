#include "framework/document/grammar_reader.h"

#include <algorithm>

#include "framework/document/grammar_form.h"

namespace aftershade::grammar {

Reader::Reader(const Node& node, const Block& block)
    : node_(&node), block_(&block), kind_(kind_of(node, block)), keys_(keys_of(block, kind_)) {}

const Key& Reader::key_of(std::string_view key) const {
    for (const Key* one : keys_)
        if (one->name == key) return *one;
    return block_->key(key);
}

bool Reader::has(std::string_view key) const {
    const Node* node = node_->find(key);
    if (!node) return false;
    const FormType& form = key_of(key).form.type();
    if (form.is_container()) return form.takes(node->kind);
    Diagnostics faults;
    form.check(*node, {std::string(key), std::string(key), Spot::Within::object}, faults);
    return !faults.has_errors();
}

const Node* Reader::find(std::string_view key) const {
    if (has(key)) return node_->find(key);
    const Key& declared = key_of(key);
    return declared.default_value ? &*declared.default_value : nullptr;
}

const Place& Reader::place(std::string_view key) const {
    const Node* node = node_->find(key);
    return node ? node->place : node_->place;
}

bool Reader::boolean(std::string_view key) const {
    const Node* node = find(key);
    return node && node->boolean;
}

std::int64_t Reader::integer(std::string_view key) const {
    const Node* node = find(key);
    return node ? node->integer : 0;
}

double Reader::number(std::string_view key) const {
    const Node* node = find(key);
    return node ? node->number : 0;
}

std::string Reader::text(std::string_view key) const {
    const Node* node = find(key);
    return node ? node->string : "";
}

std::vector<std::string> Reader::texts(std::string_view key) const {
    std::vector<std::string> found;
    if (const Node* node = find(key))
        for (const Node& item : node->items)
            if (item.is_string()) found.push_back(item.string);
    return found;
}

std::vector<double> Reader::numbers(std::string_view key) const {
    std::vector<double> found;
    const Node* node = find(key);
    if (node && node->is_number()) found.push_back(node->number);
    else if (node)
        for (const Node& item : node->items)
            if (item.is_number()) found.push_back(item.number);
    return found;
}

std::size_t Reader::choice_index(std::string_view key) const {
    const std::vector<std::string> words = key_of(key).form.type().choices();
    const auto found = std::find(words.begin(), words.end(), text(key));
    return found == words.end() ? 0 : std::size_t(found - words.begin());
}

Keyed Reader::keyed(std::string_view key) const {
    const Key& declared = key_of(key);
    const FormType& form = declared.form.type();
    for (const Node* node : {node_->find(key), declared.default_value ? &*declared.default_value : nullptr})
        if (const auto found = node ? form.keyed(*node) : std::nullopt) return *found;
    return {{0}, {{0, 0, 0, 0}}, 0};
}

std::vector<std::vector<double>> Reader::component_list(std::string_view key) const {
    std::vector<std::vector<double>> found;
    const Node* node = find(key);
    const Form* form = key_of(key).form.type().item();
    if (node && form)
        for (const Node& item : node->items)
            if (const auto value = form->type().keyed(item)) found.push_back(value->values.at(0));
    return found;
}

std::optional<ParamValue> Reader::value(std::string_view key) const {
    const Node* node = find(key);
    return node ? key_of(key).form.type().value(*node) : std::nullopt;
}

const Block* Reader::block_of(std::string_view key) const {
    const Block* found = nullptr;
    key_of(key).form.type().visit([&](const Block& block) {
        if (!found) found = &block;
    });
    return found;
}

std::optional<Reader> Reader::object(std::string_view key) const {
    const Node* node = find(key);
    const Block* block = block_of(key);
    if (!node || !block || !node->is_object()) return std::nullopt;
    return Reader(*node, *block);
}

std::vector<Reader> Reader::objects(std::string_view key) const {
    std::vector<Reader> found;
    const Block* block = block_of(key);
    const Node* node = find(key);
    if (node && block)
        for (std::size_t i = 0; i < node->items.size(); ++i) {
            if (!node->items[i].is_object()) continue;
            found.emplace_back(node->items[i], *block);
            found.back().index_ = i;
        }
    return found;
}

std::vector<Reader::Named> Reader::named(std::string_view key) const {
    std::vector<Named> found;
    const Block* block = block_of(key);
    const Node* node = find(key);
    if (node && block)
        for (const Member& member : node->members)
            if (member.value.is_object()) found.push_back({&member, Reader(member.value, *block)});
    return found;
}

}  // namespace aftershade::grammar
