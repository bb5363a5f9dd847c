// Shared by the EXR sources of this folder; no other file includes it.
#pragma once

#include "framework/base/error.h"
#include "framework/base/memory_limit.h"
#include "framework/base/open_file.h"
#include "framework/base/text.h"
#include "framework/file/exr_file.h"

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPixelType.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aftershade {

struct ExrMetadata::Impl {
    Imf::Header header;
};

namespace exr {

/// By Imf::Compression, with the first OpenEXR that has it.
struct CompressionMethod {
    std::string_view name;
    std::string_view since;
    int lines_per_block = 1;  ///< of scan lines
    bool is_lossy = false;
};
inline constexpr std::array<CompressionMethod, 14> kCompressions = {{{"none", "1.0", 1},
                                                                     {"rle", "1.0", 1},
                                                                     {"zips", "1.0", 1},
                                                                     {"zip", "1.0", 16},
                                                                     {"piz", "1.0", 32},
                                                                     {"pxr24", "1.2", 16, true},
                                                                     {"b44", "1.4", 32, true},
                                                                     {"b44a", "1.4", 32, true},
                                                                     {"dwaa", "2.2", 32, true},
                                                                     {"dwab", "2.2", 256, true},
                                                                     {"htj2k256", "3.4", 256},
                                                                     {"htj2k32", "3.4", 32},
                                                                     {"lj2k", "3.5", 256, true},
                                                                     {"zstd", "3.5", 1}}};
/// Those that the library of this build reads and writes come first.
static_assert(kCompressions.size() >= Imf::NUM_COMPRESSION_METHODS);

inline constexpr int kMaxNameLength = 255;  ///< Imf::Name cuts longer ones without a word

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using FileHandle = std::unique_ptr<std::FILE, FileCloser>;

/// Throws Error(ErrorKind::capture) where `path` is missing or unreadable.
OpenFile open_exr(const std::filesystem::path& path);

/// A regular file as Imf reads it. Keeps its size, so that sizes claimed in it can be checked.
class FileStream final : public Imf::IStream {
public:
    /// Throws Error(ErrorKind::capture) where the file is empty or not a regular one.
    explicit FileStream(OpenFile file);

    bool read(char bytes[], int count) override;
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override;
    void clear() override;

    std::uint64_t byte_count() const { return size_; }
    /// Leaves the position as it is.
    void read_at(std::uint64_t offset, std::span<char> bytes);

private:
    FileHandle file_;
    std::uint64_t size_ = 0;
    std::uint64_t position_ = 0;
};

/// The same open file from its beginning, with a position of its own: for a second reader, which would find
/// another file under the path if that was replaced. [refers to the file]
class StreamView final : public Imf::IStream {
public:
    explicit StreamView(FileStream& file) : Imf::IStream(file.fileName()), file_(file) {}

    bool read(char bytes[], int count) override;
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

private:
    FileStream& file_;
    std::uint64_t position_ = 0;
};

/// The header of a file, read before the library allocates memory for the file.
struct FileLayout {
    bool multi_part = false;
    std::vector<Imf::Header> headers;
    std::vector<std::uint64_t> block_tables;  ///< byte position of each part's table of block offsets
    std::uint64_t largest_block_bytes = 0;    ///< decoded
    /// By part, the positions of its blocks; empty unless the tables are, and the blocks are whole.
    std::vector<std::vector<std::uint64_t>> found_blocks;
};

/// Walks the headers without keeping anything, and returns the version field; the file's position is then
/// their end. Throws Error(ErrorKind::capture) for sizes that the file cannot hold, for more parts, channels
/// or attributes than the limits, and for compressions that this build's library does not read.
int scan_headers(FileStream& file, const std::filesystem::path& path);
/// Reads the headers and holds them against the limits; throws Error(ErrorKind::capture).
FileLayout read_layout(FileStream& file, const std::filesystem::path& path, const ReadLimits& limits);

/// Every block of a flat part (of level 0 where tiled) lies whole in the file, has pixels and, where not
/// compressed, all of them: the library reads a short block as what its buffer held before. Throws
/// Error(ErrorKind::capture).
void check_blocks(FileStream& file, const std::filesystem::path& path, const FileLayout& layout, int part);

/// Where the blocks of a part (of level 0 where tiled) begin.
std::vector<std::uint64_t> part_offsets(FileStream& file, const FileLayout& layout, int part);

/// Fills the slices of `frame` from a part of scan lines that is stored as none, zips or zip, on this many of
/// the library's threads. Returns false where the part is of another kind or anything about it is not as it
/// should be: the slices may then hold anything, and the library reads it, or says what is wrong. Comes after
/// check_blocks.
bool read_scan_lines(FileStream& file, const FileLayout& layout, int part, const Imf::FrameBuffer& frame,
                     int threads);

/// Whether read_scan_lines and write_scan_lines take it: none, zips and zip.
bool is_scan_line_method(Imf::Compression method);

/// Writes a file of one part of scan lines as the library does, except for deflate's packing. The images have
/// the data window's size. Returns the values that halfs could not hold; throws as `stream` does.
std::vector<HalfOverflow> write_scan_lines(Imf::OStream& stream, const Imf::Header& header,
                                           std::span<const ExrOutputChannel> channels);
std::uint64_t scan_line_blocks(const Imf::Header& header);

/// Runs `work`, which shares the jobs out among its calls and does not throw, on this thread and as many of
/// the library's as make up to `threads`.
void run_on_threads(int threads, std::size_t jobs, const std::function<void()>& work);

/// An open file and what is known of it, for reading a deep part. [refers to the reader's]
struct DeepSource {
    const std::filesystem::path& path;
    const ReadLimits& limits;
    FileStream& stream;
    const FileLayout& layout;
    Imf::MultiPartInputFile& file;
};

/// The samples of the named channels of a deep part, level 0 where tiled. The sizes of the blocks and the
/// counts of samples are first checked against the file and the limits. Throws Error(ErrorKind::capture).
DeepImage read_deep(const DeepSource& source, int part, std::span<const std::string> names);

bool is_tiled_part(const Imf::Header& header);
/// Where the blocks of level 0 begin, out of the table at `table`.
std::vector<std::uint64_t> block_offsets(FileStream& file, const Imf::Header& header, std::uint64_t table);
/// One block of level 0: its pixels' rectangle, and "lines 32 to 47".
Imath::Box2i block_box(const Imf::Header& header, std::uint64_t index);
std::string block_label(const Imf::Header& header, std::uint64_t index);
void require_no_missing_block(const std::filesystem::path& path, const Imf::Header& header,
                              std::span<const std::uint64_t> offsets);

/// The first bytes of every file.
inline constexpr std::string_view kMagic = "\x76\x2f\x31\x01";

ExrPart describe_part(const Imf::Header& header);

/// "part 2 'left.depth'", or nothing to say where there is one part: then "the file".
std::string part_label(const std::vector<ExrPart>& parts, int part);

[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& what,
                              ErrorKind code = ErrorKind::capture) {
    throw Error(code, path.string() + ": " + printable(what));
}

/// The reason out of a message of the library, which repeats the file's name and ends with a full stop.
std::string library_reason(const std::exception& error);

/// Whether the library says by this that an allocation failed.
bool is_memory_text(std::string_view text);

/// Runs `work`; any exception leaves as Error(code), "<path>: <what>: <reason>", or as
/// Error(ErrorKind::memory).
template <class Work>
decltype(auto) translate_errors(const std::filesystem::path& path, ErrorKind code, const char* what,
                                Work&& work) {
    try {
        return std::forward<Work>(work)();
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) {
        // Running out of memory says nothing about the file; a length_error does. The library's threads pass
        // on text alone.
        if (dynamic_cast<const std::bad_alloc*>(&error) || is_memory_text(error.what()))
            fail(path, out_of_memory_text(std::bad_alloc()), ErrorKind::memory);
        fail(path, std::string(what) + ": " + library_reason(error), code);
    } catch (...) {
        fail(path, std::string(what) + ": unknown reason", code);
    }
}

Window to_window(const Imath::Box2i& box);
Imath::Box2i to_box(const Window& window);
Imf::PixelType to_imf(PixelType type);

}  // namespace exr
}  // namespace aftershade
