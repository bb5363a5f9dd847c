// Forms of values that hold others: lists, objects, several forms at once.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/document/grammar_form.h"

namespace aftershade::grammar {

using schema::json;

namespace {

/// "2", "at least 1", "at most 64", "1 to 8"; "" for any number.
std::string count_text(int min, int max) {
    if (min == max) return std::to_string(min);
    if (max < 0) return min > 0 ? "at least " + std::to_string(min) : "";
    return (min > 0 ? std::to_string(min) + " to " : "at most ") + std::to_string(max);
}

class List : public FormType {
public:
    List(Form item, ListLimits limits) : item_(std::move(item)), limits_(std::move(limits)) {}

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::array; }
    bool is_container() const override { return true; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!node.is_array()) return wrong_kind(node, spot, words(), diagnostics);
        const int count = int(node.items.size());
        if (count < limits_.min || (limits_.max >= 0 && count > limits_.max)) {
            diagnostics.error(
                node.place, !limits_.fault.empty()
                                ? filled(limits_.fault, std::to_string(count))
                                : "'" + spot.key + "' holds " + count_text(limits_.min, limits_.max) +
                                      (limits_.min == 1 && limits_.max < 2 ? " item" : " items") + ", not " +
                                      std::to_string(count));
            return;
        }
        for (std::size_t i = 0; i < node.items.size(); ++i)
            item_.type().check(node.items[i], spot.item(i), diagnostics);
        if (limits_.unique) check_unique(node, spot, diagnostics);
    }
    json schema(SchemaScope& scope) const override {
        json result = schema::array_of(scope.of(item_), limits_.min, limits_.max);
        if (limits_.unique) result["uniqueItems"] = true;
        return result;
    }
    Words words() const override {
        const Words item = item_.type().words();
        const std::string count = count_text(limits_.min, limits_.max);
        const std::string type =
            item.type.find(", ") == std::string::npos ? item.type : "(" + item.type + ")";
        return {.type = "list of " + (item.many.empty() ? type : item.many),
                .unit = item.unit,
                .range = count.empty() ? item.range : count,
                .noun = "an array",
                .nouns = "arrays"};
    }
    void visit(const BlockVisitor& visitor) const override { item_.type().visit(visitor); }
    const Form* item() const override { return &item_; }

private:
    static std::string text_of(const Node& node) {
        return node.is_string() ? "'" + node.string + "'" : std::to_string(node.integer);
    }

    static void check_unique(const Node& node, const Spot& spot, Diagnostics& diagnostics) {
        for (auto item = node.items.begin(); item != node.items.end(); ++item) {
            const auto is_same = [&](const Node& other) { return equals(other, *item); };
            if (!item->items.empty() || !item->members.empty() ||
                std::none_of(node.items.begin(), item, is_same))
                continue;
            diagnostics.error(item->place, "'" + spot.key + "' holds " + text_of(*item) + " twice");
        }
    }

    Form item_;
    ListLimits limits_;
};

class Map : public FormType {
public:
    Map(Form value, MapNames names) : value_(std::move(value)), names_(std::move(names)) {}

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::object; }
    bool is_container() const override { return true; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!node.is_object()) return wrong_kind(node, spot, words(), diagnostics);
        const int count = int(node.members.size());
        if (count < names_.min || (names_.max >= 0 && count > names_.max))
            diagnostics.error(node.place,
                              !names_.count_fault.empty()
                                  ? names_.count_fault
                                  : "'" + spot.key + "' has " + count_text(names_.min, names_.max) +
                                        (names_.min == 1 && names_.max < 2 ? " member" : " members") +
                                        ", not " + std::to_string(count));
        for (const Member& member : node.members) {
            if (!fits(member.key)) diagnostics.error(member.key_place, filled(names_.fault, member.key));
            value_.type().check(member.value, spot.entry(member.key), diagnostics);
        }
    }
    json schema(SchemaScope& scope) const override {
        json result = {{"type", "object"}};
        const bool has_braces = scope.variables == schema::Variables::in_braces;
        if (const std::string& regex = names_.pattern.regex; !regex.empty())
            result["propertyNames"] = {{"pattern", (has_braces ? R"(\{[^{}]+\}|)" : "") + regex}};
        json value = scope.of(value_);
        if (!value.empty()) result["additionalProperties"] = std::move(value);
        if (names_.min > 0) result["minProperties"] = names_.min;
        if (names_.max >= 0) result["maxProperties"] = names_.max;
        return result;
    }
    Words words() const override {
        const Words value = value_.type().words();
        return {.type = value.type + " by " + names_.by, .noun = "an object", .nouns = "objects"};
    }
    void visit(const BlockVisitor& visitor) const override { value_.type().visit(visitor); }

