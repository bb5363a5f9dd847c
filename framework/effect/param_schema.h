// JSON Schema of a parameter's declaration. Internal to framework/effect.
#pragma once

#include <string>

namespace aftershade {

std::string param_schema();

}  // namespace aftershade
