#include "framework/capture/layer_roles.h"

#include <algorithm>

#include "framework/image/role.h"

namespace aftershade {

int asked_layers(std::span<const std::string> roles) {
    int layers = 1;
    for (const std::string& role : roles) layers = std::max(layers, split_layer_role(role).layer + 1);
    return layers;
}

std::vector<std::string> roles_of_any_layer(std::span<const std::string> roles) {
    std::vector<std::string> result;
    for (const std::string& role : roles) {
        const std::string name = split_layer_role(role).role;
        if (std::find(result.begin(), result.end(), name) == result.end()) result.push_back(name);
    }
    return result;
}

std::vector<std::string> roles_of_layer(std::span<const std::string> roles, int layer) {
    std::vector<std::string> result;
    for (const std::string& role : roles)
        if (const RoleOfLayer of = split_layer_role(role); of.layer == layer) result.push_back(of.role);
    return result;
}

}  // namespace aftershade
