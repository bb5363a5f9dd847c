// Profiles as documents.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/core/data_path.h"
#include "framework/core/text.h"
#include "framework/core/units.h"
#include "framework/scattering/scattering_profile.h"

namespace aftershade {

namespace fs = std::filesystem;
using Presence = ObjectReader::Presence;
using Type = ScatteringProfile::Type;

namespace {

const std::vector<std::string> kMappings = {"searchlight", "diffuse", "dmfp"};

fs::path shipped_folder() {
    return data_path() / "profiles" / "scattering";
}

/// Reads the keys of one profile; every fault is told with its place.
class ProfileReader {
public:
    ProfileReader(const Node& node, std::string label, Diagnostics& diagnostics)
        : node_(node),
          label_(std::move(label)),
          reader_(node, label_, diagnostics),
          diagnostics_(diagnostics) {}

    std::optional<ScatteringProfile> read(bool is_file) {
        const int errors_before = diagnostics_.error_count();
        if (is_file) {
            check_document_version(reader_, node_, diagnostics_);
            reader_.text("$schema");
            profile_.summary = reader_.text("summary", Presence::required).value_or("");
            profile_.sources = reader_.texts("sources");
        }
        const auto type = reader_.choice("type", scattering_type_names(), Presence::required);
        if (!type) return std::nullopt;
        const auto& names = scattering_type_names();
        profile_.type = Type(std::find(names.begin(), names.end(), *type) - names.begin());
        switch (profile_.type) {
            case Type::burley: read_burley(); break;
            case Type::gaussians: read_gaussians(); break;
            case Type::dipole: read_dipole(); break;
            case Type::artist: read_artist(); break;
        }
        reader_.finish();
        if (diagnostics_.error_count() > errors_before) return std::nullopt;
        return std::move(profile_);
    }

private:
    void fault(const Node& node, const std::string& text) {
        diagnostics_.error(node.place, label_ + ": " + text);
    }

    std::optional<double> number(const Node& node, const std::string& what, double min, double max) {
        if (!node.is_number())
            fault(node, what + ": expected a number, not " + std::string(kind_name(node.kind)));
        else if (node.number < min || node.number > max)
            fault(node, what + ": " + format_number(node.number) + " is not within " + format_number(min) +
                            " and " + format_number(max));
        else return node.number;
        return std::nullopt;
    }

    /// Three numbers, or one for all channels.
    std::optional<Rgb> rgb(const Node& node, const std::string& what, double min, double max) {
        Rgb result{};
        if (node.is_number()) {
            const auto value = number(node, what, min, max);
            if (!value) return std::nullopt;
            result.fill(*value);
            return result;
        }
        if (!node.is_array() || node.items.size() != 3) {
            fault(node, what + ": expected three numbers, for red, green and blue, or one for all");
            return std::nullopt;
        }
        bool whole = true;
        for (std::size_t c = 0; c < 3; ++c) {
            const auto value = number(node.items[c], what, min, max);
            whole = whole && value;
            result[c] = value.value_or(0);
        }
        return whole ? std::optional(result) : std::nullopt;
    }

    Rgb rgb(const std::string& key, double min, double max, Presence presence, Rgb usual = {}) {
        const Node* node = reader_.any(key, presence);
        return node ? rgb(*node, key, min, max).value_or(usual) : usual;
    }

    void read_burley() {
        if (node_.find("d_mm")) {
            for (const char* key : {"albedo", "mean_free_path_mm", "mapping"})
                if (const Node* other = reader_.any(key))
                    fault(*other, "'" + std::string(key) + "' cannot stand beside 'd_mm', which says it all");
            profile_.d_mm = rgb("d_mm", kLeastLength_mm, kMostLength_mm, Presence::required);
            return;
        }
        const Rgb path = rgb("mean_free_path_mm", kLeastLength_mm, kMostLength_mm, Presence::required);
        const Rgb albedo = rgb("albedo", 0, 1, Presence::required);
        const std::string mapping = reader_.choice("mapping", kMappings).value_or("dmfp");
        const auto kind =
            BurleyMapping(std::find(kMappings.begin(), kMappings.end(), mapping) - kMappings.begin());
        for (std::size_t c = 0; c < 3; ++c) profile_.d_mm[c] = burley_d_mm(kind, albedo[c], path[c]);
    }

