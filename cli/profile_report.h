// The text of `describe` for a scattering profile.
#pragma once

#include <optional>
#include <string>

#include "framework/scattering/scattering_profile.h"

namespace aftershade::cli {

/// A shipped profile by its name, or one by the path of its file, which ends in .json. nullopt for any other
/// word, and after errors.
std::optional<ScatteringProfile> find_profile(const std::string& what, Diagnostics& diagnostics);
std::string profile_text(const ScatteringProfile& profile);
std::string profile_json(const ScatteringProfile& profile);
/// An SVG of 2 pi r R(r), R(r), the share within a radius and the light of a line, by channel.
std::string profile_plot(const ScatteringProfile& profile);

}  // namespace aftershade::cli
