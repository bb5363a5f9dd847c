// How one material scatters light: the share of the light that enters at a point and comes out around it, by
// distance, for red, green and blue. The albedo is not in it: all shares of a channel sum to 1.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"
#include "framework/document/document.h"

namespace aftershade {

using Rgb = std::array<double, 3>;

/// One of a sum of Gaussians over the plane: weight / (2 pi variance) * exp(-r^2 / (2 variance)).
struct ScatteringGaussian {
    Rgb variance_mm2{};
    Rgb weight{};
    bool operator==(const ScatteringGaussian&) const = default;
};

/// A material's profile. Values are mm, mm^2 and 1/mm. Channels are 0 to 2.
struct ScatteringProfile {
    enum class Type {
        burley,     ///< normalized diffusion: Christensen and Burley 2015, Pixar technical memo 15-04
        gaussians,  ///< a sum of Gaussians: d'Eon and Luebke 2007, GPU Gems 3 chapter 14
        dipole,     ///< Jensen, Marschner, Levoy, Hanrahan 2001, doi:10.1145/383259.383319
        artist      ///< falloff and strength: Jimenez et al. 2015, doi:10.1111/cgf.12529, his published code
    };

    std::string name;     ///< as written: "skin", a path; "" of one that stands in the document itself
    std::string summary;  ///< of a file
    std::vector<std::string> sources;
    Type type = Type::burley;
    Rgb d_mm{};                                 ///< burley
    std::vector<ScatteringGaussian> gaussians;  ///< gaussians and artist
    Rgb direct{};         ///< artist: the share that comes out where it went in, 1 - strength
    Rgb falloff_mm{};     ///< artist: what its radii are divided by, width times 0.001 + falloff
    double width_mm = 1;  ///< artist
    Rgb absorption{};     ///< dipole: sigma_a, 1/mm
    Rgb scattering{};     ///< dipole: reduced scattering sigma_s', 1/mm
    double ior = 1.3;     ///< dipole

    bool operator==(const ScatteringProfile&) const = default;

    /// Share per mm^2 at a distance above 0; without what is `direct`. Its integral over the plane is 1 -
    /// direct.
    double density(int channel, double radius_mm) const;
    /// Share within a distance, `direct` included: the CDF of the radius.
    double within(int channel, double radius_mm) const;
    /// The distance within which a share, 0 to below 1, comes out; 0 where so much is direct.
    double radius_mm(int channel, double share) const;
    /// The light of a line at a distance above 0 from it, 1/mm; without what is direct. Its integral over
    /// both sides is 1 - direct.
    double line_spread(int channel, double x_mm) const;
    /// Mean square distance of what is not direct, mm^2.
    double mean_square_mm2(int channel) const;
    /// d of the Burley profile with that mean square distance, 14 d^2; its own d for burley.
    Rgb fitted_d_mm() const;
    /// The divisor of an artist's radii for that mean square distance; artist: its own.
    Rgb fitted_falloff_mm() const;
    /// Beyond it lies less than kBeyondReach of the light of any channel.
    double reach_mm() const;
    static constexpr double kBeyondReach = 1e-4;

    /// Its own Gaussians; of burley and dipole kFittedGaussians fitted to each channel by expectation
    /// maximization (Dempster, Laird, Rubin 1977), which keeps the sum of weights and the mean square
    /// distance.
    std::vector<ScatteringGaussian> as_gaussians() const;
    static constexpr int kFittedGaussians = 6;
    static constexpr std::size_t kMaxGaussians = 8;

    // Limits of documents: d, mean free paths and widths; both coefficients of a dipole, 1/mm, below
    // which light would never stop; and an artist's strength.
    static constexpr double kLeastLength_mm = 1e-6, kMostLength_mm = 1e6;
    static constexpr double kLeastAbsorption = 1e-5, kMostAbsorption = 1e3, kMostScattering = 1e4;
    static constexpr double kLeastStrength = 0.001;
};

/// "burley", "gaussians", "dipole", "artist".
const std::vector<std::string>& scattering_type_names();

/// Jimenez' artist profile at radii over falloff: the five wider Gaussians of skin with their weights for
/// red, over their sum; variances over falloff^2.
const std::vector<std::array<double, 2>>& artist_gaussians();

/// Samples of a profile for shaders, at radii reach * (i / (kScatteringSamples - 1))^2. Each is
/// kScatteringSamples long.
struct ScatteringCurves {
    std::vector<Rgb> radial;  ///< 2 pi r density(r), 1/mm: share per radius; its limit at r = 0
    std::vector<Rgb> within;
    std::vector<Rgb> line;  ///< edge response: the light at a distance x into the lit side of a straight
                            ///< edge, the limit at 0, (1 + direct) / 2, to almost 1
};
inline constexpr int kScatteringSamples = 1024;
ScatteringCurves scattering_curves(const ScatteringProfile& profile);

/// Reads a profile: the name of a shipped one ("skin": profiles/scattering/skin.json of the data folder), the
/// path of a file that ends in .json, relative to `folder`, or the profile itself as an object. `label` names
/// it in messages. nullopt after errors, which name all that is wrong.
std::optional<ScatteringProfile> parse_scattering_profile(const Node& node, const std::string& label,
                                                          const std::filesystem::path& folder,
                                                          Diagnostics& diagnostics);
/// As a document would write it: its name in quotes, else an object; one line.
std::string format_scattering_profile(const ScatteringProfile& profile);
/// Names of the shipped profiles, sorted.
std::vector<std::string> scattering_profile_names();

/// Burley's d of one channel: mean free path / s(albedo) (Christensen and Burley 2015; glsl/burley.glsl says
/// the same). searchlight and diffuse: the path is the mean free path, for light that enters at right angles
/// or from all around; dmfp: the diffuse mean free path in the volume.
enum class BurleyMapping { searchlight, diffuse, dmfp };
double burley_d_mm(BurleyMapping mapping, double albedo, double mean_free_path_mm);

}  // namespace aftershade
