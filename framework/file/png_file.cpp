#include "framework/file/png_file.h"

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/lfs_pointer.h"
#include "framework/base/memory_limit.h"
#include "framework/file/output_stream.h"
#include "framework/file/quantized.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <exception>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#define STBI_ONLY_PNG
#include "framework/file/stb_internal.h"

namespace aftershade {

namespace fs = std::filesystem;
using stb::fail;

namespace {

constexpr std::uintmax_t kMaxPngBytes = 512u * 1024 * 1024;
constexpr int kMaxSidePx = STBI_MAX_DIMENSIONS;

/// stb is written in C: an exception must not pass through it, so the failure is kept until it has returned.
struct Sink {
    std::string bytes;
    std::exception_ptr failure;
};

void write_to_sink(void* context, void* bytes, int count) {
    Sink& sink = *static_cast<Sink*>(context);
    if (sink.failure) return;
    try {
        sink.bytes.append(static_cast<const char*>(bytes), std::size_t(count));
    } catch (...) {
        sink.failure = std::current_exception();
    }
}

constexpr std::size_t kSignatureBytes = 8, kChunkHeadBytes = 8, kChecksumBytes = 4;

std::uint32_t number_at(std::span<const unsigned char> bytes, std::size_t at) {
    return std::uint32_t(bytes[at]) << 24 | std::uint32_t(bytes[at + 1]) << 16 |
           std::uint32_t(bytes[at + 2]) << 8 | std::uint32_t(bytes[at + 3]);
}

std::string number_text(std::uint32_t value) {
    return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

/// PNG specification, section 5.3: length, type, data, checksum of type and data.
std::string chunk(const std::string& type, const std::string& data) {
    const std::string checked = type + data;
    const auto checksum =
        std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(checked.data()), uInt(checked.size())));
    return number_text(std::uint32_t(data.size())) + checked + number_text(checksum);
}

/// PNG specification, section 11.3.5.3: pixels per unit along x and y, of a unit that is not known.
std::string aspect_chunk(float pixel_aspect) {
    constexpr double kPerUnit = 1'000'000;
    if (!(pixel_aspect > 1 / kPerUnit && pixel_aspect < kPerUnit)) return "";
    const double larger = std::max(1.0, double(pixel_aspect));
    const auto along = [&](double share) {
        return number_text(std::uint32_t(std::lround(kPerUnit * share)));
    };
    // Wide pixels are fewer along x.
    return chunk("pHYs", along(1 / larger) + along(double(pixel_aspect) / larger) + '\0');
}

/// PNG specification, third edition, 11.3.2: cICP where it has the code points, and gAMA and cHRM for
/// programs that do not read it.
std::string color_chunks(const ColorEncoding& encoding) {
    const std::string perceptual(1, '\0');  // the rendering intent
    if (encoding == kSrgbDisplay) return chunk("sRGB", perceptual);
    if (!encoding.is_color()) return "";
    std::string chunks;
    if (const auto codes = cicp_of(encoding))
        chunks += chunk("cICP", {char(codes->first), char(codes->second), 0, 1});
    const auto fixed = [](double value) { return number_text(std::uint32_t(std::lround(value * 1e5))); };
    if (encoding.curve == ColorEncoding::Curve::gamma || encoding.is_light())
        chunks += chunk("gAMA", fixed(1 / encoding.gamma));
    else if (encoding.curve == ColorEncoding::Curve::srgb) chunks += chunk("gAMA", fixed(1 / 2.2));
    const Chromaticities& xy = encoding.primaries;
    std::string primaries = fixed(double(xy[6])) + fixed(double(xy[7]));
    for (std::size_t i = 0; i < 6; ++i) primaries += fixed(double(xy[i]));
    return chunks + chunk("cHRM", primaries);
}

std::string read_bytes(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) fail(path, "is a folder, not a PNG file");
    std::string fault;
    std::string bytes = read_regular_file(path, kMaxPngBytes, fault);
    if (!fault.empty()) fail(path, fault);
    if (bytes.empty()) fail(path, "the file is empty");
    if (fault = lfs_fault(path); !fault.empty()) fail(path, fault);
    return bytes;
}

