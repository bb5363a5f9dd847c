// Which layers a list of roles needs.
#pragma once

#include <span>
#include <vector>

#include "framework/image/role.h"

namespace aftershade {

/// How many layers are separated: one more than the furthest that a role is read from, at least 1.
int asked_layers(std::span<const RoleId> roles);

/// The roles without their layers, each once.
std::vector<RoleId> roles_of_any_layer(std::span<const RoleId> roles);

/// Those of one layer, without it.
std::vector<RoleId> roles_of_layer(std::span<const RoleId> roles, int layer);

}  // namespace aftershade
