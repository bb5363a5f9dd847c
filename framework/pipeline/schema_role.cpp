#include "framework/pipeline/schema_role.h"

#include <nlohmann/json.hpp>

#include "framework/image/role.h"

namespace aftershade::schema {

json role() {
    return any_of({one_of(role_names()), {{"type", "string"}, {"pattern", kAovPattern}}});
}

}  // namespace aftershade::schema
