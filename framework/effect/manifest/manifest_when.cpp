// The conditions of a manifest.
#include "framework/effect/manifest/manifest_when.h"

#include <algorithm>
#include <utility>

#include "framework/document/param_type.h"
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

std::string name_in_condition(const std::string& subject) {
    for (const std::string_view prefix : {kHasInput, kNonzero, kChanges})
        if (subject.starts_with(prefix)) return subject.substr(prefix.size());
    return subject;
}

void add_conditions(const grammar::Reader& owner, std::vector<WhenSpec>& conditions) {
    const Node* section = owner.find("when");
    if (!section) return;
    for (const Member& member : section->members) {
        WhenSpec condition;
        condition.subject = member.key;
        condition.place = member.key_place;
        const auto add = [&](const Node& value) {
            if (value.kind == Node::Kind::boolean) condition.values.emplace_back(value.boolean);
            else if (value.kind == Node::Kind::integer) condition.values.emplace_back(value.integer);
            else if (value.is_string()) condition.values.emplace_back(value.string);
        };
        if (member.value.is_array())
            for (const Node& item : member.value.items) add(item);
        else add(member.value);
        conditions.push_back(std::move(condition));
    }
}

void note_identities(EffectManifest& manifest) {
    const auto note = [&](std::vector<WhenSpec>& conditions) {
        for (WhenSpec& condition : conditions)
            if (const ParamSpec* spec = manifest.find_param(name_in_condition(condition.subject)))
                condition.identity = spec->identity;
    };
    for (TextureSpec& texture : manifest.textures) note(texture.when);
    for (TileListSpec& list : manifest.tiles) note(list.when);
    for (PassSpec& pass : manifest.passes) {
        note(pass.when);
        for (ReadSpec& read : pass.reads) note(read.when);
        for (WriteSpec& write : pass.writes) note(write.when);
    }
}

std::vector<std::string> faults_of_condition(const EffectManifest& manifest, const WhenSpec& condition) {
    const std::string subject = "'" + condition.subject + "'", name = name_in_condition(condition.subject);
    if (condition.subject.starts_with(kHasInput)) {
        const InputSpec* input = manifest.find_input(name);
        if (input && input->optional) return {};
        return {subject + " does not name an optional input"};
    }
    const ParamSpec* spec = manifest.find_param(name);
    if (!spec)
        return {"the condition " + subject + " is not a parameter" +
                did_you_mean(name, manifest.param_names())};
    if (condition.subject.starts_with(kNonzero)) {
        if (spec->type->is_scalar) return {};
        return {"the condition " + subject + " is not on a number"};
    }
    if (condition.subject.starts_with(kChanges)) {
        if (spec->identity) return {};
        return {"the condition " + subject + " is on a parameter without an 'identity'"};
    }
    std::vector<std::string> faults;
    for (const ParamValue& value : condition.values)
        if (!may_equal(*spec, value))
            faults.push_back(format_value(value) + " is not a value of '" + spec->name + "'");
    return faults;
}

bool conditions_hold(const std::vector<WhenSpec>& conditions, const ParamReader& params,
                     const std::vector<std::string>& present_inputs) {
    const auto holds = [&](const WhenSpec& condition) {
        const std::string name = name_in_condition(condition.subject);
        ParamValue actual;
        if (condition.subject.starts_with(kHasInput))
            actual = std::find(present_inputs.begin(), present_inputs.end(), name) != present_inputs.end();
        else if (condition.subject.starts_with(kNonzero)) actual = params.is_nonzero(name);
        else if (condition.subject.starts_with(kChanges))
            actual = params.is_changed(name, *condition.identity);
        else actual = params.get(name);
        return std::find(condition.values.begin(), condition.values.end(), actual) != condition.values.end();
    };
    return std::all_of(conditions.begin(), conditions.end(), holds);
}

}  // namespace aftershade
