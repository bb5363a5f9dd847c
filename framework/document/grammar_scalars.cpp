// Forms of values that hold no others.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/document/grammar_form.h"
#include "framework/document/units.h"

namespace aftershade::grammar {

using schema::json;

namespace {

class Boolean : public FormType {
public:
    bool takes(Node::Kind kind) const override { return kind == Node::Kind::boolean; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!takes(node.kind)) wrong_kind(node, spot, words(), diagnostics);
    }
    json schema(SchemaScope&) const override { return {{"type", "boolean"}}; }
    Words words() const override {
        return {.type = "bool", .noun = std::string(kind_name(Node::Kind::boolean)), .nouns = "booleans"};
    }
};

std::string text_of(const Range& range) {
    if (range.above)
        return "above " + format_number(*range.above) +
               (range.max ? " and at most " + format_number(*range.max) : "");
    if (range.min && range.max) return format_number(*range.min) + " to " + format_number(*range.max);
    if (range.min) return "at least " + format_number(*range.min);
    return range.max ? "at most " + format_number(*range.max) : "";
}

class Number : public FormType {
public:
    Number(Range range, bool is_integer) : range_(range), is_integer_(is_integer) {}

    bool takes(Node::Kind kind) const override {
        return kind == Node::Kind::integer || (!is_integer_ && kind == Node::Kind::number);
    }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!takes(node.kind)) return wrong_kind(node, spot, words(), diagnostics);
        const double value = node.number;
        if ((range_.min && value < *range_.min) || (range_.max && value > *range_.max) ||
            (range_.above && value <= *range_.above))
            diagnostics.error(node.place, "'" + spot.key + "' must be " +
                                              (range_.min && range_.max ? "from " : "") + text_of(range_) +
                                              ", not " + format_number(value));
    }
    json schema(SchemaScope&) const override {
        const auto limit = [&](double value) {
            const bool is_whole = std::abs(value) < 1e15 && value == std::floor(value);
            return is_whole ? json(std::int64_t(value)) : json(value);
        };
        json result = {{"type", is_integer_ ? "integer" : "number"}};
        if (range_.above) result["exclusiveMinimum"] = limit(*range_.above);
        if (range_.min) result["minimum"] = limit(*range_.min);
        if (range_.max) result["maximum"] = limit(*range_.max);
        return result;
    }
    Words words() const override {
        return {.type = is_integer_ ? "int" : "float",
                .range = text_of(range_),
                .many = is_integer_ ? "whole numbers" : "numbers",
                .noun = is_integer_ ? "an integer" : "a number",
                .nouns = is_integer_ ? "integers" : "numbers"};
    }

private:
    Range range_;
    bool is_integer_;
};

class TextForm : public FormType {
public:
    explicit TextForm(Text text) : text_(std::move(text)) {}

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::string; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!takes(node.kind)) return wrong_kind(node, spot, words(), diagnostics);
        if (fits(node.string)) return;
        diagnostics.error(node.place, !text_.fault.empty()  ? filled(text_.fault, node.string)
                                      : node.string.empty() ? "'" + spot.key + "' is empty"
                                                            : "'" + spot.key + "' is '" + node.string +
                                                                  "', which is not " + text_.noun);
    }
    json schema(SchemaScope&) const override {
        json result = {{"type", "string"}};
        if (text_.min_length > 0) result["minLength"] = text_.min_length;
        if (!text_.pattern.regex.empty()) result["pattern"] = text_.pattern.regex;
        return result;
    }
    Words words() const override { return {.type = text_.type, .noun = text_.noun, .nouns = "strings"}; }

private:
    bool fits(const std::string& text) const {
        if (text.size() < std::size_t(text_.min_length)) return false;
        return !text_.pattern.fits || text_.pattern.fits(text);
    }

    Text text_;
};

class Choice : public FormType {
public:
    Choice(std::vector<std::string> words, Elsewhere elsewhere)
        : words_(std::move(words)), elsewhere_(std::move(elsewhere)), all_(words_) {
        all_.insert(all_.end(), elsewhere_.words.begin(), elsewhere_.words.end());
    }

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::string; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!takes(node.kind)) return wrong_kind(node, spot, words(), diagnostics);
        if (std::find(words_.begin(), words_.end(), node.string) != words_.end()) return;
        const bool is_known = std::find(all_.begin(), all_.end(), node.string) != all_.end();
        diagnostics.error(node.place, is_known ? filled(elsewhere_.fault, node.string)
                                               : "'" + spot.key + "' is '" + node.string + "' but must be " +
                                                     list_of_names(all_) + did_you_mean(node.string, all_));
    }
    json schema(SchemaScope&) const override {
        return words_.size() == 1 ? json{{"const", words_[0]}} : schema::one_of(words_);
    }
    Words words() const override {
        std::string type = "enum";
        for (std::size_t i = 0; i < words_.size(); ++i) type += (i ? ", " : ": ") + words_[i];
        return {.type = type, .noun = "a string", .nouns = "strings"};
    }
    std::vector<std::string> choices() const override { return words_; }

