#include "framework/scattering/scattering_form.h"

#include <nlohmann/json.hpp>

#include "framework/core/grammar_form.h"
#include "framework/scattering/scattering_schema.h"

namespace aftershade::grammar {

namespace {

class ScatteringForm : public FormType {
public:
    bool takes(Node::Kind) const override { return true; }
    void check(const Node&, const Spot&, Diagnostics&) const override {}
    schema::json schema(SchemaScope& scope) const override {
        return schema::any_of({schema::text(), schema::scattering_profile(scope.variables)});
    }
    Words words() const override {
        const std::string type = "[scattering profile](params.md#scattering-profiles)";
        return {.type = type, .noun = type, .nouns = type};
    }
};

}  // namespace

Form scattering_profile() {
    return make_form<ScatteringForm>();
}

}  // namespace aftershade::grammar
