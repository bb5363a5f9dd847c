// The grammar of a document, declared once: the parser's checks, the JSON Schema and the tables of the docs
// come from one declaration.
//
// How to declare a document. A `Block` is one kind of object, its `Key`s declare values by a `Form`:
//
//     const Block& lens_block() {
//         static const Block block{
//             .name = "lens",                       // of its table in the docs
//             .thing = "the lens",                  // in messages: "the lens has no key 'bladse'"
//             .doc = "What the camera looks through.",
//             .keys = {required("maker", text(), "Who made it."),
//                      optional("blades", integer(0, 32), "Corners of the aperture.", "0"),
//                      optional("mount", object(mount_block()), "What holds it."),
//                      field(focal_length_spec())},       // a number with a unit, as parameters have
//             .rules = {at_most_one_of({"blades", "mount"})}};
//         return block;
//     }
//
// A document's own block has `is_document`. Objects of several kinds ("type": "point") have a `selector` and
// `kinds`. A form that no other covers is `custom`. The reader of the values checks rules beyond these. Then
//
//     check(node, lens_block(), diagnostics);           every fault, with its place
//     Reader(node, lens_block()).integer("blades");     values, or declared defaults (grammar_reader.h)
//     schema_text("Aftershade lens", lens_block());     the JSON Schema (grammar_schema.h)
//     table_of(lens_block());                           rows of a page (grammar_table.h)
//
// A new key is one line in `keys`, and the line that reads its value. cli/documents.cpp lists the documents,
// for `aftershade schema` and for the marked regions of pages that `aftershade docs` writes.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"
#include "framework/document/param.h"
#include "framework/document/schema_pieces.h"

namespace aftershade::grammar {

class FormType;
class RuleType;
struct Block;

/// Where a value stands, for messages.
struct Spot {
    enum class Within { document, object, list, map };
    std::string key;   ///< "fps"; of an item its list's
    std::string path;  ///< "camera.focal_length", "objects[3].radius"
    Within within = Within::document;

    Spot member(const std::string& name) const;
    Spot item(std::size_t index) const;
    Spot entry(const std::string& name) const;
};

/// A value by frames, or one for all at frame 0.
struct Keyed {
    std::vector<double> frames;               ///< they rise
    std::vector<std::vector<double>> values;  ///< per frame, the components in the declared unit
    std::size_t interpolation = 0;            ///< among interpolation_names()
};

/// The form of a value. Copies share what they refer to. [any thread]
class Form {
public:
    explicit Form(std::shared_ptr<const FormType> type) : type_(std::move(type)) {}
    const FormType& type() const { return *type_; }

private:
    std::shared_ptr<const FormType> type_;
};

/// How keys of one object stand to each other. Copies share what they refer to. [any thread]
class Rule {
public:
    explicit Rule(std::shared_ptr<const RuleType> type) : type_(std::move(type)) {}
    const RuleType& type() const { return *type_; }

private:
    std::shared_ptr<const RuleType> type_;
};

struct Key {
    std::string name;
    Form form;
    std::string doc;  ///< the schema's description and the table's last cell
    bool required = false;
    std::string default_text;           ///< as a document would write it; "" where there is none
    std::optional<Node> default_value;  ///< the same, parsed
    std::string of = {};                ///< for the table: which of several kinds of objects have the key
    bool has_row = true;                ///< in the table; false where another table has it
};

Key required(std::string name, Form form, std::string doc);
/// `default_text` is what an absent key stands for, in JSON; "" where no value does.
Key optional(std::string name, Form form, std::string doc, const std::string& default_text = "");

/// A set of texts, twice: for schemas as a regular expression of ECMA-262, for the program as a predicate.
/// std::regex recurses for each character of a text, so no text of a document meets one.
struct Pattern {
    std::string regex = {};  ///< found anywhere in the text unless it is anchored; "": any text
    std::function<bool(const std::string&)> fits = {};
};

/// Keys that are not declared by name but by a pattern: "aov:mist".
struct OtherKeys {
    Pattern pattern;
    Form form;
};

/// One kind of object.
struct Block {
    std::string name;  ///< "camera", "point"
    std::string thing =
        {};  ///< what messages call it, "{}" for its own key: "the texture '{}'"; "": its place
    std::string doc = {};
    std::vector<Key> keys = {};
    std::vector<Rule> rules = {};
    bool is_document = false;       ///< has "aftershade": 1 and "$schema"
    std::string selector = {};      ///< the key that chooses one of `kinds`
    std::vector<Block> kinds = {};  ///< each has `keys` and `rules` of its own beside those of this block
    std::string default_kind = {};  ///< where the selector is absent; "": it is required
    std::vector<OtherKeys> others = {};
    std::string unknown_key = {};  ///< instead of "<thing> has no key '{}'", such as "'{}' is not a role"
    std::string path = {};  ///< instead of its place, before numbers' names: "light" for "light.intensity"
    std::string definition = {};  ///< its name among the schema's "$defs"; "": it stands where it is used
    std::string type = {};        ///< in tables, where the block has no name, and so no table of its own

