// Scattering profiles from text, for the tests that read them.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "framework/scattering/scattering_profile.h"
#include "tests/documents.h"

namespace aftershade::test {

/// The test fails where the text has faults.
inline ScatteringProfile profile_of(const std::string& text) {
    Diagnostics diagnostics;
    const auto profile = parse_scattering_profile(parsed(text), "p", ".", diagnostics);
    EXPECT_EQ(lines_of(diagnostics), Lines{}) << text;
    return profile.value_or(ScatteringProfile{});
}

inline ScatteringProfile shipped_skin() {
    return profile_of("\"skin\"");
}

/// Jensen's R_d(r) as the paper has it, with alpha', and its total.
struct Jensen {
    double absorption, scattering, ior;
    double extinction() const { return absorption + scattering; }
    double albedo() const { return scattering / extinction(); }
    double boundary() const {
        const double f = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
        return (1 + f) / (1 - f);
    }
    double profile(double r) const {
        const double s = std::sqrt(3 * absorption * extinction());
        const double zr = 1 / extinction(), zv = zr * (1 + 4 * boundary() / 3);
        const double dr = std::sqrt(r * r + zr * zr), dv = std::sqrt(r * r + zv * zv);
        return albedo() / (4 * std::numbers::pi) *
               (zr * (s * dr + 1) * std::exp(-s * dr) / std::pow(dr, 3) +
                zv * (s * dv + 1) * std::exp(-s * dv) / std::pow(dv, 3));
    }
    double total() const {
        const double s = std::sqrt(3 * (1 - albedo()));
        return albedo() / 2 * (1 + std::exp(-4.0 / 3 * boundary() * s)) * std::exp(-s);
    }
};

}  // namespace aftershade::test