private:
    bool fits(const std::string& name) const { return !names_.pattern.fits || names_.pattern.fits(name); }

    Form value_;
    MapNames names_;
};

class Object : public FormType {
public:
    /// Found when it is first needed: a block may hold itself.
    using Find = std::function<const Block&()>;
    explicit Object(Find block) : block_(std::move(block)) {}

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::object; }
    bool is_container() const override { return true; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        // Of a member messages speak by its key, as of every other member of a wrong kind.
        if (!node.is_object() && spot.within == Spot::Within::object)
            return wrong_kind(node, spot, words(), diagnostics);
        check_block(node, block_(), spot, diagnostics);
    }
    json schema(SchemaScope& scope) const override { return scope.of(block_()); }
    Words words() const override {
        const Block& block = block_();
        const std::string link = "[" + block.name + "](#" + block.name + ")";
        return {.type = block.name.empty() ? block.type : link, .noun = "an object", .nouns = "objects"};
    }
    void visit(const BlockVisitor& visitor) const override { visitor(block_()); }

private:
    Find block_;
};

class AnyOf : public FormType {
public:
    /// What `fault` is said of.
    enum class Of { every_value, other_kinds };
    AnyOf(std::vector<Form> forms, std::string fault, Of of)
        : forms_(std::move(forms)), fault_(std::move(fault)), of_(of) {}

    bool takes(Node::Kind kind) const override {
        return std::any_of(forms_.begin(), forms_.end(),
                           [&](const Form& form) { return form.type().takes(kind); });
    }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (fitting(node, spot)) return;
        const bool is_for_all = !fault_.empty() && of_ == Of::every_value;
        // A value says by its kind which form it means.
        for (const Form& form : forms_)
            if (!is_for_all && form.type().takes(node.kind))
                return form.type().check(node, spot, diagnostics);
        if (fault_.empty()) return wrong_kind(node, spot, words(), diagnostics);
        diagnostics.error(node.place, filled(fault_, node.is_string() ? node.string : spot.key));
    }
    json schema(SchemaScope& scope) const override {
        std::vector<json> all;
        for (const Form& form : forms_) {
            json one = scope.of(form);
            if (one.size() == 1 && one.contains("anyOf"))
                for (json& part : one["anyOf"]) all.push_back(std::move(part));
            else all.push_back(std::move(one));
        }
        if (all.size() == 1) return std::move(all[0]);
        return schema::any_of(std::move(all));
    }
    Words words() const override {
        Words all = forms_.front().type().words();
        all.many.clear();
        for (std::size_t i = 1; i < forms_.size(); ++i) {
            const Words one = forms_[i].type().words();
            const char* separator = i + 1 == forms_.size() ? " or " : ", ";
            all.type += ", or " + one.type;
            all.noun += separator + one.noun;
            all.nouns += separator + one.nouns;
        }
        return all;
    }
    void visit(const BlockVisitor& visitor) const override {
        for (const Form& form : forms_) form.type().visit(visitor);
    }
    std::optional<Keyed> keyed(const Node& node) const override {
        const Form* form = fitting(node, {});
        return form ? form->type().keyed(node) : std::nullopt;
    }
    std::optional<ParamValue> value(const Node& node) const override {
        const Form* form = fitting(node, {});
        return form ? form->type().value(node) : std::nullopt;
    }

private:
    const Form* fitting(const Node& node, const Spot& spot) const {
        for (const Form& form : forms_) {
            Diagnostics faults;
            form.type().check(node, spot, faults);
            if (!faults.has_errors()) return &form;
        }
        return nullptr;
    }

    std::vector<Form> forms_;
    std::string fault_;
    Of of_;
};

class ByKey : public FormType {
public:
    ByKey(std::string key, Form with, Form without)
        : key_(std::move(key)), with_(std::move(with)), without_(std::move(without)) {}

