#include "framework/scattering/scattering_grammar.h"

#include <nlohmann/json.hpp>

#include "framework/document/grammar_form.h"
#include "framework/document/grammar_schema.h"
#include "framework/scattering/scattering_profile.h"

namespace aftershade {

using grammar::Block;
using grammar::choice;
using grammar::Form;
using grammar::list;
using grammar::number;
using grammar::object;
using grammar::optional;
using grammar::required;
using grammar::text;

namespace {

constexpr double kLeastLength_mm = ScatteringProfile::kLeastLength_mm;
constexpr double kMostLength_mm = ScatteringProfile::kMostLength_mm;

/// Three numbers for red, green and blue, or one for all. Units stand in the names of keys.
Form rgb(double min, double max) {
    ParamSpec spec;
    spec.type = ParamType::vec3;
    spec.min = min;
    spec.max = max;
    return grammar::literal(spec, {.uniform = true});
}

Form length_mm() {
    return rgb(kLeastLength_mm, kMostLength_mm);
}

Block burley() {
    return {.name = "burley",
            .doc =
                "Normalized diffusion (Christensen and Burley 2015): R(r) = (exp(-r/d) + exp(-r/3d)) / (8 "
                "pi d r), of 'd_mm', or of 'albedo' and 'mean_free_path_mm', d = path / s(albedo).",
            .keys = {optional("d_mm", length_mm(), "d in mm."),
                     optional("albedo", rgb(0, 1), "Albedo of the surface."),
                     optional("mean_free_path_mm", length_mm(), "Path in mm, from which 'mapping' makes d."),
                     optional("mapping", choice({"searchlight", "diffuse", "dmfp"}),
                              "Meaning of the path: mean free path of light that enters at right angles, of "
                              "light from all around, or the diffuse mean free path in the volume.",
                              R"("dmfp")")},
            .rules = {grammar::exactly_one_of({"d_mm", "mean_free_path_mm"}),
                      grammar::together({"albedo", "mean_free_path_mm"}),
                      grammar::needs("mapping", "mean_free_path_mm")}};
}

Block gaussian() {
    return {.name = "",
            .keys = {required("variance_mm2",
                              rgb(kLeastLength_mm * kLeastLength_mm, kMostLength_mm * kMostLength_mm),
                              "In mm^2."),
                     required("weight", rgb(0, 1), "Share of the light. A channel's weights sum to 1.")},
            .type = "{ `variance_mm2`, `weight` }"};
}

Block gaussians() {
    constexpr int kMost = int(ScatteringProfile::kMaxGaussians);
    return {
        .name = "gaussians",
        .doc = "A sum of Gaussians over the plane (d'Eon and Luebke 2007).",
        .keys = {required("gaussians", list(object(gaussian()), {.min = 1, .max = kMost}),
                          "Each has 'variance_mm2' and 'weight', for each channel or for all. A channel's "
                          "weights sum to 1.")}};
}

Block dipole() {
    const double least = ScatteringProfile::kLeastAbsorption;
    return {.name = "dipole",
            .doc = "A dipole of light sources (Jensen and others 2001), over its total.",
            .keys = {required("absorption_per_mm", rgb(least, ScatteringProfile::kMostAbsorption),
                              "Absorption coefficient sigma_a, 1/mm."),
                     required("reduced_scattering_per_mm", rgb(least, ScatteringProfile::kMostScattering),
                              "Reduced scattering coefficient sigma_s', 1/mm."),
                     optional("ior", number({.min = 1, .max = 3}), "Index of refraction.", "1.3")}};
}

Block artist() {
    return {
        .name = "artist",
        .doc = "Falloff and strength by channel (Jimenez and others 2015).",
        .keys = {optional("falloff", rgb(0, 1), "How far a channel's light spreads, as a share of the width.",
                          "[1, 0.37, 0.3]"),
                 optional("strength", rgb(ScatteringProfile::kLeastStrength, 1),
                          "Share of the light that scatters. The rest leaves where it entered.",
                          "[0.48, 0.41, 0.28]"),
                 optional("width_mm", number({.min = kLeastLength_mm, .max = kMostLength_mm}),
                          "Width in mm that a falloff of 1 stands for.", "1")}};
}

Block profile() {
    return {.name = "scattering_profile",
            .doc = "How one material scatters light.",
            .selector = "type",
            .kinds = {burley(), gaussians(), dipole(), artist()}};  // as ScatteringProfile::Type has them
}

Block document() {
    Block block = profile();
    block.thing = "the scattering profile";
    block.is_document = true;
    block.keys = {required("summary", text(), "One sentence on the material."),
                  optional("sources", list(text()), "Where its numbers come from.")};
    return block;
}

}  // namespace

const Block& scattering_profile_block() {
    static const Block block = document();
    return block;
}

const Block& scattering_object_block() {
    static const Block block = profile();
    return block;
}

std::string scattering_profile_schema() {
    return grammar::schema_text("Aftershade scattering profile", scattering_profile_block());
}

}  // namespace aftershade

namespace aftershade::grammar {

namespace {

class ScatteringForm : public FormType {
public:
    bool takes(Node::Kind) const override { return true; }
    void check(const Node&, const Spot&, Diagnostics&) const override {}
    schema::json schema(SchemaScope& scope) const override {
        return schema::any_of({schema::text(), scope.of(scattering_object_block())});
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
