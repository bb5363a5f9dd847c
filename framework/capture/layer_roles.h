// Which layers a list of roles needs.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace aftershade {

/// How many layers are separated: one more than the furthest that a role is read from, at least 1.
int asked_layers(std::span<const std::string> roles);

/// The roles without their layers, each once.
std::vector<std::string> roles_of_any_layer(std::span<const std::string> roles);

/// Those of one layer, without it.
std::vector<std::string> roles_of_layer(std::span<const std::string> roles, int layer);

}  // namespace aftershade