    bool takes(Node::Kind kind) const override { return without_.type().takes(kind); }
    bool is_container() const override { return true; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        (node.find(key_) ? with_ : without_).type().check(node, spot, diagnostics);
    }
    json schema(SchemaScope& scope) const override {
        return {{"if", {{"type", "object"}, {"required", {key_}}}},
                {"then", scope.of(with_)},
                {"else", scope.of(without_)}};
    }
    Words words() const override {
        Words all = without_.type().words();
        all.type += ", or " + with_.type().words().type;
        return all;
    }
    void visit(const BlockVisitor& visitor) const override {
        without_.type().visit(visitor);
        with_.type().visit(visitor);
    }

private:
    std::string key_;
    Form with_, without_;
};

/// A form that is another but for what a derived class says.
class Wrapper : public FormType {
public:
    explicit Wrapper(Form form) : form_(std::move(form)) {}

    bool takes(Node::Kind kind) const override { return form_.type().takes(kind); }
    bool is_container() const override { return form_.type().is_container(); }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        form_.type().check(node, spot, diagnostics);
    }
    json schema(SchemaScope& scope) const override { return form_.type().schema(scope); }
    Words words() const override { return form_.type().words(); }
    void visit(const BlockVisitor& visitor) const override { form_.type().visit(visitor); }
    std::optional<Keyed> keyed(const Node& node) const override { return form_.type().keyed(node); }
    std::optional<ParamValue> value(const Node& node) const override { return form_.type().value(node); }
    std::vector<std::string> choices() const override { return form_.type().choices(); }
    const Form* item() const override { return form_.type().item(); }

protected:
    Form form_;
};

class WithVariables : public Wrapper {
public:
    WithVariables(Form form, schema::Variables variables) : Wrapper(std::move(form)), variables_(variables) {}

    json schema(SchemaScope& scope) const override {
        const schema::Variables before = std::exchange(scope.variables, variables_);
        json result = scope.of(form_);
        scope.variables = before;
        return result;
    }

private:
    schema::Variables variables_;
};

class WrittenAs : public Wrapper {
public:
    WrittenAs(Form form, Form written) : Wrapper(std::move(form)), written_(std::move(written)) {}

    json schema(SchemaScope& scope) const override { return written_.type().schema(scope); }
    Words words() const override { return written_.type().words(); }

private:
    Form written_;
};

class ShownAs : public Wrapper {
public:
    ShownAs(Form form, std::string type) : Wrapper(std::move(form)), type_(std::move(type)) {}

    Words words() const override {
        Words words = form_.type().words();
        words.type = words.many = type_;
        words.range.clear();
        return words;
    }

private:
    std::string type_;
};

}  // namespace

Form list(Form item, ListLimits limits) {
    return make_form<List>(std::move(item), std::move(limits));
}

Form map(Form value, MapNames names) {
    return make_form<Map>(std::move(value), std::move(names));
}

Form named(Form value, const std::string& thing, int min) {
    return map(std::move(value),
               {.pattern = snake_case_pattern(), .fault = thing + " '{}' " + kMustBeSnakeCase, .min = min});
}

Form object(Block block) {
    const auto shared = std::make_shared<const Block>(std::move(block));
    return make_form<Object>([shared]() -> const Block& { return *shared; });
}

Form object(const Block& (*block)()) {
    return make_form<Object>([block]() -> const Block& { return block(); });
}

Form by_key(std::string key, Form with, Form without) {
    return make_form<ByKey>(std::move(key), std::move(with), std::move(without));
}

Form any_of(std::vector<Form> forms, std::string fault) {
    return make_form<AnyOf>(std::move(forms), std::move(fault), AnyOf::Of::every_value);
}

Form by_kind(std::vector<Form> forms, std::string fault) {
    return make_form<AnyOf>(std::move(forms), std::move(fault), AnyOf::Of::other_kinds);
}

Form with_fault(Form form, std::string fault) {
    return any_of({std::move(form)}, std::move(fault));
}

Form with_variables(Form form, schema::Variables variables) {
    return make_form<WithVariables>(std::move(form), variables);
}

Form written_as(Form form, Form written) {
    return make_form<WrittenAs>(std::move(form), std::move(written));
}

Form shown_as(Form form, std::string type) {
    return make_form<ShownAs>(std::move(form), std::move(type));
}

}  // namespace aftershade::grammar
