// The conditions of a manifest.
#include "framework/effect/manifest/manifest_when.h"

#include <algorithm>
#include <utility>

#include "framework/core/param_type.h"
#include "framework/effect/manifest/manifest_parser.h"

namespace aftershade {

namespace {

/// A condition that could never hold is a mistake.
bool may_equal(const ParamSpec& spec, const ParamValue& value) {
    if (!spec.type->is_integer || value.index() != spec.default_value.index()) return false;
    return !spec.type->is_choice || std::find(spec.values.begin(), spec.values.end(),
                                              std::get<std::string>(value)) != spec.values.end();
}

}  // namespace

void ManifestParser::add_conditions(const Node& section, std::vector<WhenSpec>& conditions) {
    for (const Member& member : section.members) conditions.push_back(when(member));
}

WhenSpec ManifestParser::when(const Member& member) {
    WhenSpec condition;
    condition.subject = member.key;
    condition.place = member.key_place;
    const auto add = [&](const Node& value) {
        if (value.kind == Node::Kind::boolean) condition.values.emplace_back(value.boolean);
        else if (value.kind == Node::Kind::integer) condition.values.emplace_back(value.integer);
        else if (value.is_string()) condition.values.emplace_back(value.string);
        else fault(value.place, "a condition compares with true, false, an integer or a name");
    };
    if (member.value.is_array())
        for (const Node& item : member.value.items) add(item);
    else add(member.value);
    if (member.value.is_array() && member.value.items.empty())
        fault(member.value.place, "the condition '" + member.key + "' has no value, so it never holds");
    return condition;
}

std::vector<std::string> faults_of_condition(const EffectManifest& manifest, const WhenSpec& condition) {
    const std::string subject = "'" + condition.subject + "'";
    std::vector<std::string> faults;
    if (condition.subject.starts_with(kHasInput)) {
        const InputSpec* input = manifest.find_input(condition.subject.substr(kHasInput.size()));
        if (!input || !input->optional) faults.push_back(subject + " does not name an optional input");
        for (const ParamValue& value : condition.values)
            if (!std::holds_alternative<bool>(value))
                faults.push_back(subject + " is true or false, not " + format_value(value));
        return faults;
    }
    const ParamSpec* spec = manifest.find_param(condition.subject);
    if (!spec)
        return {"the condition " + subject + " is not a parameter" +
                did_you_mean(condition.subject, manifest.param_names())};
    for (const ParamValue& value : condition.values)
        if (!may_equal(*spec, value))
            faults.push_back(format_value(value) + " is not a value of '" + spec->name + "'");
    return faults;
}

bool conditions_hold(const std::vector<WhenSpec>& conditions, const ParamReader& params,
                     const std::vector<std::string>& present_inputs) {
    const auto holds = [&](const WhenSpec& condition) {
        ParamValue actual;
        if (condition.subject.starts_with(kHasInput)) {
            const std::string input = condition.subject.substr(kHasInput.size());
            actual = std::find(present_inputs.begin(), present_inputs.end(), input) != present_inputs.end();
        } else {
            actual = params.get(condition.subject);
        }
        return std::find(condition.values.begin(), condition.values.end(), actual) != condition.values.end();
    };
    return std::all_of(conditions.begin(), conditions.end(), holds);
}

}  // namespace aftershade