    const Key& key(std::string_view key_name) const;  ///< must exist, here or in a kind
};

// ---- forms ----

Form boolean();
Form integer(std::optional<std::int64_t> min = {}, std::optional<std::int64_t> max = {});

struct Range {
    std::optional<double> min = {};
    std::optional<double> above = {};  ///< a minimum that is itself outside
    std::optional<double> max = {};
};
Form number(Range range = {});

struct Text {
    Pattern pattern = {};
    std::string fault = {};  ///< for a text that does not fit; "{}" is the text
    int min_length = 0;
    std::string type = "text";      ///< in tables
    std::string noun = "a string";  ///< in messages
};
Form text(Text text = {});
/// a-z, 0-9 and _, beginning with a letter.
Pattern snake_case_pattern();
Form snake_case();
/// Words that are known, but not here: `fault` says why, "{}" is the word.
struct Elsewhere {
    std::vector<std::string> words = {};
    std::string fault = {};
};
/// One of some words.
Form choice(std::vector<std::string> words, Elsewhere elsewhere = {});
/// A name of something known: "'dpth' is not a role; did you mean 'depth'?". What fits `other` is
/// one, too.
Form name_of(std::vector<std::string> known, std::string noun, Pattern other = {});
/// One value, in JSON: "true", "-1", "\"auto\"".
Form constant(const std::string& json);

/// How a value of a parameter's type may be written beside its literal.
struct LiteralForms {
    bool animated = false;           ///< {"keys": {"1": ..., "24": ...}, "interpolation": "linear"}
    bool still = false;              ///< says that it takes no keys, where other values do
    bool uniform = false;            ///< a vector may be one number
    bool whole = false;              ///< a vector of whole numbers
    bool has_length = false;         ///< a vector is not 0
    std::vector<double> never = {};  ///< within the range, but without a meaning
};
/// As parse_param_value() takes it; a number in the spec's unit, or a string in any that converts to it.
Form literal(ParamSpec spec, LiteralForms forms = {});
/// A key of the spec's name, doc and default.
Key field(const ParamSpec& spec, LiteralForms forms = {}, bool is_required = false);
/// "linear", "step", "smooth": how animated values go from one key to the next.
const std::vector<std::string>& interpolation_names();

struct ListLimits {
    int min = 0;
    int max = -1;  ///< -1: any number
    bool unique = false;
    std::string fault = {};  ///< instead of what is said of a wrong number of items; "{}" is the number
};
Form list(Form item, ListLimits limits = {});

/// The names of an object whose members are all alike.
struct MapNames {
    Pattern pattern = {};
    std::string fault = {};   ///< for a name that does not fit; "{}" is the name
    std::string by = "name";  ///< in tables: "texture by name"
    int min = 0;              ///< members
    int max = -1;
    std::string count_fault = {};  ///< instead of what is said of a wrong number of members
};
Form map(Form value, MapNames names = {});
/// Members named in snake_case; `thing` begins what is said of one that is not: "parameter 'Gain' must be
/// ...".
Form named(Form value, const std::string& thing, int min = 0);
Form object(Block block);
/// A block that may hold itself, which therefore has a name and a definition.
Form object(const Block& (*block)());

/// `fault` is said of a value that fits none; "": what the form says whose kind of JSON it is.
Form any_of(std::vector<Form> forms, std::string fault = "");
/// The first form that takes the value's kind of JSON judges it. `fault` is said of every other kind.
Form by_kind(std::vector<Form> forms, std::string fault);
/// `fault` is said of every value that does not fit.
Form with_fault(Form form, std::string fault);
/// An object with this key is of one form, every other value of the other.
Form by_key(std::string key, Form with, Form without);
/// {"var": "name"} may stand for the value and for each part of it, or a text with "{name}". Values are put
/// in before they are checked.
Form with_variables(Form form, schema::Variables variables = schema::Variables::yes);
/// A document has `written`, of which its reader makes a `form`, which is checked. Blocks of `written` alone
/// have no tables by themselves.
Form written_as(Form form, Form written);
/// In tables, `type` stands for what the form would say of itself.
Form shown_as(Form form, std::string type);
/// A form that no other covers.
struct Custom {
    std::string type;           ///< in tables
    std::string schema = "{}";  ///< JSON
    std::function<void(const Node&, const Spot&, Diagnostics&)> check =
        {};  ///< none: whoever reads the value checks
};
Form custom(Custom custom);

// ---- rules ----

/// `fault` is said instead of the usual sentence; in it "{}" is the thing.
Rule exactly_one_of(std::vector<std::string> keys, std::string fault = "");
Rule at_most_one_of(std::vector<std::string> keys, std::string fault = "");
Rule at_least_one_of(std::vector<std::string> keys, std::string fault = "");
/// Where one is, all are. In `fault` "{}" is how many there are.
Rule together(std::vector<std::string> keys, std::string fault = "");
/// Where `key` is, `other` is too.
Rule needs(std::string key, std::string other, std::string fault = "");

/// Further rules for an object whose `key` is `value`.
struct When {
    std::string key;
    std::string value = {};  ///< JSON; "": anything, where the key is there
    bool or_absent = false;  ///< or where the key is not there
    std::vector<std::string> required = {};
    std::vector<std::string> absent = {};
    std::vector<std::pair<std::string, Form>> narrowed = {};  ///< keys whose values are also of this form
    std::string fault = {};  ///< once, instead of what each part says; "{}" is the thing
};
Rule when(When when);

struct CustomRule {
    std::function<void(const Node&, const std::string& thing, Diagnostics&)> check;  ///< of an object
    std::string schema;         ///< JSON that is put into the object's schema; "" where no schema can say it
    std::string sentence = {};  ///< below the table
};
Rule custom_rule(CustomRule rule);

// ---- checks ----

/// Reports every fault of the object, and of everything inside it, with its place. Whether there was none.
/// `path` stands before names of numbers: "lights[2]" for "lights[2].intensity: -1 is below the minimum 0".
bool check(const Node& node, const Block& block, Diagnostics& diagnostics, const std::string& path = "");

/// Every block with a name that the block refers to, itself first, each name once; in the order of the keys.
std::vector<const Block*> blocks_of(const Block& block);

}  // namespace aftershade::grammar
