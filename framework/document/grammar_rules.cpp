// How keys of one object stand to each other.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/document/grammar_form.h"

namespace aftershade::grammar {

using schema::json;

namespace {

using KeyNames = std::vector<std::string>;

json required_json(const std::string& key) {
    return {{"required", {key}}};
}

/// "'look' and 'steps'"; in tables "`look` and `steps`".
std::string list_in_table(const KeyNames& keys, const std::string& conjunction) {
    std::string text = list_of_names(keys, conjunction);
    std::replace(text.begin(), text.end(), '\'', '`');
    return text;
}

/// How many of some keys there are.
class Count : public RuleType {
public:
    enum class Kind { exactly_one, at_most_one, at_least_one };
    Count(Kind kind, KeyNames keys, std::string fault)
        : kind_(kind), keys_(std::move(keys)), fault_(std::move(fault)) {}

    void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const override {
        std::vector<const Node*> found;
        for (const std::string& key : keys_)
            if (const Node* value = node.find(key)) found.push_back(value);
        if (found.size() == 1 || (found.empty() && kind_ == Kind::at_most_one) ||
            (found.size() > 1 && kind_ == Kind::at_least_one))
            return;
        const std::string names = list_of_names(keys_, "and");
        diagnostics.error(found.size() > 1 && kind_ == Kind::at_most_one ? found.back()->place : node.place,
                          !fault_.empty()               ? filled(fault_, thing)
                          : kind_ == Kind::exactly_one  ? thing + " has one of " + names
                          : kind_ == Kind::at_least_one ? thing + " has at least one of " + names
                                                        : "only one of " + names + " may be given");
    }

    json schema(SchemaScope&) const override {
        json each = json::array(), pairs = json::array();
        for (std::size_t i = 0; i < keys_.size(); ++i) {
            each.push_back(required_json(keys_[i]));
            for (std::size_t k = i + 1; k < keys_.size(); ++k)
                pairs.push_back({{"required", {keys_[i], keys_[k]}}});
        }
        if (kind_ == Kind::exactly_one) return {{"oneOf", each}};
        if (kind_ == Kind::at_least_one) return {{"anyOf", each}};
        return {{"not", {{"anyOf", pairs}}}};
    }

    std::string sentence() const override {
        const char* how = kind_ == Kind::exactly_one   ? "Exactly one of "
                          : kind_ == Kind::at_most_one ? "At most one of "
                                                       : "At least one of ";
        return how + list_in_table(keys_, "and") + ".";
    }

private:
    Kind kind_;
    KeyNames keys_;
    std::string fault_;
};

class Together : public RuleType {
public:
    Together(KeyNames keys, std::string fault) : keys_(std::move(keys)), fault_(std::move(fault)) {}

    void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const override {
        const auto count = std::count_if(keys_.begin(), keys_.end(),
                                         [&](const std::string& key) { return node.find(key) != nullptr; });
        if (count == 0 || std::size_t(count) == keys_.size()) return;
        diagnostics.error(node.place, fault_.empty()
                                          ? thing + " has all or none of " + list_of_names(keys_, "and")
                                          : filled(fault_, std::to_string(count)));
    }
    json schema(SchemaScope&) const override {
        json all = json::object();
        for (const std::string& key : keys_) all[key] = keys_;
        return {{"dependentRequired", all}};
    }
    std::string sentence() const override { return "All or none of " + list_in_table(keys_, "and") + "."; }

private:
    KeyNames keys_;
    std::string fault_;
};

class Needs : public RuleType {
public:
    Needs(std::string key, std::string other, std::string fault)
        : key_(std::move(key)), other_(std::move(other)), fault_(std::move(fault)) {}

    void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const override {
        const Node* value = node.find(key_);
        if (!value || node.find(other_)) return;
        diagnostics.error(value->place,
                          fault_.empty() ? "'" + key_ + "' needs '" + other_ + "'" : filled(fault_, thing));
    }
    json schema(SchemaScope&) const override { return {{"dependentRequired", {{key_, {other_}}}}}; }
    std::string sentence() const override { return "`" + key_ + "` needs `" + other_ + "`."; }

private:
    std::string key_, other_, fault_;
};

class WhenRule : public RuleType {
public:
    explicit WhenRule(When when) : when_(std::move(when)) {
        if (!when_.value.empty()) value_ = parsed_json(when_.value);
    }

