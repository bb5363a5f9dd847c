#include "framework/capture/layer_roles.h"

#include <algorithm>

namespace aftershade {

namespace {

RoleId without_layer(const RoleId& role) {
    return role.layer() < 0 ? role : RoleId(role.of_any_layer());
}

}  // namespace

int asked_layers(std::span<const RoleId> roles) {
    int layers = 1;
    for (const RoleId& role : roles) layers = std::max(layers, role.layer() + 1);
    return layers;
}

std::vector<RoleId> roles_of_any_layer(std::span<const RoleId> roles) {
    std::vector<RoleId> result;
    for (const RoleId& role : roles) {
        RoleId any = without_layer(role);
        if (std::ranges::find(result, any) == result.end()) result.push_back(std::move(any));
    }
    return result;
}

std::vector<RoleId> roles_of_layer(std::span<const RoleId> roles, int layer) {
    std::vector<RoleId> result;
    for (const RoleId& role : roles)
        if (role.layer() == layer) result.push_back(without_layer(role));
    return result;
}

}  // namespace aftershade