    void read_gaussians() {
        const Node* list = reader_.array("gaussians", Presence::required);
        if (!list) return;
        if (list->items.empty() || list->items.size() > ScatteringProfile::kMaxGaussians) {
            fault(*list, "'gaussians' holds 1 to " + std::to_string(ScatteringProfile::kMaxGaussians) +
                             " Gaussians, not " + std::to_string(list->items.size()));
            return;
        }
        Rgb sum{};
        const int errors_before = diagnostics_.error_count();
        for (std::size_t i = 0; i < list->items.size(); ++i) {
            const std::string which = "gaussians[" + std::to_string(i) + "]";
            ObjectReader reader(list->items[i], label_ + "." + which, diagnostics_);
            if (!reader.is_object()) continue;
            ScatteringGaussian gaussian;
            const Node* variance = reader.any("variance_mm2", Presence::required);
            const Node* weight = reader.any("weight", Presence::required);
            if (variance)
                gaussian.variance_mm2 =
                    rgb(*variance, which + ".variance_mm2", kLeastLength_mm * kLeastLength_mm,
                        kMostLength_mm * kMostLength_mm)
                        .value_or(Rgb{1, 1, 1});
            if (weight) gaussian.weight = rgb(*weight, which + ".weight", 0, 1).value_or(Rgb{});
            reader.finish();
            for (std::size_t c = 0; c < 3; ++c) sum[c] += gaussian.weight[c];
            profile_.gaussians.push_back(gaussian);
        }
        if (diagnostics_.error_count() > errors_before) return;
        for (std::size_t c = 0; c < 3; ++c) {
            if (std::abs(sum[c] - 1) > kSumTolerance)
                fault(*list, "the weights of " + std::string(kChannels[c]) + " sum to " +
                                 format_number(sum[c]) + ", not to 1: a profile has no albedo");
            for (ScatteringGaussian& gaussian : profile_.gaussians) gaussian.weight[c] /= sum[c];
        }
    }

    void read_dipole() {
        const double least = ScatteringProfile::kLeastAbsorption;
        profile_.absorption =
            rgb("absorption_per_mm", least, ScatteringProfile::kMostAbsorption, Presence::required);
        profile_.scattering =
            rgb("reduced_scattering_per_mm", least, ScatteringProfile::kMostScattering, Presence::required);
        if (const Node* ior = reader_.any("ior"))
            profile_.ior = number(*ior, "ior", 1, 3).value_or(profile_.ior);
    }

    void read_artist() {
        const Rgb falloff = rgb("falloff", 0, 1, Presence::optional, {1, 0.37, 0.3});
        const Rgb strength =
            rgb("strength", ScatteringProfile::kLeastStrength, 1, Presence::optional, {0.48, 0.41, 0.28});
        if (const Node* width = reader_.any("width_mm"))
            profile_.width_mm = number(*width, "width_mm", kLeastLength_mm, kMostLength_mm).value_or(1);
        profile_.gaussians.assign(artist_gaussians().size(), {});
        for (std::size_t c = 0; c < 3; ++c) {
            // His 0.001 keeps a falloff of 0 above 0.
            profile_.falloff_mm[c] = profile_.width_mm * (0.001 + falloff[c]);
            profile_.direct[c] = 1 - strength[c];
            for (std::size_t k = 0; k < profile_.gaussians.size(); ++k) {
                const auto& [variance, weight] = artist_gaussians()[k];
                profile_.gaussians[k].variance_mm2[c] =
                    variance * profile_.falloff_mm[c] * profile_.falloff_mm[c];
                profile_.gaussians[k].weight[c] = strength[c] * weight;
            }
        }
    }

    static constexpr double kLeastLength_mm = ScatteringProfile::kLeastLength_mm;
    static constexpr double kMostLength_mm = ScatteringProfile::kMostLength_mm;
    static constexpr double kSumTolerance = 0.01;
    static constexpr const char* kChannels[] = {"red", "green", "blue"};

