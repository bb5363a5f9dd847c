// Parts of a document that the host writes. Internal to framework/effect/isf.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/document/document.h"

namespace aftershade {

inline Node node_of_kind(Node::Kind kind, const Place& place) {
    Node node;
    node.kind = kind;
    node.place = place;
    return node;
}
inline Node text_node(const Place& place, std::string text) {
    Node node = node_of_kind(Node::Kind::string, place);
    node.string = std::move(text);
    return node;
}
inline Node number_node(const Place& place, double number) {
    Node node = node_of_kind(Node::Kind::number, place);
    node.number = number;
    if (number == double(int(number))) {
        node.kind = Node::Kind::integer;
        node.integer = int(number);
    }
    return node;
}
inline Node bool_node(const Place& place, bool value) {
    Node node = node_of_kind(Node::Kind::boolean, place);
    node.boolean = value;
    return node;
}
inline Node list_node(const Place& place, std::vector<Node> items) {
    Node node = node_of_kind(Node::Kind::array, place);
    node.items = std::move(items);
    return node;
}
inline Node object_node(const Place& place, std::vector<std::pair<std::string, Node>> members = {}) {
    Node node = node_of_kind(Node::Kind::object, place);
    for (auto& [key, value] : members) node.members.push_back({std::move(key), place, std::move(value)});
    return node;
}
inline void add_member(Node& object, std::string key, Node value) {
    const Place place = value.place;
    object.members.push_back({std::move(key), place, std::move(value)});
}

/// As JSON, indented where it is long.
std::string json_of(const Node& node);

}  // namespace aftershade
