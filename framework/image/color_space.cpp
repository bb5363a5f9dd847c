#include "framework/image/color_space.h"

#include <cmath>
#include <cstdlib>
#include <utility>

#include "framework/base/error.h"
#include "framework/image/luminance.h"

namespace aftershade {

namespace {

struct NamedPrimaries {
    std::string_view name;
    Chromaticities primaries;
};

/// ITU-R BT.709 and BT.2020; SMPTE ST 2065-1 (AP0); Academy S-2014-004 (ACEScg, AP1); P3 of SMPTE RP 431-2
/// with the white of D65.
constexpr std::array kSpaces = {
    NamedPrimaries{"rec709", kRec709},
    NamedPrimaries{"acescg", {0.713f, 0.293f, 0.165f, 0.830f, 0.128f, 0.044f, 0.32168f, 0.33767f}},
    NamedPrimaries{"ap0", {0.7347f, 0.2653f, 0.0f, 1.0f, 0.0001f, -0.0770f, 0.32168f, 0.33767f}},
    NamedPrimaries{"rec2020", {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f}},
    NamedPrimaries{"p3d65", {0.680f, 0.320f, 0.265f, 0.690f, 0.150f, 0.060f, 0.3127f, 0.3290f}},
};

using Vector = std::array<double, 3>;

ColorMatrix multiply(const ColorMatrix& a, const ColorMatrix& b) {
    ColorMatrix product{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            for (std::size_t k = 0; k < 3; ++k)
                product[row * 3 + column] += a[row * 3 + k] * b[k * 3 + column];
    return product;
}

Vector multiply(const ColorMatrix& m, const Vector& v) {
    Vector product{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t k = 0; k < 3; ++k) product[row] += m[row * 3 + k] * v[k];
    return product;
}

ColorMatrix inverse(const ColorMatrix& m) {
    const auto cofactor = [&m](int row, int column) {
        const auto at = [&](int i, int j) { return m[std::size_t(((row + i) % 3) * 3 + (column + j) % 3)]; };
        return at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1);
    };
    const double determinant = m[0] * cofactor(0, 0) + m[1] * cofactor(0, 1) + m[2] * cofactor(0, 2);
    if (std::abs(determinant) < 1e-9)
        throw Error(ErrorKind::capture, "chromaticities: the primaries lie on one line");
    ColorMatrix result{};
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            result[std::size_t(row * 3 + column)] = cofactor(column, row) / determinant;
    return result;
}

Vector xyz_of_xy(double x, double y) {
    if (y == 0) throw Error(ErrorKind::capture, "chromaticities: the white has y = 0");
    return {x / y, 1, (1 - x - y) / y};
}

/// Lindbloom: the columns are the primaries' XYZ, scaled so that (1, 1, 1) is white.
ColorMatrix xyz_from_rgb(const Chromaticities& p) {
    ColorMatrix columns{};
    for (std::size_t i = 0; i < 3; ++i) {
        columns[i] = p[2 * i];
        columns[3 + i] = p[2 * i + 1];
        columns[6 + i] = 1 - double(p[2 * i]) - double(p[2 * i + 1]);
    }
    const Vector scale = multiply(inverse(columns), xyz_of_xy(p[6], p[7]));
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t i = 0; i < 3; ++i) columns[row * 3 + i] *= scale[i];
    return columns;
}

ColorMatrix adaptation(const Chromaticities& from, const Chromaticities& to) {
    if (is_xyz(from) || is_xyz(to)) return {1, 0, 0, 0, 1, 0, 0, 0, 1};
    constexpr ColorMatrix kBradford = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135,
                                       0.0367, 0.0389, -0.0685, 1.0296};
    const Vector source = multiply(kBradford, xyz_of_xy(from[6], from[7]));
    const Vector target = multiply(kBradford, xyz_of_xy(to[6], to[7]));
    ColorMatrix scale{};
    for (std::size_t i = 0; i < 3; ++i) scale[i * 4] = target[i] / source[i];
    return multiply(inverse(kBradford), multiply(scale, kBradford));
}

}  // namespace

std::optional<Chromaticities> color_space_primaries(std::string_view name) {
    for (const NamedPrimaries& space : kSpaces)
        if (space.name == name) return space.primaries;
    return std::nullopt;
}

std::vector<std::string> color_space_names() {
    std::vector<std::string> names;
    for (const NamedPrimaries& space : kSpaces) names.emplace_back(space.name);
    return names;
}

std::string name_of_primaries(const Chromaticities& primaries) {
    for (const NamedPrimaries& space : kSpaces) {
        bool equal = true;
        for (std::size_t i = 0; i < primaries.size(); ++i)
            equal = equal && std::abs(primaries[i] - space.primaries[i]) <= 0.0005f;
        if (equal) return std::string(space.name);
    }
    return "";
}

bool is_xyz(const Chromaticities& p) {
    return p[0] == 1 && p[1] == 0 && p[2] == 0 && p[3] == 1 && p[4] == 0 && p[5] == 0;
}

ColorMatrix conversion_matrix(const Chromaticities& from, const Chromaticities& to) {
    if (from == to) return {1, 0, 0, 0, 1, 0, 0, 0, 1};  // to the last bit
    const ColorMatrix xyz = multiply(adaptation(from, to), xyz_from_rgb(from));
    return multiply(inverse(xyz_from_rgb(to)), xyz);
}

std::array<double, 3> luminance_weights(const Chromaticities& primaries) {
    const ColorMatrix to_rec709 = conversion_matrix(primaries, kRec709);
    std::array<double, 3> weights{};
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 3; ++column)
            weights[column] += kRec709Luminance[row] * to_rec709[row * 3 + column];
    return weights;
}

void convert_colors(Image& image, const ColorMatrix& matrix) {
    const std::span<float> values = image.floats();
    for (std::size_t i = 0; i + 2 < values.size(); i += std::size_t(image.channels())) {
        const Vector rgb = multiply(matrix, Vector{values[i], values[i + 1], values[i + 2]});
        for (std::size_t c = 0; c < 3; ++c) values[i + c] = float(rgb[c]);
    }
}

}  // namespace aftershade