    const Node& node_;
    const std::string label_;
    ObjectReader reader_;
    Diagnostics& diagnostics_;
    ScatteringProfile profile_;
};

/// A number from 0 to 1 without what arithmetic has left behind its twelfth digit.
double as_written(double value) {
    return std::round(value * 1e12) / 1e12;
}

std::string text_of(const Rgb& values) {
    return "[" + format_number(values[0]) + ", " + format_number(values[1]) + ", " +
           format_number(values[2]) + "]";
}

}  // namespace

const std::vector<std::string>& scattering_type_names() {
    static const std::vector<std::string> names = {"burley", "gaussians", "dipole", "artist"};
    return names;
}

std::vector<std::string> scattering_profile_names() {
    std::vector<std::string> names;
    std::error_code failure;
    for (const fs::directory_entry& entry : fs::directory_iterator(shipped_folder(), failure)) {
        const fs::path file = entry.path().filename();
        // profile.schema.json is no profile.
        if (file.extension() == ".json" && is_snake_case(file.stem().string()))
            names.push_back(file.stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

std::optional<ScatteringProfile> parse_scattering_profile(const Node& node, const std::string& label,
                                                          const fs::path& folder, Diagnostics& diagnostics) {
    if (node.is_object()) return ProfileReader(node, label, diagnostics).read(false);
    if (!node.is_string()) {
        diagnostics.error(
            node.place, label +
                            ": expected the name of a scattering profile, the path of its file or an object "
                            "with 'type', not " +
                            std::string(kind_name(node.kind)));
        return std::nullopt;
    }
    const bool is_path = node.string.ends_with(".json");
    const fs::path path = is_path ? folder / node.string : shipped_folder() / (node.string + ".json");
    std::error_code failure;
    if (!fs::is_regular_file(path, failure)) {
        const auto names = scattering_profile_names();
        diagnostics.error(node.place, is_path ? label + ": no file '" + path.string() + "'"
                                              : label + ": no scattering profile '" + node.string + "'" +
                                                    did_you_mean(node.string, names) +
                                                    "; shipped: " + list_of_names(names, "and") +
                                                    "; a file's name ends in .json");
        return std::nullopt;
    }
    const auto document = read_document(path, diagnostics);
    if (!document) return std::nullopt;
    auto profile = ProfileReader(*document, "the scattering profile", diagnostics).read(true);
    if (profile) profile->name = node.string;
    return profile;
}

std::string format_scattering_profile(const ScatteringProfile& profile) {
    if (!profile.name.empty()) return nlohmann::json(profile.name).dump();
    const std::string type = "{\"type\": \"" + scattering_type_names()[std::size_t(profile.type)] + "\", ";
    if (profile.type == Type::burley) return type + "\"d_mm\": " + text_of(profile.d_mm) + "}";
    if (profile.type == Type::dipole)
        return type + "\"absorption_per_mm\": " + text_of(profile.absorption) +
               ", \"reduced_scattering_per_mm\": " + text_of(profile.scattering) +
               ", \"ior\": " + format_number(profile.ior) + "}";
    if (profile.type == Type::artist) {
        Rgb falloff{}, strength{};
        for (std::size_t c = 0; c < 3; ++c) {
            falloff[c] = as_written(profile.falloff_mm[c] / profile.width_mm - 0.001);
            strength[c] = as_written(1 - profile.direct[c]);
        }
        return type + "\"falloff\": " + text_of(falloff) + ", \"strength\": " + text_of(strength) +
               ", \"width_mm\": " + format_number(profile.width_mm) + "}";
    }
    std::string list;
    for (const ScatteringGaussian& gaussian : profile.gaussians)
        list += (list.empty() ? "" : ", ") + std::string("{\"variance_mm2\": ") +
                text_of(gaussian.variance_mm2) + ", \"weight\": " + text_of(gaussian.weight) + "}";
    return type + "\"gaussians\": [" + list + "]}";
}

}  // namespace aftershade
