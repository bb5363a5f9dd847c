// Reading and writing OpenEXR files by channel name, and deep pixels in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "framework/base/open_file.h"
#include "framework/image/color_space.h"
#include "framework/image/image.h"
#include "framework/image/pixel_type.h"

namespace aftershade {

/// Any number of samples in each pixel, rows from the top. [value type: safe to read from several threads]
struct DeepImage {
    /// A value for each sample: `floats`, or `uints` where the file stores unsigned integers.
    struct Channel {
        std::string name;
        std::vector<float> floats{};
        std::vector<std::uint32_t> uints{};
    };

    int width = 0;
    int height = 0;
    /// By pixel, and one more at the end: where its samples begin.
    std::vector<std::uint32_t> first;
    std::vector<Channel> channels;

    std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
    std::size_t sample_count() const { return first.empty() ? 0 : first.back(); }
    /// nullptr where there is none of that name.
    const Channel* find(const std::string& name) const {
        for (const Channel& channel : channels)
            if (channel.name == name) return &channel;
        return nullptr;
    }
};

/// Limits of a reader, which it checks before it allocates memory.
struct ReadLimits {
    int max_side_px = 16384;  ///< of the data and the display window
    std::uint64_t max_image_bytes =
        512ull * 1024 * 1024;  ///< of the channels asked for, as this program stores them
};

struct ExrChannel {
    std::string name;
    PixelType type = PixelType::half;
    int x_sampling = 1;
    int y_sampling = 1;
};

using ExrValue = std::variant<std::string, int, float, std::vector<float>>;

/// The header attributes of one part, kept whole so that they can be carried to an output bit for bit.
/// [thread-safe to read; cheap to copy]
class ExrMetadata {
public:
    ExrMetadata();
    std::vector<std::string> names() const;
    /// string, int, float, double (as float); v2i/v2f/v3i/v3f, m33f, m44f, box2i, floatvector and
    /// chromaticities (red, green, blue, white) as float vectors, row by row as EXR stores them; nullopt
    /// where absent or of another type.
    std::optional<ExrValue> value(const std::string& name) const;
    std::optional<std::string> text(const std::string& name) const;  ///< string attributes only
    std::optional<std::vector<std::string>> texts(
        const std::string& name) const;  ///< stringvector attributes only
    /// Numbers, rationals (framesPerSecond), and strings that are wholly a number.
    std::optional<double> number(const std::string& name) const;
    /// Takes over what `other` has beside it; but nothing that describes the pixels of one part.
    void complete_from(const ExrMetadata& other, bool only_texts);

    struct Impl;  ///< an Imf::Header
    std::shared_ptr<const Impl> impl;
};

/// The attribute "chromaticities"; Rec. 709, as the OpenEXR specification says, where there is none.
Chromaticities stored_primaries(const ExrMetadata& metadata);

struct ExrPart {
    std::string name;
    std::string view;
    std::string type;         ///< "scanlineimage", "tiledimage", "deepscanline", "deeptile"
    std::string compression;  ///< one of exr_compression_names()
    Window data_window;
    Window display_window;
    float pixel_aspect = 1;
    std::vector<ExrChannel> channels;  ///< in the file's order
    ExrMetadata metadata;
    bool has_smaller_levels = false;  ///< of tiles, which no reader of this program looks at
    bool is_deep() const { return type.starts_with("deep"); }
    /// Second names of channels, each with the first: "Beauty.R" for "R" of a part that is called Beauty.
    /// Only FrameFile::merged() has any.
    std::map<std::string, std::string> other_names;
};

/// A request of one call of read_floats or read_uints.
struct ExrRequest {
    int part = 0;
    std::vector<std::string> channels;
    ComponentType type = ComponentType::float32;
    bool operator==(const ExrRequest&) const = default;
};

/// Whether it is a file that begins as OpenEXR files do.
bool is_exr_file(const std::filesystem::path& path);

/// An open file. The constructor reads headers and checks them against the limits; it allocates nothing
/// larger than a header before. Every failure is Error(ErrorKind::capture) that begins with the path. [one
/// thread at a time]
class ExrFile {
public:
    explicit ExrFile(const std::filesystem::path& path, const ReadLimits& limits = {});
    explicit ExrFile(OpenFile file, const ReadLimits& limits = {});
    ~ExrFile();
    ExrFile(ExrFile&&) noexcept;
    ExrFile& operator=(ExrFile&&) noexcept;

