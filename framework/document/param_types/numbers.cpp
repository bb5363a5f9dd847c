#include "framework/document/param_types/numbers.h"

#include "framework/document/schema_pieces.h"

namespace aftershade {

nlohmann::ordered_json quantity_schema(const ParamSpec& spec, const schema::LiteralParts&) {
    return schema::quantity(spec);
}

}  // namespace aftershade