    void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const override {
        if (!holds(node)) return;
        Diagnostics faults;
        for (const std::string& key : when_.required)
            if (!node.find(key)) faults.error(node.place, thing + " has no '" + key + "'");
        for (const std::string& key : when_.absent)
            if (const Node* value = node.find(key))
                faults.error(value->place, thing + " has no key '" + key + "' where " + condition());
        for (const auto& [key, form] : when_.narrowed) {
            const Node* value = node.find(key);
            // Of one value one fault is enough.
            if (value && !has_fault(*value, diagnostics))
                form.type().check(*value, {key, key, Spot::Within::object}, faults);
        }
        for (const Diagnostic& fault : faults.all()) {
            diagnostics.error(fault.place, when_.fault.empty() ? fault.message : filled(when_.fault, thing));
            if (!when_.fault.empty()) return;
        }
    }

    json schema(SchemaScope& scope) const override {
        json condition = {{"properties", {{when_.key, json::object()}}}};
        if (value_) condition["properties"][when_.key] = {{"const", json::parse(when_.value)}};
        else condition.erase("properties");
        if (!when_.or_absent) condition["required"] = {when_.key};
        json properties = json::object();
        for (const std::string& key : when_.absent) properties[key] = false;
        for (const auto& [key, form] : when_.narrowed) properties[key] = scope.of(form);
        json consequence = json::object();
        if (!when_.required.empty()) consequence["required"] = when_.required;
        if (!properties.empty()) consequence["properties"] = std::move(properties);
        return {{"if", std::move(condition)}, {"then", std::move(consequence)}};
    }

    std::string sentence() const override { return ""; }

private:
    bool holds(const Node& node) const {
        const Node* value = node.find(when_.key);
        return value ? !value_ || equals(*value, *value_) : when_.or_absent;
    }

    /// "'kind' is "lut"", "it has 'of'".
    std::string condition() const {
        return value_ ? "'" + when_.key + "' is " + when_.value : "it has '" + when_.key + "'";
    }

    static bool has_fault(const Node& node, const Diagnostics& diagnostics) {
        return std::any_of(diagnostics.all().begin(), diagnostics.all().end(), [&](const Diagnostic& fault) {
            const Place& place = fault.place;
            return place.line == node.place.line && place.column == node.place.column &&
                   place.file == node.place.file;
        });
    }

    When when_;
    std::optional<Node> value_;
};

class OtherRule : public RuleType {
public:
    explicit OtherRule(CustomRule rule) : rule_(std::move(rule)) {}

    void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const override {
        if (rule_.check) rule_.check(node, thing, diagnostics);
    }
    json schema(SchemaScope&) const override {
        return rule_.schema.empty() ? json::object() : json::parse(rule_.schema);
    }
    std::string sentence() const override { return rule_.sentence; }

private:
    CustomRule rule_;
};

template <class Type, class... Arguments>
Rule make_rule(Arguments&&... arguments) {
    return Rule(std::make_shared<const Type>(std::forward<Arguments>(arguments)...));
}

}  // namespace

Rule exactly_one_of(KeyNames keys, std::string fault) {
    return make_rule<Count>(Count::Kind::exactly_one, std::move(keys), std::move(fault));
}

Rule at_most_one_of(KeyNames keys, std::string fault) {
    return make_rule<Count>(Count::Kind::at_most_one, std::move(keys), std::move(fault));
}

Rule at_least_one_of(KeyNames keys, std::string fault) {
    return make_rule<Count>(Count::Kind::at_least_one, std::move(keys), std::move(fault));
}

Rule together(KeyNames keys, std::string fault) {
    return make_rule<Together>(std::move(keys), std::move(fault));
}

Rule needs(std::string key, std::string other, std::string fault) {
    return make_rule<Needs>(std::move(key), std::move(other), std::move(fault));
}

Rule when(When when) {
    return make_rule<WhenRule>(std::move(when));
}

Rule custom_rule(CustomRule rule) {
    return make_rule<OtherRule>(std::move(rule));
}

}  // namespace aftershade::grammar