/// stb_image passes over the checksums of chunks and of the pixels: what it takes from a damaged file would
/// be another picture. Of chunks that may be ignored nothing is asked. `visit` gets each chunk's type and
/// data.
void check_chunks(const fs::path& path, std::span<const unsigned char> bytes,
                  const std::function<void(const std::string&, std::span<const unsigned char>)>& visit = {}) {
    for (std::size_t at = kSignatureBytes; at + kChunkHeadBytes + kChecksumBytes <= bytes.size();) {
        const std::size_t length = number_at(bytes, at);
        const std::string type(bytes.begin() + std::ptrdiff_t(at) + 4,
                               bytes.begin() + std::ptrdiff_t(at) + 8);
        if (length > bytes.size() - at - kChunkHeadBytes - kChecksumBytes) break;
        const auto checksum = std::uint32_t(crc32(0, &bytes[at + 4], uInt(4 + length)));
        const bool is_critical = type[0] >= 'A' && type[0] <= 'Z';
        if (is_critical && checksum != number_at(bytes, at + kChunkHeadBytes + length))
            fail(path, fmt::format("damaged: the chunk {} at byte {} has another checksum than its bytes",
                                   type, at));
        if (visit) visit(type, bytes.subspan(at + kChunkHeadBytes, length));
        if (type == "IEND") return;
        at += kChunkHeadBytes + length + kChecksumBytes;
    }
    fail(path, fmt::format("damaged: cut off, {} bytes do not reach its last chunk", bytes.size()));
}

Error no_memory(const std::string& name) {
    return {ErrorKind::memory, name + ": " + out_of_memory_text(std::bad_alloc())};
}

std::string png_of_8_bits(const std::string& name, const Image& display) {
    const std::span<const float> values = display.floats();
    std::vector<std::uint8_t> bytes(values.size());
    std::ranges::transform(values, bytes.begin(), quantized<std::uint8_t>);
    Sink sink;
    const int written =
        stbi_write_png_to_func(write_to_sink, &sink, display.width(), display.height(), display.channels(),
                               bytes.data(), display.width() * display.channels());
    if (sink.failure) std::rethrow_exception(sink.failure);
    if (written == 0) throw no_memory(name);
    return std::move(sink.bytes);
}

/// Which stb does not write. Rows have the filter Up, PNG specification, 9.2.
std::string png_of_16_bits(const std::string& name, const Image& display) {
    const std::size_t row_bytes = std::size_t(display.width()) * std::size_t(display.channels()) * 2;
    std::string rows, above(row_bytes, '\0'), row(row_bytes, '\0');
    rows.reserve((row_bytes + 1) * std::size_t(display.height()));
    const std::span<const float> values = display.floats();
    for (std::size_t at = 0; at < values.size(); above.swap(row)) {
        for (std::size_t i = 0; i < row_bytes; i += 2, ++at) {
            const auto sample = quantized<std::uint16_t>(values[at]);
            row[i] = char(sample >> 8);
            row[i + 1] = char(sample);
        }
        constexpr char kUp = 2;
        rows += kUp;
        for (std::size_t i = 0; i < row_bytes; ++i) rows += char(row[i] - above[i]);
    }
    uLongf size = compressBound(uLong(rows.size()));
    std::string packed(size, '\0');
    if (compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                 uLong(rows.size())) != Z_OK)
        throw no_memory(name);
    packed.resize(size);
    constexpr std::array<char, 5> kColorTypes = {0, 0, 4, 2, 6};  // by channels
    const std::string head = number_text(std::uint32_t(display.width())) +
                             number_text(std::uint32_t(display.height())) + '\x10' +
                             kColorTypes[std::size_t(display.channels())] + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + chunk("IHDR", head) + chunk("IDAT", packed) + chunk("IEND", "");
}

}  // namespace

std::string encode_png(const std::string& name, const Image& display, const PngText& text,
                       const PngMeaning& meaning) {
    assert(display.channels() == 1 || display.channels() == 3 || display.channels() == 4);
    assert(!display.empty());
    if (display.width() > kMaxSidePx || display.height() > kMaxSidePx) {
        throw Error(ErrorKind::output,
                    fmt::format("{}: {} x {} px is too large for PNG output, the limit is {} px a side", name,
                                display.width(), display.height(), kMaxSidePx));
    }
    assert(meaning.bits == 8 || meaning.bits == 16);
    std::string file = meaning.bits == 16 ? png_of_16_bits(name, display) : png_of_8_bits(name, display);
    constexpr std::size_t kSizeChunkBytes = kChunkHeadBytes + 13 + kChecksumBytes;  // IHDR, the first
    std::string chunks = meaning.display ? color_chunks(*meaning.display) : "";
    for (const auto& [keyword, value] : text) chunks += chunk("tEXt", keyword + '\0' + value);
    if (meaning.pixel_aspect != 1) chunks += aspect_chunk(meaning.pixel_aspect);
    return file.insert(kSignatureBytes + kSizeChunkBytes, chunks);
}

void write_png(const fs::path& path, const Image& display, const PngText& text, const PngMeaning& meaning) {
    const std::string bytes = encode_png(path.string(), display, text, meaning);
    OutputStream stream(path);
    stream.write(bytes.data(), bytes.size());
    stream.commit();
}

