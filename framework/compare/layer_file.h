// A picture file of any kind that is compared, as layers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "framework/base/open_file.h"
#include "framework/compare/layer.h"
#include "framework/image/color_encoding.h"

namespace aftershade {

/// Properties of a file besides the values of its layers.
struct FileTraits {
    std::string colors;                    ///< what the numbers of colours mean: "sRGB", "rec709"
    Chromaticities primaries = kRec709;    ///< of linear colours
    ColorEncoding display = kSrgbDisplay;  ///< of pictures for a display
    float pixel_aspect = 1;
    std::string first_view;  ///< whose layers have no view in their names; "" where the file names none
    std::vector<std::string> left_out;  ///< what no layer has: "smaller levels of the tiles of part 'a'"
    /// By the name of a Cryptomatte and an id: the objects that its manifest calls by the id.
    std::map<std::string, std::map<std::uint32_t, std::set<std::string>>> objects;
    std::vector<std::string> notes;  ///< how colours were read, where it is not as they are stored
};

/// OpenEXR, PNG or Radiance, recognised by its first bytes. OpenEXR: every part, level 0 of tiles; samples of
/// subsampled channels are repeated over their pixels; a first part of luminance and chroma has a layer of R,
/// G and B in half precision besides what it stores. PNG: `display`, value / maximum. Radiance: `color`.
/// Headers are read on construction. [one thread at a time]
class LayerFile {
public:
    /// Throws Error(ErrorKind::capture) that begins with the path: missing, no such format, deep, damaged.
    explicit LayerFile(const std::filesystem::path& path, const ReadLimits& limits = {});
    /// Takes an OpenEXR file that is open.
    explicit LayerFile(OpenFile exr, const ReadLimits& limits = {});
    ~LayerFile();
    LayerFile(LayerFile&&) noexcept;
    LayerFile& operator=(LayerFile&&) noexcept;

    const std::filesystem::path& path() const;
    /// "OpenEXR", "PNG" or "Radiance HDR".
    const std::string& format() const;
    const std::vector<LayerInfo>& layers() const;
    const FileTraits& traits() const;
    /// Some channels of a layer, in the order asked for, over its own data window. Cut-off and damaged pixels
    /// throw Error(ErrorKind::capture).
    Image read(const LayerInfo& layer, const std::vector<std::string>& channels) const;
    /// Unpacks what will be requested in one pass, where that fits into the limits. Never fails.
    void prefetch() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace aftershade
