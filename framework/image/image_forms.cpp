#include "framework/image/image_forms.h"

#include <string>
#include <utility>
#include <vector>

#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade {

grammar::Form role_form() {
    return grammar::name_of(role_names(), "a role", kAovPattern);
}

grammar::Form color_space_form() {
    std::vector<std::string> names = color_space_names();
    names.insert(names.begin(), "auto");
    return grammar::choice(std::move(names));
}

}  // namespace aftershade
