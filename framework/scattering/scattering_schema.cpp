#include "framework/scattering/scattering_schema.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "framework/scattering/scattering_profile.h"

namespace aftershade::schema {

namespace {

/// The four types' keys, each an object of its own.
class ProfileForms {
public:
    ProfileForms(Variables variables, json head) : variables_(variables), head_(std::move(head)) {}

    json all(const std::vector<std::string>& head_required) const {
        json length = rgb(number(ScatteringProfile::kLeastLength_mm, ScatteringProfile::kMostLength_mm));
        const json share = number(0, 1);
        return any_of({
            form("burley", {{"d_mm", said(length, "Burley's d of red, green and blue, mm.")}}, {"d_mm"},
                 head_required),
            form("burley",
                 {{"albedo", said(rgb(share), "Of the surface.")},
                  {"mean_free_path_mm", said(length, "Of red, green and blue, mm.")},
                  {"mapping",
                   said(part(one_of({"searchlight", "diffuse", "dmfp"})),
                        "What the path is: of light that enters at right angles, from all around, or the "
                        "diffuse mean free path in the volume (the usual).")}},
                 {"albedo", "mean_free_path_mm"}, head_required),
            form("gaussians",
                 {{"gaussians", part(array_of(part(gaussian()), 1, int(ScatteringProfile::kMaxGaussians)))}},
                 {"gaussians"}, head_required),
            form("dipole",
                 {{"absorption_per_mm",
                   said(rgb(number(ScatteringProfile::kLeastAbsorption, ScatteringProfile::kMostAbsorption)),
                        "sigma_a, 1/mm.")},
                  {"reduced_scattering_per_mm",
                   said(rgb(number(ScatteringProfile::kLeastAbsorption, ScatteringProfile::kMostScattering)),
                        "sigma_s', 1/mm.")},
                  {"ior", said(part(number(1, 3)), "Index of refraction, 1.3 unless told.")}},
                 {"absorption_per_mm", "reduced_scattering_per_mm"}, head_required),
            form("artist",
                 {{"falloff", said(rgb(share), "How far each channel's light goes, of the width.")},
                  {"strength", said(rgb(number(ScatteringProfile::kLeastStrength, 1)),
                                    "The share of the light that is scattered at all.")},
                  {"width_mm",
                   said(part(number(ScatteringProfile::kLeastLength_mm, ScatteringProfile::kMostLength_mm)),
                        "What a falloff of 1 is, mm.")}},
                 {}, head_required),
        });
    }

private:
    json part(json form) const {
        return variables_ == Variables::yes ? any_of({std::move(form), variable()}) : form;
    }

    static json number(double min, double max) {
        return {{"type", "number"}, {"minimum", min}, {"maximum", max}};
    }

    static json said(json form, const char* description) {
        form["description"] = description;
        return form;
    }

    /// Three numbers, or one for all channels.
    json rgb(const json& each) const { return part(any_of({each, array_of(part(each), 3, 3)})); }

    json gaussian() const {
        const double least = ScatteringProfile::kLeastLength_mm, most = ScatteringProfile::kMostLength_mm;
        return object({{"variance_mm2", rgb(number(least * least, most * most))},
                       {"weight", said(rgb(number(0, 1)), "Those of a channel sum to 1.")}},
                      {"variance_mm2", "weight"});
    }

    json form(const char* type, const json& keys, std::vector<std::string> required,
              const std::vector<std::string>& head_required) const {
        json properties = head_;
        properties["type"] = {{"const", type}};
        properties.update(keys);
        required.insert(required.begin(), "type");
        required.insert(required.begin(), head_required.begin(), head_required.end());
        return object(std::move(properties), std::move(required));
    }

    Variables variables_;
    json head_;
};

}  // namespace

json scattering_profile(Variables variables) {
    return ProfileForms(variables, json::object()).all({});
}

std::string scattering_profile_schema() {
    const json head = {{"$schema", text()},
                       {"aftershade", {{"const", 1}, {"description", "Version of the format."}}},
                       {"summary", text()},
                       {"sources", array_of(text())}};
    json result = {{"$schema", kDraft}, {"title", "Aftershade scattering profile"}};
    result.update(ProfileForms(Variables::no, head).all({"aftershade", "summary"}));
    return result.dump(2) + "\n";
}

}  // namespace aftershade::schema