std::optional<PngColor> read_png_color(const fs::path& path) {
    std::error_code failure;
    std::string head(kSignatureBytes, '\0');
    if (!fs::is_regular_file(path, failure) ||
        !std::ifstream(path, std::ios::binary).read(head.data(), std::streamsize(head.size())) ||
        head != "\x89PNG\r\n\x1a\n")
        return std::nullopt;
    PngColorReader colors;
    try {
        const std::string text = read_bytes(path);
        check_chunks(
            path, {reinterpret_cast<const unsigned char*>(text.data()), text.size()},
            [&](const std::string& type, std::span<const unsigned char> data) { colors.read(type, data); });
    } catch (const Error&) {
        return std::nullopt;
    }
    return colors.color();
}

namespace {

/// stb leaves colours that the palette lacks as its memory has them. With `filler` for all of these; nullopt
/// where the picture has no palette, or a whole one.
std::optional<std::string> with_whole_palette(std::span<const unsigned char> bytes, char filler) {
    constexpr std::size_t kDepthAt = kSignatureBytes + kChunkHeadBytes + 8;
    if (bytes.size() <= kDepthAt + 1 || bytes[kDepthAt + 1] != 3) return std::nullopt;
    const std::size_t whole = std::size_t(3) << std::min<unsigned>(bytes[kDepthAt], 8);
    for (std::size_t at = kSignatureBytes; at + kChunkHeadBytes + kChecksumBytes <= bytes.size();) {
        const std::size_t length = number_at(bytes, at), end = at + kChunkHeadBytes + length;
        if (end + kChecksumBytes > bytes.size()) break;
        if (std::string(bytes.begin() + std::ptrdiff_t(at) + 4, bytes.begin() + std::ptrdiff_t(at) + 8) ==
            "PLTE") {
            if (length >= whole) return std::nullopt;
            std::string colors(bytes.begin() + std::ptrdiff_t(at + kChunkHeadBytes),
                               bytes.begin() + std::ptrdiff_t(end));
            colors.resize(whole, filler);
            return std::string(bytes.begin(), bytes.begin() + std::ptrdiff_t(at)) + chunk("PLTE", colors) +
                   std::string(bytes.begin() + std::ptrdiff_t(end + kChecksumBytes), bytes.end());
        }
        at = end + kChecksumBytes;
    }
    return std::nullopt;
}

}  // namespace

Image read_png(const fs::path& path, PngColor* color) {
    return decode_png(path, read_bytes(path), color);
}

Image decode_png(const fs::path& path, std::string_view text, PngColor* color) {
    if (text.size() > kMaxPngBytes)
        fail(path, fmt::format("has {} bytes, the limit is {}", text.size(), kMaxPngBytes));
    const std::span bytes(reinterpret_cast<const unsigned char*>(text.data()), text.size());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    stb::bytes_left = stb::kMaxImageBytes;
    if (stbi_info_from_memory(bytes.data(), size, &width, &height, &channels) == 0) {
        fail(path, fmt::format("not a PNG file that can be read: {}", stbi_failure_reason()));
    }
    if (width > kMaxSidePx || height > kMaxSidePx) {
        fail(path, fmt::format("{} x {} px, the limit is {} px a side", width, height, kMaxSidePx));
    }
    if (const std::string fault = stb::fault_of_size(width, height, channels); !fault.empty())
        fail(path, fault);
    PngColorReader colors;
    check_chunks(path, bytes, [&](const auto& type, const auto data) { colors.read(type, data); });
    if (color) *color = colors.color();
    const bool is_wide = stbi_is_16_bit_from_memory(bytes.data(), size) != 0;
    const auto load = [&](auto* from_memory, float maximum, std::span<const unsigned char> file) {
        stb::bytes_left = stb::kMaxImageBytes;
        const auto loaded = from_memory(file.data(), int(file.size()), &width, &height, &channels, 0);
        const std::unique_ptr<std::remove_pointer_t<decltype(loaded)>, decltype(&stbi_image_free)> pixels(
            loaded, &stbi_image_free);
        if (!pixels) fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
        Image image(width, height, channels);
        const std::span<float> values = image.floats();
        std::transform(pixels.get(), pixels.get() + values.size(), values.begin(),
                       [&](auto value) { return static_cast<float>(value) / maximum; });
        return image;
    };
    if (is_wide) return load(&stbi_load_16_from_memory, 65535.0f, bytes);
    const auto load_filled = [&](const std::string& file) {
        return load(&stbi_load_from_memory, 255.0f,
                    {reinterpret_cast<const unsigned char*>(file.data()), file.size()});
    };
    const auto black = with_whole_palette(bytes, '\0'), white = with_whole_palette(bytes, '\xff');
    if (!black) return load(&stbi_load_from_memory, 255.0f, bytes);
    Image image = load_filled(*black);
    if (!std::ranges::equal(image.floats(), load_filled(*white).floats()))
        fail(path, "damaged: a pixel has a colour that the palette (chunk PLTE) lacks");
    return image;
}

}  // namespace aftershade
