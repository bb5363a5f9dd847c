#include "framework/image/image_forms.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/image/color_space.h"
#include "framework/image/role.h"
#include "framework/image/step_role.h"

namespace aftershade {

grammar::Pattern aov_pattern() {
    // In a regular expression of ECMA-262 a '.' is no end of a line.
    const auto fits = [](const std::string& name) {
        constexpr std::string_view kAov = "aov:";
        return name.starts_with(kAov) && name.size() > kAov.size() &&
               name.find_first_of("\r\n", kAov.size()) == std::string::npos;
    };
    return {"^aov:.+$", fits};
}

grammar::Form role_form() {
    return grammar::name_of(role_names(), "a role", aov_pattern());
}

grammar::Form step_role_form() {
    std::vector<std::string> names = role_names();
    for (const std::string_view name : {kLightChangeRole, kForegroundRole, kForegroundPlaceRole})
        names.emplace_back(name);
    return grammar::name_of(std::move(names), "a role", aov_pattern());
}

grammar::Form color_space_form() {
    std::vector<std::string> names = color_space_names();
    names.insert(names.begin(), "auto");
    return grammar::choice(std::move(names));
}

}  // namespace aftershade
