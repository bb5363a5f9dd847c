// The base of a grammar's forms and rules, for the sources that define them. grammar.h declares
// the forms and rules themselves.
#pragma once

#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "framework/document/grammar.h"
#include "framework/document/schema_pieces.h"

namespace aftershade::grammar {

/// The cells of a table, and what messages say.
struct Words {
    std::string type;  ///< "float", "list of [case](#case)"
    std::string unit = {};
    std::string range = {};
    bool animated = false;
    std::string many = {};   ///< "whole numbers", in "list of whole numbers"; "": the type
    std::string noun = {};   ///< "a string"
    std::string nouns = {};  ///< "strings", in "'tags' holds strings, not an integer"
};

/// Collects a schema's "$defs" while the schema is written.
class SchemaScope {
public:
    SchemaScope();
    ~SchemaScope();
    schema::json of(const Form& form);
    schema::json of(const Key& key);      ///< with its description and default
    schema::json of(const Block& block);  ///< "$ref" to its definition, where it has a name for one
    /// The object's own: properties, what is required, and rules.
    schema::json object(const Block& block);
    /// {"var": "name"} may stand for what is written while it is set.
    schema::Variables variables = schema::Variables::no;
    schema::json definitions() const;

private:
    schema::json kind(const Block& block, const Block& kind);
    std::unique_ptr<schema::json> definitions_;
};

using BlockVisitor = std::function<void(const Block&)>;

/// One kind of form: all that is said of it stands in one place, so that it agrees.
class FormType {
public:
    virtual ~FormType() = default;
    virtual bool takes(Node::Kind kind) const = 0;
    virtual void check(const Node& node, const Spot& spot, Diagnostics& diagnostics) const = 0;
    virtual schema::json schema(SchemaScope& scope) const = 0;
    virtual Words words() const = 0;

    /// Every block of which a value may be.
    virtual void visit(const BlockVisitor&) const {}
    /// Holds values of other forms, which are sound or not by themselves.
    virtual bool is_container() const { return false; }
    /// A sound value as numbers by frame; nullopt where it has none.
    virtual std::optional<Keyed> keyed(const Node&) const { return std::nullopt; }
    /// A sound value of a parameter's type.
    virtual std::optional<ParamValue> value(const Node&) const { return std::nullopt; }
    /// The choices of a choice; empty for other forms.
    virtual std::vector<std::string> choices() const { return {}; }
    /// The form of a list's items; nullptr for other forms.
    virtual const Form* item() const { return nullptr; }
};

/// How keys stand to each other.
class RuleType {
public:
    virtual ~RuleType() = default;
    virtual void check(const Node& node, const std::string& thing, Diagnostics& diagnostics) const = 0;
    /// The part for the schema of the object.
    virtual schema::json schema(SchemaScope& scope) const = 0;
    virtual std::string sentence() const = 0;  ///< "" for none
};

template <class Type, class... Arguments>
Form make_form(Arguments&&... arguments) {
    return Form(std::make_shared<const Type>(std::forward<Arguments>(arguments)...));
}

/// "'fps' must be a number, not a string", or of an item of a list "'tags' holds strings, not an integer".
void wrong_kind(const Node& node, const Spot& spot, const Words& words, Diagnostics& diagnostics);
/// With "{}" replaced.
std::string filled(const std::string& text, const std::string& value);
/// JSON of our own as a node, without a place.
Node parsed_json(const std::string& text);
bool equals(const Node& a, const Node& b);  ///< of scalars; a number is equal to the integer of its value

void check_block(const Node& node, const Block& block, const Spot& spot, Diagnostics& diagnostics);
/// "aftershade" and "$schema".
const std::vector<Key>& head_keys();
/// The key that chooses the kind.
Key selector_key(const Block& block);
/// The kind that a node's selector names, or the default one; nullptr where there is none.
const Block* kind_of(const Node& node, const Block& block);
/// Those that an object may have beside the selector: the head's, the block's own and the kind's.
std::vector<const Key*> keys_of(const Block& block, const Block* kind);

}  // namespace aftershade::grammar