private:
    std::vector<std::string> words_;
    Elsewhere elsewhere_;
    std::vector<std::string> all_;  // words of both
};

class NameOf : public FormType {
public:
    NameOf(std::vector<std::string> known, std::string noun, Pattern other)
        : known_(std::move(known)), noun_(std::move(noun)), other_(std::move(other)) {}

    bool takes(Node::Kind kind) const override { return kind == Node::Kind::string; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!takes(node.kind)) return wrong_kind(node, spot, words(), diagnostics);
        if (std::find(known_.begin(), known_.end(), node.string) != known_.end()) return;
        if (other_.fits && other_.fits(node.string)) return;
        diagnostics.error(node.place, node.string.empty() ? "'" + spot.key + "' is empty"
                                                          : "'" + node.string + "' is not " + noun_ +
                                                                did_you_mean(node.string, known_));
    }
    json schema(SchemaScope&) const override {
        if (!other_.fits) return schema::one_of(known_);
        return schema::any_of({schema::one_of(known_), {{"type", "string"}, {"pattern", other_.regex}}});
    }
    Words words() const override { return {.type = noun_, .noun = "a string", .nouns = "strings"}; }

private:
    std::vector<std::string> known_;
    std::string noun_;
    Pattern other_;
};

class Constant : public FormType {
public:
    explicit Constant(const std::string& text) : text_(text), value_(parsed_json(text)) {}

    bool takes(Node::Kind kind) const override { return kind == value_.kind; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (!equals(node, value_)) diagnostics.error(node.place, "'" + spot.key + "' must be " + text_);
    }
    json schema(SchemaScope&) const override { return {{"const", json::parse(text_)}}; }
    Words words() const override { return {.type = "`" + text_ + "`", .noun = text_, .nouns = text_}; }

private:
    std::string text_;
    Node value_;
};

class CustomForm : public FormType {
public:
    explicit CustomForm(Custom custom) : custom_(std::move(custom)) {}

    bool takes(Node::Kind) const override { return true; }
    void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const override {
        if (custom_.check) custom_.check(node, spot, diagnostics);
    }
    json schema(SchemaScope&) const override { return json::parse(custom_.schema); }
    Words words() const override {
        return {.type = custom_.type, .noun = custom_.type, .nouns = custom_.type};
    }

private:
    Custom custom_;
};

}  // namespace

Form boolean() {
    return make_form<Boolean>();
}

Form integer(std::optional<std::int64_t> min, std::optional<std::int64_t> max) {
    Range range;
    if (min) range.min = double(*min);
    if (max) range.max = double(*max);
    return make_form<Number>(range, true);
}

Form number(Range range) {
    return make_form<Number>(range, false);
}

Form text(Text rules) {
    return make_form<TextForm>(std::move(rules));
}

Pattern snake_case_pattern() {
    return {schema::kSnakeCase, [](const std::string& name) { return is_snake_case(name); }};
}

Form snake_case() {
    return text({.pattern = snake_case_pattern(),
                 .fault = std::string("the name '{}' ") + kMustBeSnakeCase,
                 .type = "name",
                 .noun = "a name"});
}

Form choice(std::vector<std::string> words, Elsewhere elsewhere) {
    return make_form<Choice>(std::move(words), std::move(elsewhere));
}

Form name_of(std::vector<std::string> known, std::string noun, Pattern other) {
    return make_form<NameOf>(std::move(known), std::move(noun), std::move(other));
}

Form constant(const std::string& text_of_value) {
    return make_form<Constant>(text_of_value);
}

Form custom(Custom custom) {
    return make_form<CustomForm>(std::move(custom));
}

const std::vector<Key>& head_keys() {
    static const auto check_version = [](const Node& node, const Spot& spot, Diagnostics& diagnostics) {
        if (node.kind != Node::Kind::integer)
            return wrong_kind(node, spot, integer().type().words(), diagnostics);
        if (node.integer != 1)
            diagnostics.error(node.place, "document version " + std::to_string(node.integer) +
                                              " is not known; this program reads version 1");
    };
    static const std::vector<Key> keys = {
        required("aftershade", custom({.type = "`1`", .schema = R"({"const": 1})", .check = check_version}),
                 "Version of the format."),
        optional("$schema", text(), "Path of the schema, for editors.")};
    return keys;
}

}  // namespace aftershade::grammar
