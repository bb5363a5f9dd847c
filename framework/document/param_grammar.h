// The grammar of a parameter's declaration, made from the table of types (param_type.h).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "framework/document/grammar.h"
#include "framework/document/param.h"

namespace aftershade {

/// Allowed values of "from" for a parameter of a type. Empty: any text.
using ParamSources = std::function<std::vector<std::string>(ParamType type)>;

/// One entry of a manifest's "params", which is of one of `types`. read_param_spec() checks what a default
/// must be beside its kind.
grammar::Block param_block(std::span<const ParamType> types, const ParamSources& sources = {});

/// "> focal_length", spaces where one likes. nullopt for any other text.
std::optional<ParamRelation> parse_relation(std::string_view text, const Place& place);

}  // namespace aftershade
