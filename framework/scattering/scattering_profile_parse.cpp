// Profiles as documents.
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "framework/base/data_path.h"
#include "framework/base/path_bounds.h"
#include "framework/base/text.h"
#include "framework/document/grammar_reader.h"
#include "framework/document/units.h"
#include "framework/scattering/scattering_grammar.h"
#include "framework/scattering/scattering_profile.h"

namespace aftershade {

namespace fs = std::filesystem;
using grammar::Reader;
using Type = ScatteringProfile::Type;

namespace {

fs::path shipped_folder() {
    return data_path() / "profiles" / "scattering";
}

Rgb rgb(const Reader& reader, const char* key) {
    const std::vector<double> values = reader.components(key);
    return {values[0], values[1], values[2]};
}

Rgb burley_d(const Reader& reader) {
    if (reader.has("d_mm")) return rgb(reader, "d_mm");
    const Rgb path = rgb(reader, "mean_free_path_mm"), albedo = rgb(reader, "albedo");
    const auto mapping = reader.choice<BurleyMapping>("mapping");
    Rgb d{};
    for (std::size_t c = 0; c < d.size(); ++c) d[c] = burley_d_mm(mapping, albedo[c], path[c]);
    return d;
}

/// Weights that nearly sum to 1 do so afterwards.
void normalize(std::vector<ScatteringGaussian>& gaussians, const Reader& reader, const std::string& label,
               Diagnostics& diagnostics) {
    constexpr double kSumTolerance = 0.01;
    constexpr const char* kChannels[] = {"red", "green", "blue"};
    for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (const ScatteringGaussian& gaussian : gaussians) sum += gaussian.weight[c];
        if (std::abs(sum - 1) > kSumTolerance)
            diagnostics.error(reader.place("gaussians"), label + ": the weights of " + kChannels[c] +
                                                             " sum to " + format_number(sum) +
                                                             " but must sum to 1: a profile has no albedo");
        for (ScatteringGaussian& gaussian : gaussians) gaussian.weight[c] /= sum;
    }
}

/// Jimenez' falloff and strength as his Gaussians.
void read_artist(const Reader& reader, ScatteringProfile& profile) {
    const Rgb falloff = rgb(reader, "falloff"), strength = rgb(reader, "strength");
    profile.width_mm = reader.number("width_mm");
    profile.gaussians.assign(artist_gaussians().size(), {});
    for (std::size_t c = 0; c < 3; ++c) {
        // His 0.001 keeps a falloff of 0 above 0.
        profile.falloff_mm[c] = profile.width_mm * (0.001 + falloff[c]);
        profile.direct[c] = 1 - strength[c];
        for (std::size_t k = 0; k < profile.gaussians.size(); ++k) {
            const auto& [variance, weight] = artist_gaussians()[k];
            profile.gaussians[k].variance_mm2[c] = variance * profile.falloff_mm[c] * profile.falloff_mm[c];
            profile.gaussians[k].weight[c] = strength[c] * weight;
        }
    }
}

/// The values of a profile whose grammar is sound.
ScatteringProfile profile_of(const Reader& reader, const std::string& label, Diagnostics& diagnostics) {
    ScatteringProfile profile;
    const auto& names = scattering_type_names();
    profile.type = Type(std::find(names.begin(), names.end(), reader.kind()) - names.begin());
    switch (profile.type) {
        case Type::burley: profile.d_mm = burley_d(reader); break;
        case Type::gaussians:
            for (const Reader& gaussian : reader.objects("gaussians"))
                profile.gaussians.push_back({rgb(gaussian, "variance_mm2"), rgb(gaussian, "weight")});
            normalize(profile.gaussians, reader, label, diagnostics);
            break;
        case Type::dipole:
            profile.absorption = rgb(reader, "absorption_per_mm");
            profile.scattering = rgb(reader, "reduced_scattering_per_mm");
            profile.ior = reader.number("ior");
            break;
        case Type::artist: read_artist(reader, profile); break;
    }
    return profile;
}

/// An object, or a file's document. nullopt after errors.
std::optional<ScatteringProfile> read_profile(const Node& node, const grammar::Block& block,
                                              const std::string& label, Diagnostics& diagnostics) {
    const int errors_before = diagnostics.error_count();
    if (!grammar::check(node, block, diagnostics, block.is_document ? "" : label)) return std::nullopt;
    ScatteringProfile profile = profile_of(Reader(node, block), label, diagnostics);
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return profile;
}

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
    static const std::vector<std::string> names = [] {
        std::vector<std::string> made;
        for (const grammar::Block& kind : scattering_profile_block().kinds) made.push_back(kind.name);
        return made;
    }();
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
    if (node.is_object()) return read_profile(node, scattering_object_block(), label, diagnostics);
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
    // A plain name is of a shipped file, which every document may name.
    const std::string reason = is_snake_case(node.string) ? "" : FileRule::why_not(path);
    if (!reason.empty()) {
        diagnostics.error(node.place, label + ": '" + node.string + "' " + reason);
        return std::nullopt;
    }
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
    const grammar::Block& block = scattering_profile_block();
    auto profile = read_profile(*document, block, "the scattering profile", diagnostics);
    if (!profile) return std::nullopt;
    const Reader reader(*document, block);
    profile->name = node.string;
    profile->summary = reader.text("summary");
    profile->sources = reader.texts("sources");
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
