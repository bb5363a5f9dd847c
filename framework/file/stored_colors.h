// In which space a file stores its colours, and what says so.
#pragma once

#include <string>
#include <vector>

#include "framework/file/exr_file.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

struct StoredColors {
    ColorEncoding encoding;
    std::string name;                   ///< "acescg", "srgb_rec709_scene"; "" for primaries without a name
    std::string source;                 ///< "colorInteropID"; "" where the space is assumed
    bool is_declared = false;           ///< by the user or the profile, whatever the file says
    std::vector<std::string> warnings;  ///< on what the file says of its space, in whole sentences
    std::string unknown{};  ///< what the file says instead of a known space, where nothing else counts

    bool is_known() const { return !source.empty(); }
    /// "acescg (colorInteropID)", "rec709 (assumed)".
    std::string text() const;
    /// One text for all names of one encoding: "acescg", "srgb_rec709_scene", "primaries 0.7000 0.3000 ...".
    /// Equal numbers in files with other texts are other colours.
    std::string meaning() const;
};

/// By the attributes `colorInteropID`, `acesImageContainerFlag`, `chromaticities` and `oiio:ColorSpace`, the
/// first of these that says anything; else Rec. 709 is assumed, as the OpenEXR specification does. The id is
/// that of the part that holds the colours.
StoredColors stored_colors(const ExrMetadata& metadata, const ExrMetadata& part);

/// `space` is a name of color_space_names(), and `source` what declares it.
StoredColors declared_colors(const std::string& space, const std::string& source);

/// From what the file stores to light of the primaries that header has, and back. Throws
/// Error(ErrorKind::capture), which begins with `place`, where the file's curve is one that this program does
/// not have.
void light_of_stored(Image& image, const StoredColors& stored, const Chromaticities& primaries,
                     const std::string& place);
void stored_of_light(Image& image, const StoredColors& stored, const Chromaticities& primaries);

/// Attributes that name a colour space; an output has its own.
const std::vector<std::string>& color_space_attributes();

}  // namespace aftershade
