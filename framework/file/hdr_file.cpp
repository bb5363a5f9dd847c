#include "framework/file/hdr_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <istream>
#include <memory>
#include <streambuf>
#include <string>

#include "framework/base/atomic_file.h"

#define STBI_ONLY_HDR
#include "framework/file/stb_internal.h"

namespace aftershade {

namespace fs = std::filesystem;
using stb::fail;

namespace {

/// What stb reads from, and whether it asked for more than there is.
struct Source {
    std::ifstream file;
    bool past_end = false;
};

int read_source(void* user, char* bytes, int count) {
    Source& source = *static_cast<Source*>(user);
    source.file.read(bytes, count);
    const int got = int(source.file.gcount());
    if (got == 0) source.past_end = true;
    return got;
}

void skip_source(void* user, int count) {
    static_cast<Source*>(user)->file.seekg(count, std::ios::cur);
}

int is_at_end(void* user) {
    return static_cast<Source*>(user)->file.eof() ? 1 : 0;
}

constexpr const char* kCutOff = "cut off: the file ends before its pixels do";

/// To the first byte of the pixels. A line that begins with NUL ends the header, as stb reads it.
void skip_header(std::istream& in) {
    std::string line;
    while (std::getline(in, line) && !line.empty() && line[0] != '\0') {
    }
    std::getline(in, line);  // the size
}

/// Where pixels have no runs, from here on: stb reads 0 for each that is missing, one after the other.
std::string fault_of_plain_pixels(std::istream& in, std::uint64_t bytes) {
    const auto begin = in.tellg();
    in.seekg(0, std::ios::end);
    return std::uint64_t(in.tellg() - begin) < bytes ? kCutOff : "";
}

/// Why the run lengths do not cover the pixels; "" where they do, or where stb finds the fault itself. It
/// reads 0 where a length is missing, and a run of 0 pixels brings it no nearer to the end of the line.
std::string fault_of_runs(std::istream& in, int width, int height) {
    constexpr int kLeastWidth = 8, kEndOfWidths = 32768;  // others have no runs
    constexpr int kLongestDump = 128;
    const std::uint64_t plain_bytes = 4 * std::uint64_t(width) * std::uint64_t(height);
    if (width < kLeastWidth || width >= kEndOfWidths) return fault_of_plain_pixels(in, plain_bytes);
    std::streambuf& bytes = *in.rdbuf();
    constexpr int kEnd = std::char_traits<char>::eof();
    for (int row = 0; row < height; ++row) {
        std::array<int, 4> head{};
        for (int& byte : head)
            if ((byte = bytes.sbumpc()) == kEnd) return kCutOff;
        // stb takes these four bytes for the first of all pixels.
        if (head[0] != 2 || head[1] != 2 || head[2] >= 128)
            return fault_of_plain_pixels(in, plain_bytes - head.size());
        if ((head[2] << 8 | head[3]) != width) return "";
        for (int channel = 0; channel < 4; ++channel)
            for (int left = width; left > 0;) {
                const int length = bytes.sbumpc();
                if (length == kEnd) return kCutOff;
                if (length == 0) return "damaged: a run of pixels is 0 px long";
                const bool repeats = length > kLongestDump;
                const int pixels = repeats ? length - kLongestDump : length;
                if (pixels > left) return "";
                for (int i = 0; i < (repeats ? 1 : pixels); ++i)
                    if (bytes.sbumpc() == kEnd) return kCutOff;
                left -= pixels;
            }
    }
    return "";
}

}  // namespace

bool is_hdr_file(const fs::path& path) {
    return file_begins_with(path, "#?RADI") || file_begins_with(path, "#?RGBE");
}

Image read_hdr(const fs::path& path) {
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (error) fail(path, fmt::format("cannot be opened: {}", error.message()));
    if (!fs::is_regular_file(status)) fail(path, "is not a regular file");
    Source source{std::ifstream(path, std::ios::binary), false};
    if (!source.file) fail(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
    const stbi_io_callbacks callbacks = {read_source, skip_source, is_at_end};
    int width = 0, height = 0, channels = 0;
    stb::bytes_left = stb::kMaxImageBytes;
    if (stbi_info_from_callbacks(&callbacks, &source, &width, &height, &channels) == 0)
        fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
    if (const std::string fault = stb::fault_of_size(width, height, 3); !fault.empty()) fail(path, fault);
    source.file.clear();
    source.file.seekg(0);
    skip_header(source.file);
    if (const std::string fault = fault_of_runs(source.file, width, height); !fault.empty())
        fail(path, fault);
    source.file.clear();
    source.file.seekg(0);
    source.past_end = false;
    const std::unique_ptr<float, decltype(&stbi_image_free)> pixels(
        stbi_loadf_from_callbacks(&callbacks, &source, &width, &height, &channels, 3), &stbi_image_free);
    if (!pixels) fail(path, fmt::format("damaged: {}", stbi_failure_reason()));
    if (source.past_end) fail(path, kCutOff);
    Image image(width, height, 3);
    std::memcpy(image.floats().data(), pixels.get(), image.floats().size_bytes());
    return image;
}

}  // namespace aftershade