    const std::filesystem::path& path() const;
    const std::vector<ExrPart>& parts() const;

    /// The named channels of a part, interleaved in the order given, over the part's data window (level 0 of
    /// a tiled part). half and uint channels are widened to float by read_floats (uint values above 2^24 lose
    /// bits: use read_uints, which takes uint channels only). Deep parts, subsampled channels, incomplete
    /// files and channels that do not exist are errors.
    Image read_floats(int part, std::span<const std::string> channels) const;
    Image read_uints(int part, std::span<const std::string> channels) const;
    /// One channel, subsampled or not, over the part's data window: every stored sample is repeated over the
    /// pixels that it stands for. ComponentType::uint32 takes uint channels only.
    Image read_repeated(int part, const std::string& channel, ComponentType type) const;
    /// Unpacks what these reads will request in one pass over each part, instead of one for each read: all
    /// channels of a block are compressed together. The next read of exactly a request's channels takes what
    /// is kept for it. Never fails: what cannot be read, or would be more than the limits allow, is left to
    /// the reads, which report it; so is a request that shares a channel with one before it.
    void prefetch(std::span<const ExrRequest> requests) const;
    /// The samples of the named channels of a deep part (of level 0 where tiled); half becomes float, uint
    /// stays. Sample counts are read first, and checked against the limits before memory for the samples is
    /// allocated; without channels only the counts are read. Flat parts, incomplete files and channels that
    /// do not exist are errors.
    DeepImage read_deep(int part, std::span<const std::string> channels) const;
    /// RGBA of a part that stores luminance Y, or Y with subsampled RY and BY, as OpenEXR's own RgbaInputFile
    /// converts it, to half precision.
    Image read_luminance_chroma(int part) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// One channel to write: component `component` of `image`, stored as `type`.
struct ExrOutputChannel {
    std::string name;
    PixelType type = PixelType::half;
    const Image* image = nullptr;
    int component = 0;
};

struct ExrWriteOptions {
    Window data_window;  ///< the images' size
    Window display_window;
    float pixel_aspect = 1;
    std::string compression = "zip";  ///< a name of exr_compression_names(), or with a level: "zip:1"
    /// Every attribute but windows, pixel aspect, channels, compression, type, name, line order, tiles,
    /// preview.
    std::optional<ExrMetadata> carry_over;
    std::vector<std::string> left_behind;  ///< names that are not carried over
    /// Instead of those carried over. Vectors of 2, 3, 9 and 16 become v2f, v3f, m33f and m44f,
    /// "chromaticities" of 8 its own type, others floatvector; "framesPerSecond" becomes a rational.
    std::map<std::string, ExrValue> attributes;
};

/// A channel of halfs that was given finite values beyond 65504, which became infinite.
struct HalfOverflow {
    std::string channel;
    std::size_t values = 0;
};

/// Writes one scan-line part: to a temporary file in the same folder, flushed, then renamed over `path`.
/// Throws Error(ErrorKind::output) that begins with the path; then no temporary file remains and an older
/// file is whole. Returns what a half could not hold, channels in the order given.
std::vector<HalfOverflow> write_exr(const std::filesystem::path& path,
                                    std::span<const ExrOutputChannel> channels,
                                    const ExrWriteOptions& options);

/// Writes one deep scan-line part in the same way, floats as float; compression is none, rle or zips.
void write_deep_exr(const std::filesystem::path& path, const DeepImage& image,
                    const ExrWriteOptions& options);

/// Values of ExrWriteOptions::compression: those of this build's OpenEXR, from "none" and "rle" to
/// "dwab"; from 3.4 on also "htj2k256" and "htj2k32", from 3.5 on "lj2k" and "zstd".
const std::vector<std::string>& exr_compression_names();

/// The level of "zip:1" or "zips:9", from 1, the fastest, to 9; none where the text names none.
std::optional<int> exr_compression_level(std::string_view text);

/// Whether a compression may change values: b44, b44a, dwaa, dwab, lj2k, and pxr24, which shortens floats.
bool is_lossy_compression(std::string_view name);

/// The remedy for a file of deep data: "flatten it: oiiotool IN --flatten -o OUT.exr".
std::string exr_flatten_remedy(const std::filesystem::path& path);

/// Threads that OpenEXR uses for compression, process-wide; 0 does the work on the caller's thread.
void set_exr_threads(int count);
/// The same threads, or 1 for the caller's own: for work on what they have just read or will write.
int exr_threads();

}  // namespace aftershade
