// The headers of a file, walked before the library reads them.
#include "framework/file/exr_internal.h"

#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfVersion.h>
#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

#include "framework/base/text.h"

namespace aftershade::exr {

namespace fs = std::filesystem;

namespace {

constexpr int kMaxChannels = 1024;
constexpr int kMaxParts = 1024;
constexpr int kMaxAttributes =
    65536;  // of the whole file; an empty one takes 9 bytes there and 400 in memory

struct FixedSize {
    std::string_view type;
    int bytes;
};

// Types whose stored size the library does not look at. One that lied would make it read the next attribute
// elsewhere than this check does. openexr.com, "OpenEXR File Layout", attribute types.
constexpr FixedSize kFixedSizes[] = {{"box2f", 16},
                                     {"box2i", 16},
                                     {"chromaticities", 32},
                                     {"compression", 1},
                                     {"deepImageState", 1},
                                     {"double", 8},
                                     {"envmap", 1},
                                     {"float", 4},
                                     {"int", 4},
                                     {"keycode", 28},
                                     {"lineOrder", 1},
                                     {"m33d", 72},
                                     {"m33f", 36},
                                     {"m44d", 128},
                                     {"m44f", 64},
                                     {"rational", 8},
                                     {"tiledesc", 9},
                                     {"timecode", 8},
                                     {"v2d", 16},
                                     {"v2f", 8},
                                     {"v2i", 8},
                                     {"v3d", 24},
                                     {"v3f", 12},
                                     {"v3i", 12}};

/// Walks the headers without keeping anything.
class HeaderScan {
public:
    HeaderScan(FileStream& file, const fs::path& path) : file_(file), path_(path) {}

    /// Returns the version field; the end of the headers is then the file's position.
    int run() {
        const int version = read_version();
        int parts = 0;
        while (scan_part() && Imf::isMultiPart(version)) {
            if (++parts > kMaxParts)
                fail(path_, fmt::format("more than {} parts, which is the limit", kMaxParts));
        }
        return version;
    }

private:
    int read_version() {
        unsigned char magic[4] = {};
        file_.read_at(
            0, {reinterpret_cast<char*>(magic), std::size_t(std::min<std::uint64_t>(4, file_.byte_count()))});
        if (std::string_view(reinterpret_cast<const char*>(magic), sizeof magic) != kMagic) {
            fail(path_,
                 fmt::format("not an OpenEXR file (it begins with the bytes {:02x} {:02x} {:02x} {:02x}, "
                             "expected 76 2f 31 01)",
                             magic[0], magic[1], magic[2], magic[3]));
        }
        file_.seekg(4);
        const int version = read_int();
        if (Imf::getVersion(version) != Imf::EXR_VERSION || !Imf::supportsFlags(Imf::getFlags(version))) {
            fail(path_, fmt::format("OpenEXR version field {:#010x} is not supported (format version 2 is)",
                                    unsigned(version)));
        }
        return version;
    }

    /// False for the empty header that ends a multi-part list.
    bool scan_part() {
        int count = 0;
        for (std::string name = read_name("attribute"); !name.empty(); name = read_name("attribute")) {
            ++count;
            if (++attributes_ > kMaxAttributes) {
                fail(path_,
                     fmt::format("more than {} header attributes, which is the limit", kMaxAttributes));
            }
            const std::string type = read_name("attribute type");
            scan_value(name, type, read_int());
        }
        return count > 0;
    }

    void scan_value(const std::string& name, const std::string& type, int size) {
        const std::uint64_t begin = file_.tellg();
        if (size < 0 || std::uint64_t(size) > file_.byte_count() - begin) {
            fail(path_, fmt::format("header attribute '{}' claims {} bytes, {} are left in the file", name,
                                    size, file_.byte_count() - begin));
        }
        const auto* fixed = std::ranges::find(kFixedSizes, std::string_view(type), &FixedSize::type);
        bool sound = fixed == std::end(kFixedSizes) || fixed->bytes == size;
        const std::uint64_t end = begin + std::uint64_t(size);
        if (type == "floatvector") sound = size % 4 == 0;
        if (type == "chlist") sound = is_channel_list(end);
        if (type == "stringvector") sound = strings_end(end) == end;
        if (!sound)
            fail(path_,
                 fmt::format("header attribute '{}' is not a well-formed {} of {} bytes", name, type, size));
        if (name == "compression" && type == "compression") check_compression();
        file_.seekg(end);
    }

    /// The library calls a method that is newer than itself a damaged header.
    void check_compression() {
        char method = 0;
        file_.read(&method, 1);
        if (method >= 0 && method < Imf::NUM_COMPRESSION_METHODS) return;
        const auto number = std::size_t(static_cast<unsigned char>(method));
        const std::string which =
            number < kCompressions.size()
                ? fmt::format("{} (OpenEXR {})", kCompressions[number].name, kCompressions[number].since)
                : fmt::format("method {}", number);
        fail(path_,
             fmt::format(
                 "is compressed with {}, which this build's OpenEXR {} does not read; convert it with a "
                 "newer one: oiiotool {} --compression zip -o OUT.exr",
                 which, OPENEXR_VERSION_STRING, printed_command({path_.string()})));
    }

    /// The library reads up to the empty name that ends the list, wherever that is.
    bool is_channel_list(std::uint64_t end) {
        for (int count = 0; file_.tellg() < end; ++count) {
            if (read_name("channel").empty()) return file_.tellg() == end;
            if (count == kMaxChannels)
                fail(path_, fmt::format("more than {} channels, which is the limit", kMaxChannels));
            file_.seekg(std::min(file_.byte_count(), file_.tellg() + 16));
        }
        return false;
    }

    std::uint64_t strings_end(std::uint64_t limit) {
        while (file_.tellg() + 4 <= limit) {
            const int length = read_int();
            if (length < 0 || std::uint64_t(length) > limit - file_.tellg()) break;
            file_.seekg(file_.tellg() + std::uint64_t(length));
        }
        return file_.tellg();
    }

    std::string read_name(const char* of_what) {
        std::string name;
        for (char letter = read_char(); letter != 0; letter = read_char()) {
            name.push_back(letter);
            if (name.size() > kMaxNameLength) {
                fail(path_,
                     fmt::format("damaged header: {} name longer than {} bytes", of_what, kMaxNameLength));
            }
        }
        return name;
    }

    char read_char() {
        char value = 0;
        file_.read(&value, 1);
        return value;
    }

    int read_int() {
        int value = 0;
        file_.read(reinterpret_cast<char*>(&value), sizeof value);
        return value;
    }

    FileStream& file_;
    const fs::path& path_;
    int attributes_ = 0;
};

}  // namespace

int scan_headers(FileStream& file, const fs::path& path) {
    return HeaderScan(file, path).run();
}

}  // namespace aftershade::exr
