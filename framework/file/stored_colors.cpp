#include "framework/file/stored_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"

namespace aftershade {

namespace {

std::string remedy() {
    return " (choose with " + spelled(Option::color_space) + ", or \"color_space\" in capture.json)";
}

/// What one attribute says of the colours.
struct Statement {
    std::string attribute;
    std::string value;
    std::optional<ColorEncoding> encoding;  ///< nullopt where the value is not a known one
};

/// Producers write the id's name with another case.
Statement interop_id(const ExrMetadata& part) {
    for (const char* const name : {"colorInteropID", "colorInteropId"})
        if (const auto id = part.text(name); id && !id->empty()) return {name, *id, find_color_encoding(*id)};
    return {};
}

/// Whether there is light of every colour: three primaries apart from one another, and a white with light.
bool span_colors(const Chromaticities& xy) {
    const auto is_finite = [](float value) { return std::isfinite(value); };
    const float area = (xy[2] - xy[0]) * (xy[5] - xy[1]) - (xy[4] - xy[0]) * (xy[3] - xy[1]);
    return std::ranges::all_of(xy, is_finite) && xy[7] > 0 && std::abs(area) > 1e-6f;
}

/// "linear" and the like name no primaries, and light is what a file without the attribute has.
bool names_no_primaries(const std::string& space) {
    constexpr std::array<std::string_view, 6> kNames = {"",    "linear",  "scene_linear",
                                                        "lin", "default", "unknown"};
    return std::ranges::find(kNames, lower_case(space)) != kNames.end();
}

std::vector<Statement> statements_of(const ExrMetadata& metadata, const ExrMetadata& part) {
    std::vector<Statement> all;
    if (Statement id = interop_id(part); !id.value.empty()) all.push_back(std::move(id));
    if (metadata.number("acesImageContainerFlag") == 1.0)
        all.push_back({"acesImageContainerFlag", "1", find_color_encoding("lin_ap0_scene")});
    if (metadata.value("chromaticities")) {
        const ColorEncoding encoding{stored_primaries(metadata), ColorEncoding::Curve::linear, 1};
        const std::string name = name_of_primaries(encoding.primaries);
        if (span_colors(encoding.primaries))
            all.push_back({"chromaticities", name.empty() ? "primaries without a name" : name, encoding});
        else all.push_back({"chromaticities", fmt::format("{:.4g}", fmt::join(encoding.primaries, " ")), {}});
    }
    if (const auto space = metadata.text("oiio:ColorSpace"); space && !names_no_primaries(*space))
        all.push_back({"oiio:ColorSpace", *space, find_color_encoding(*space)});
    return all;
}

bool agree(const ColorEncoding& a, const ColorEncoding& b) {
    // Values of half a thousandth are rounding: writers have white as 0.3127 or 0.31271.
    for (std::size_t i = 0; i < a.primaries.size(); ++i)
        if (std::abs(a.primaries[i] - b.primaries[i]) > 0.0005f) return false;
    return a.curve == b.curve && a.gamma == b.gamma;
}

std::string said(const Statement& statement) {
    return statement.attribute + " is '" + statement.value + "'";
}

std::string name_of(const Statement& statement) {
    const std::string primaries = name_of_primaries(statement.encoding->primaries);
    return statement.encoding->is_light() && !primaries.empty() ? primaries
           : statement.attribute == "chromaticities"            ? ""
                                                                : statement.value;
}

std::string what_counts(const StoredColors& colors) {
    return colors.is_known() ? colors.source + " counts" : "the numbers are assumed to be Rec. 709";
}

void warn_of_data(const Statement& data, StoredColors& colors) {
    colors.warnings.push_back(said(data) + ", so color is read from channels that hold no colours; " +
                              what_counts(colors) + remedy());
}

}  // namespace

std::string StoredColors::text() const {
    const std::string space = name.empty() ? "primaries without a name" : name;
    return space + " (" + (is_known() ? source : "assumed") + ")";
}

std::string StoredColors::meaning() const {
    if (!unknown.empty()) return unknown;
    if (!encoding.is_light()) {
        const std::string id = encoding.is_color() ? color_interop_id(encoding) : "";
        return id.empty() ? name : id;
    }
    const std::string known = name_of_primaries(encoding.primaries);
    return known.empty() ? fmt::format("primaries {:.4f}", fmt::join(encoding.primaries, " ")) : known;
}

StoredColors stored_colors(const ExrMetadata& metadata, const ExrMetadata& part) {
    StoredColors colors;
    colors.name = "rec709";
    const std::vector<Statement> all = statements_of(metadata, part);
    const auto is_color = [](const Statement& s) {
        return s.encoding && s.encoding->curve != ColorEncoding::Curve::data;
    };
    const auto counts = std::find_if(all.begin(), all.end(), is_color);
    if (counts != all.end()) {
        colors.encoding = *counts->encoding;
        colors.name = name_of(*counts);
        colors.source = counts->attribute;
    }
    for (const Statement& other : all) {
        if (!other.encoding && !colors.is_known() && colors.unknown.empty() &&
            !names_no_primaries(other.value))
            colors.unknown = other.value;
        if (!other.encoding)
            colors.warnings.push_back(said(other) + ", which is not a known colour space; " +
                                      what_counts(colors) + remedy());
        else if (!is_color(other)) warn_of_data(other, colors);
        else if (!agree(*other.encoding, colors.encoding))
            colors.warnings.push_back(said(*counts) + ", but " + said(other) + "; " + counts->attribute +
                                      " counts" + remedy());
    }
    return colors;
}

StoredColors declared_colors(const std::string& space, const std::string& source) {
    StoredColors colors;
    colors.encoding.primaries = *color_space_primaries(space);
    colors.name = space;
    colors.source = source;
    colors.is_declared = true;
    return colors;
}

void light_of_stored(Image& image, const StoredColors& stored, const Chromaticities& primaries,
                     const std::string& place) {
    if (!stored.encoding.is_color())
        throw Error(ErrorKind::capture,
                    place + ": the colours are stored as '" + stored.name + "' (" + stored.source +
                        "), a curve that this program cannot decode (convert the file to scene-linear light; "
                        "or, if it holds that already, name its primaries with " +
                        spelled(Option::color_space) + ", or \"color_space\" in capture.json)");
    decode_curve(image, stored.encoding);
    if (stored.encoding.primaries != primaries)
        convert_colors(image, conversion_matrix(stored.encoding.primaries, primaries));
}

void stored_of_light(Image& image, const StoredColors& stored, const Chromaticities& primaries) {
    if (stored.encoding.primaries != primaries)
        convert_colors(image, conversion_matrix(primaries, stored.encoding.primaries));
    if (stored.encoding.is_color()) encode_curve(image, stored.encoding);
}

const std::vector<std::string>& color_space_attributes() {
    static const std::vector<std::string> names = {"colorInteropID", "colorInteropId",
                                                   "acesImageContainerFlag", "oiio:ColorSpace"};
    return names;
}

}  // namespace aftershade
