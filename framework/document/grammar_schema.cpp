#include "framework/document/grammar_schema.h"

#include <nlohmann/json.hpp>

#include "framework/document/grammar_form.h"

namespace aftershade::grammar {

using schema::json;

namespace {

/// Puts a rule's part into an object's schema. Two that say the same word stand beside each other in "allOf".
void add_rule(json& object, json part) {
    if (part.empty()) return;
    bool collides = false;
    for (const auto& [word, value] : part.items())
        collides = collides || (object.contains(word) && word != "dependentRequired");
    if (collides) {
        object["allOf"].push_back(std::move(part));
        return;
    }
    for (auto& [word, value] : part.items()) {
        if (object.contains(word)) object[word].update(value);
        else object[word] = std::move(value);
    }
}

void add_rules(json& object, const std::vector<Rule>& rules, SchemaScope& scope) {
    for (const Rule& rule : rules) add_rule(object, rule.type().schema(scope));
}

struct ObjectKeys {
    json properties = json::object();
    std::vector<std::string> required;

    void add(const std::vector<Key>& keys, SchemaScope& scope) {
        for (const Key& key : keys) {
            properties[key.name] = scope.of(key);
            if (key.required) required.push_back(key.name);
        }
    }
};

json object_of(const ObjectKeys& keys, const Block& block, SchemaScope& scope) {
    json object = schema::object(keys.properties, keys.required);
    if (object["properties"].empty()) object.erase("properties");
    for (const OtherKeys& other : block.others)
        object["patternProperties"][other.pattern.regex] = scope.of(other.form);
    return object;
}

}  // namespace

SchemaScope::SchemaScope() : definitions_(std::make_unique<json>(json::object())) {}
SchemaScope::~SchemaScope() = default;

json SchemaScope::definitions() const {
    return *definitions_;
}

json SchemaScope::of(const Form& form) {
    json result = form.type().schema(*this);
    const bool in_braces = variables == schema::Variables::in_braces;
    if (variables == schema::Variables::no || (in_braces && result == schema::text())) return result;
    const json variable =
        in_braces ? json{{"type", "string"}, {"pattern", R"(\{[^{}]+\})"}} : schema::variable();
    const bool is_choice = result.size() == 1 && result.contains("anyOf");
    if (!is_choice) return schema::any_of({std::move(result), variable});
    if (result["anyOf"].back() != variable) result["anyOf"].push_back(variable);
    return result;
}

json SchemaScope::of(const Key& key) {
    json result = of(key.form);
    const std::string unit = key.form.type().words().unit;
    if (!key.doc.empty()) result["description"] = key.doc + (unit.empty() ? "" : " [" + unit + "]");
    if (!key.required && !key.default_text.empty()) result["default"] = json::parse(key.default_text);
    return result;
}

json SchemaScope::of(const Block& block) {
    if (block.definition.empty()) return object(block);
    if (!definitions_->contains(block.definition)) {
        // Its place among the others is before those that it refers to.
        (*definitions_)[block.definition] = nullptr;
        json definition = object(block);
        (*definitions_)[block.definition] = std::move(definition);
    }
    return {{"$ref", "#/$defs/" + block.definition}};
}

json SchemaScope::kind(const Block& block, const Block& kind) {
    ObjectKeys keys;
    keys.properties[block.selector] = {{"const", kind.name}};
    if (!kind.doc.empty()) keys.properties[block.selector]["description"] = kind.doc;
    if (kind.name != block.default_kind) keys.required.push_back(block.selector);
    if (block.is_document) keys.add(head_keys(), *this);
    keys.add(kind.keys, *this);
    keys.add(block.keys, *this);
    json result = object_of(keys, block, *this);
    add_rules(result, kind.rules, *this);
    add_rules(result, block.rules, *this);
    return result;
}

json SchemaScope::object(const Block& block) {
    json result;
    if (!block.kinds.empty()) {
        std::vector<json> forms;
        for (const Block& one : block.kinds) forms.push_back(kind(block, one));
        result = schema::any_of(std::move(forms));
    } else {
        ObjectKeys keys;
        if (block.is_document) keys.add(head_keys(), *this);
        keys.add(block.keys, *this);
        result = object_of(keys, block, *this);
        add_rules(result, block.rules, *this);
    }
    if (!block.doc.empty() && !block.is_document) result["description"] = block.doc;
    return result;
}

std::string schema_text(const std::string& title, const Block& document) {
    SchemaScope scope;
    json result = {{"$schema", schema::kDraft}, {"title", title}};
    result.update(scope.object(document));
    json definitions = scope.definitions();
    if (result.dump().find("#/$defs/Variable") != std::string::npos ||
        definitions.dump().find("#/$defs/Variable") != std::string::npos)
        schema::define_variable(definitions);
    if (!definitions.empty()) result["$defs"] = std::move(definitions);
    return result.dump(2) + "\n";
}

}  // namespace aftershade::grammar
