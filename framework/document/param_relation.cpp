#include <algorithm>
#include <array>

#include "framework/document/param_type.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

using Order = ParamRelation::Order;

const ParamSpec* find_spec(std::span<const ParamSpec> specs, const std::string& name) {
    const auto found =
        std::find_if(specs.begin(), specs.end(), [&](const ParamSpec& spec) { return spec.name == name; });
    return found == specs.end() ? nullptr : &*found;
}

/// -1, 0 or 1 as `a` is below, equal to or above `b`; nullopt where the units measure different things.
/// Both directions are tried for equality, because one of them may round: 85 mm is 0.085 m.
std::optional<int> compare(double a, const std::string& unit_a, double b, const std::string& unit_b) {
    if (unit_a == unit_b) return (a > b) - (a < b);
    const auto b_in_a = convert_unit(b, unit_b, unit_a);
    const auto a_in_b = convert_unit(a, unit_a, unit_b);
    if (!b_in_a || !a_in_b) return std::nullopt;
    if (a == *b_in_a || *a_in_b == b) return 0;
    return a > *b_in_a ? 1 : -1;
}

bool holds(Order order, int comparison) {
    switch (order) {
        case Order::less: return comparison < 0;
        case Order::less_equal: return comparison <= 0;
        case Order::greater: return comparison > 0;
        case Order::greater_equal: return comparison >= 0;
    }
    return false;
}

std::string_view order_words(Order order) {
    switch (order) {
        case Order::less: return "below";
        case Order::less_equal: return "at most";
        case Order::greater: return "above";
        case Order::greater_equal: return "at least";
    }
    return "";
}

/// Why `relation` cannot be checked at all; "" where it can.
std::string declaration_fault(std::span<const ParamSpec> specs, const ParamSpec& spec,
                              const ParamRelation& relation) {
    const ParamSpec* other = find_spec(specs, relation.other);
    if (!other) {
        std::vector<std::string> names;
        for (const ParamSpec& candidate : specs)
            if (candidate.name != spec.name) names.push_back(candidate.name);
        return "'" + relation.other + "' is not a parameter" + did_you_mean(relation.other, names);
    }
    if (other == &spec) return "a parameter has no relation to itself";
    if (!is_scalar_type(other->type))
        return "'" + other->name + "' is of type " + std::string(param_type_name(other->type)) +
               ", which has no order";
    if (!compare(0, spec.unit, 0, other->unit)) {
        const auto unit_text = [](const std::string& unit) {
            return unit.empty() ? std::string("a pure number") : "in " + unit;
        };
        return "'" + other->name + "' is " + unit_text(other->unit) + ", which cannot be compared with " +
               (spec.unit.empty() ? "a pure number" : spec.unit);
    }
    return "";
}

/// "0.04 m must be above focal_length, 50 mm"
std::string relation_text(const RelationFault& fault) {
    return with_unit(fault.value, fault.spec->unit) + " must be " + std::string(order_words(fault.order)) +
           " " + fault.other->name + ", " + with_unit(fault.other_value, fault.other->unit);
}

}  // namespace

std::vector<RelationFault> check_relations(std::span<const ParamSpec> specs, const ParamSet& values) {
    std::vector<RelationFault> faults;
    for (const ParamSpec& spec : specs)
        for (const ParamRelation& relation : spec.relations) {
            const ParamSpec* other = find_spec(specs, relation.other);
            if (!other || !is_scalar_type(other->type)) continue;
            const double value = numbers_of(spec, values.get(spec.name))[0];
            const double other_value = numbers_of(*other, values.get(other->name))[0];
            const auto comparison = compare(value, spec.unit, other_value, other->unit);
            if (comparison && !holds(relation.order, *comparison))
                faults.push_back({&spec, other, relation.order, value, other_value});
        }
    return faults;
}

std::string relation_message(const std::string& step, const RelationFault& fault) {
    return step + "." + fault.spec->name + ": " + relation_text(fault);
}

void check_relation_declarations(std::span<const ParamSpec> specs, Diagnostics& diagnostics) {
    for (const ParamSpec& spec : specs)
        for (const ParamRelation& relation : spec.relations) {
            const std::string fault = declaration_fault(specs, spec, relation);
            if (!fault.empty()) {
                diagnostics.error(relation.place, "parameter '" + spec.name + "': " + fault);
                continue;
            }
            const ParamSpec* other = find_spec(specs, relation.other);
            const double value = numbers_of(spec, spec.default_value)[0];
            const double other_value = numbers_of(*other, other->default_value)[0];
            if (holds(relation.order, *compare(value, spec.unit, other_value, other->unit))) continue;
            const RelationFault broken{&spec, other, relation.order, value, other_value};
            diagnostics.error(relation.place, spec.name + ".default: " + relation_text(broken));
        }
}

}  // namespace aftershade
