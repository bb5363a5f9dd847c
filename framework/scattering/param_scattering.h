// The parameter type scattering_profile: how light scatters, by object.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "framework/document/param.h"
#include "framework/scattering/scattering_profile.h"

namespace aftershade {

/// Profiles by object; an object that no row names has the usual one. A ParamValue holds it as an
/// OpaqueValue.
struct ScatteringValue final : ValueContent {
    ScatteringProfile usual;
    std::vector<std::pair<TableKey, ScatteringProfile>> rows;  ///< no id and no name twice

    bool equals(const ValueContent& other) const override;
    std::string text() const override;
};
inline constexpr std::size_t kMaxScatteringRows = 1024;

/// nullptr where the value is of another type. The value owns what it returns.
const ScatteringValue* scattering_of(const ParamValue& value);

/// The different profiles of a value, the usual one first.
std::vector<ScatteringProfile> scattering_profiles_of(const ScatteringValue& value);
/// Whether each of them is Burley's: shaders then compute it without tables.
bool is_burley(const ScatteringValue& value);
/// The table that shaders look up by object: rows of the type's columns (index among
/// scattering_profiles_of(); d and falloff, mm, own or fitted; direct; reach, mm).
TableValue scattering_table(const ScatteringValue& value);

/// Shaders have, of a parameter "scattering_profile", a sampler2D scattering_profile_curves and:
///
///     ScatteringProfileRow scattering_profile(uint object_id)       index, d, direct, falloff, reach; mm
///     vec3 scattering_profile_radial(ScatteringProfileRow, float r) 2 pi r R(r), 1/mm; 0 beyond its reach
///     vec3 scattering_profile_within(ScatteringProfileRow, float r) share within r
///     vec3 scattering_profile_line(ScatteringProfileRow, float x)   edge response, x >= 0 into the lit side
///     vec3 scattering_profile_variance(ScatteringProfileRow, int k) of its Gaussian k, mm^2
///     vec3 scattering_profile_weight(ScatteringProfileRow, int k)   0 for those that it lacks
///     SCATTERING_PROFILE_GAUSSIANS                                  how many k there are
///     SCATTERING_PROFILE_IS_BURLEY                                  1: each profile is Burley's with its d,
///     else 0
///
/// Interpolation is linear between kScatteringSamples radii.
extern const ParamType kScatteringParam;

/// Rows of the texture for each of the value's profiles; it is kScatteringSamples wide, rgba32f.
inline constexpr int kScatteringRows = 4;

}  // namespace aftershade
