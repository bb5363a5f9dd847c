// What a file claims, checked before the library believes it: OpenEXR 3.1 allocates attributes, block tables
// and decoding buffers from the sizes in the file, and fills what a short block lacks with what its buffers
// held before.
#include "framework/file/exr_internal.h"

#include <Imath/ImathBox.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfVersion.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace aftershade::exr {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "EXR files are read here as little-endian");

bool is_tiled_part(const Imf::Header& header) {
    return header.hasType() && Imf::isTiled(header.type());
}

namespace {

std::int64_t side(int first, int last) {
    return std::int64_t(last) - first + 1;
}

void check_window(const fs::path& path, const char* what, const Imath::Box2i& box, const ReadLimits& limits) {
    const std::int64_t width = side(box.min.x, box.max.x);
    const std::int64_t height = side(box.min.y, box.max.y);
    if (width < 1 || height < 1) {
        fail(path, fmt::format("{} ({}, {})-({}, {}) holds no pixel", what, box.min.x, box.min.y, box.max.x,
                               box.max.y));
    }
    if (width > limits.max_side_px || height > limits.max_side_px) {
        fail(path, fmt::format("{} is {} x {} px, the limit is {} px a side (crop it or scale it down)", what,
                               width, height, limits.max_side_px));
    }
}

int lines_per_block(Imf::Compression compression) {
    const auto method = std::size_t(compression);
    return method < kCompressions.size() ? kCompressions[method].lines_per_block : 1;
}

std::uint64_t bytes_per_pixel(const Imf::Header& header) {
    std::uint64_t bytes = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        bytes += i.channel().type == Imf::HALF ? 2 : 4;
    }
    return bytes;
}

std::uint64_t block_bytes(const Imf::Header& header) {
    const Imath::Box2i& box = header.dataWindow();
    if (is_tiled_part(header)) {
        const Imf::TileDescription& tiles = header.tileDescription();
        return std::uint64_t(tiles.xSize) * tiles.ySize * bytes_per_pixel(header);
    }
    const std::int64_t lines =
        std::min<std::int64_t>(lines_per_block(header.compression()), side(box.min.y, box.max.y));
    return std::uint64_t(side(box.min.x, box.max.x)) * std::uint64_t(lines) * bytes_per_pixel(header);
}

/// The library calls it a damaged header where the samples of a subsampled channel do not begin with the data
/// window, or do not fill it; and where tiles are subsampled at all.
void check_samplings(const fs::path& path, const Imf::Header& header) {
    const Imath::Box2i& box = header.dataWindow();
    const auto fits = [](int first, int last, int sampling) {
        return first % sampling == 0 && side(first, last) % sampling == 0;
    };
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        const Imf::Channel& channel = i.channel();
        const int x = channel.xSampling, y = channel.ySampling;
        if (x < 1 || y < 1 || (x == 1 && y == 1)) continue;  // what is below 1 is damage
        const bool fills_window = fits(box.min.x, box.max.x, x) && fits(box.min.y, box.max.y, y);
        if (fills_window && !is_tiled_part(header)) continue;
        const std::string why =
            is_tiled_part(header)
                ? "and its file is tiled"
                : fmt::format(
                      "which does not divide the data window ({}, {})-({}, {}), {} x {} px from ({}, {})",
                      box.min.x, box.min.y, box.max.x, box.max.y, side(box.min.x, box.max.x),
                      side(box.min.y, box.max.y), box.min.x, box.min.y);
        fail(path,
             fmt::format("channel '{}' has a sampling of {} x {}, {}; OpenEXR does not read that (write "
                         "the file with a sampling of 1 x 1)",
                         i.name(), x, y, why));
    }
}

void check_part(const fs::path& path, const Imf::Header& header, const ReadLimits& limits) {
    check_window(path, "data window", header.dataWindow(), limits);
    check_window(path, "display window", header.displayWindow(), limits);
    if (is_tiled_part(header) && header.hasTileDescription()) {
        const Imf::TileDescription& tiles = header.tileDescription();
        if (std::max(tiles.xSize, tiles.ySize) > unsigned(limits.max_side_px)) {
            fail(path, fmt::format("tiles are {} x {} px, the limit is {} px a side", tiles.xSize,
                                   tiles.ySize, limits.max_side_px));
        }
    }
    check_samplings(path, header);
    header.sanityCheck(is_tiled_part(header));
    if (block_bytes(header) > limits.max_image_bytes) {
        fail(
            path,
            fmt::format(
                "one block of pixels takes {} bytes decoded, the limit is {} (write it with smaller tiles or "
                "another compression)",
                block_bytes(header), limits.max_image_bytes));
    }
}

int level_count(int size, Imf::LevelRoundingMode rounding) {
    const auto value = unsigned(size);
    return rounding == Imf::ROUND_UP ? std::bit_width(value - 1) + 1 : std::bit_width(value);
}

std::uint64_t tiles_across(int size, int level, unsigned tile, Imf::LevelRoundingMode rounding) {
    const std::uint64_t divisor = std::uint64_t(1) << level;
    const std::uint64_t rounded =
        rounding == Imf::ROUND_UP ? std::uint64_t(size) + divisor - 1 : std::uint64_t(size);
    return (std::max<std::uint64_t>(1, rounded / divisor) + tile - 1) / tile;
}

std::uint64_t tile_count(const Imf::TileDescription& tiles, int width, int height) {
    const Imf::LevelRoundingMode rounding = tiles.roundingMode;
    const auto count = [&](int x_level, int y_level) {
        return tiles_across(width, x_level, tiles.xSize, rounding) *
               tiles_across(height, y_level, tiles.ySize, rounding);
    };
    if (tiles.mode == Imf::ONE_LEVEL) return count(0, 0);
    std::uint64_t result = 0;
    if (tiles.mode == Imf::MIPMAP_LEVELS) {
        for (int level = 0; level < level_count(std::max(width, height), rounding); ++level)
            result += count(level, level);
        return result;
    }
    for (int y = 0; y < level_count(height, rounding); ++y) {
        for (int x = 0; x < level_count(width, rounding); ++x) result += count(x, y);
    }
    return result;
}

std::uint64_t block_count(const Imf::Header& header) {
    if (header.hasType() && !Imf::isSupportedType(header.type())) {
        return header.hasChunkCount() ? std::uint64_t(std::max(0, header.chunkCount())) : 0;
    }
    const Imath::Box2i& box = header.dataWindow();
    const int width = int(side(box.min.x, box.max.x));
    const int height = int(side(box.min.y, box.max.y));
    if (is_tiled_part(header)) return tile_count(header.tileDescription(), width, height);
    const int lines = lines_per_block(header.compression());
    return std::uint64_t((height + lines - 1) / lines);
}

}  // namespace

Imath::Box2i block_box(const Imf::Header& header, std::uint64_t index) {
    const Imath::Box2i& all = header.dataWindow();
    Imath::Box2i box = all;
    if (!is_tiled_part(header)) {
        const int lines = lines_per_block(header.compression());
        box.min.y = all.min.y + int(index) * lines;
        box.max.y = std::min(all.max.y, box.min.y + lines - 1);
        return box;
    }
    const Imf::TileDescription& tiles = header.tileDescription();
    const std::uint64_t across = (std::uint64_t(side(all.min.x, all.max.x)) + tiles.xSize - 1) / tiles.xSize;
    box.min = all.min + Imath::V2i(int(index % across * tiles.xSize), int(index / across * tiles.ySize));
    box.max.x = std::min(all.max.x, box.min.x + int(tiles.xSize) - 1);
    box.max.y = std::min(all.max.y, box.min.y + int(tiles.ySize) - 1);
    return box;
}

std::string block_label(const Imf::Header& header, std::uint64_t index) {
    const Imath::Box2i box = block_box(header, index);
    if (!is_tiled_part(header)) return fmt::format("lines {} to {}", box.min.y, box.max.y);
    return fmt::format("the tile at ({}, {})", box.min.x, box.min.y);
}

std::uint64_t scan_line_blocks(const Imf::Header& header) {
    return block_count(header);
}

std::vector<std::uint64_t> block_offsets(FileStream& file, const Imf::Header& header, std::uint64_t table) {
    std::uint64_t count = 0;
    if (is_tiled_part(header)) {
        const Imath::Box2i& box = header.dataWindow();
        Imf::TileDescription level_0 = header.tileDescription();
        level_0.mode = Imf::ONE_LEVEL;
        count = tile_count(level_0, int(side(box.min.x, box.max.x)), int(side(box.min.y, box.max.y)));
    } else {
        count = block_count(header);
    }
    std::vector<std::uint64_t> offsets(count);
    file.read_at(table, {reinterpret_cast<char*>(offsets.data()), offsets.size() * sizeof(std::uint64_t)});
    return offsets;
}

namespace {

/// Fewer bytes than this cannot hold the block's pixels.
std::uint64_t least_stored_bytes(const Imf::Header& header, std::uint64_t index) {
    if (header.compression() != Imf::NO_COMPRESSION) return 1;
    const Imath::Box2i box = block_box(header, index);
    std::uint64_t bytes = 0;
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        const Imf::Channel& channel = i.channel();
        if (!is_tiled_part(header) && box.min.y % channel.ySampling != 0) continue;
        const std::uint64_t samples = std::uint64_t(side(box.min.x, box.max.x) / channel.xSampling) *
                                      std::uint64_t(side(box.min.y, box.max.y));
        bytes += samples * (channel.type == Imf::HALF ? 2 : 4);
    }
    return bytes;
}

void check_block(FileStream& file, const fs::path& path, const Imf::Header& header, std::uint64_t index,
                 std::uint64_t offset, std::size_t head_words) {
    const auto cut_off = [&] {
        fail(path, fmt::format("cut off or damaged: the file has {} bytes, {} should reach beyond that",
                               file.byte_count(), block_label(header, index)));
    };
    if (offset > file.byte_count() || file.byte_count() - offset < head_words * 4) cut_off();
    std::array<std::int32_t, 6> head = {};
    file.read_at(offset, {reinterpret_cast<char*>(head.data()), head_words * 4});
    const std::int64_t stored = head[head_words - 1];
    if (stored < 0 || std::uint64_t(stored) < least_stored_bytes(header, index)) {
        fail(path, fmt::format("damaged: {} stored in {} bytes, too few for the pixels",
                               block_label(header, index), stored));
    }
    if (std::uint64_t(stored) > file.byte_count() - offset - head_words * 4) cut_off();
}

/// Of a block's head: a part number, then a line or a tile's two coordinates and two levels, then the size;
/// all of 4 bytes.
std::size_t head_words(const FileLayout& layout, const Imf::Header& header) {
    return (layout.multi_part ? 1u : 0u) + (is_tiled_part(header) ? 4u : 1u) + 1u;
}

bool has_empty_table(FileStream& file, const FileLayout& layout) {
    for (std::size_t part = 0; part < layout.headers.size(); ++part) {
        std::uint64_t first = 0;
        const std::uint64_t count = block_count(layout.headers[part]);
        if (count > 0)
            file.read_at(layout.block_tables[part], {reinterpret_cast<char*>(&first), sizeof first});
        if (first != 0) return false;
        std::vector<std::uint64_t> offsets(count);
        file.read_at(layout.block_tables[part],
                     {reinterpret_cast<char*>(offsets.data()), offsets.size() * sizeof(std::uint64_t)});
        if (std::ranges::any_of(offsets, [](std::uint64_t offset) { return offset != 0; })) return false;
    }
    return true;
}

/// The blocks of a file whose writer left its tables empty, walked from the end of the tables; {} where they
/// do not add up to whole parts of scan lines.
std::vector<std::vector<std::uint64_t>> found_blocks(FileStream& file, const FileLayout& layout,
                                                     std::uint64_t position) {
    std::vector<std::vector<std::uint64_t>> found;
    std::uint64_t missing = 0;
    for (const Imf::Header& header : layout.headers) {
        if (is_tiled_part(header) || (header.hasType() && header.type() != Imf::SCANLINEIMAGE)) return {};
        found.emplace_back(block_count(header));
        missing += found.back().size();
    }
    for (; missing > 0; --missing) {
        std::array<std::int32_t, 3> head = {};
        const std::size_t words = layout.multi_part ? 3 : 2;
        if (file.byte_count() - position < words * 4) return {};
        file.read_at(position, {reinterpret_cast<char*>(head.data()), words * 4});
        const std::size_t part = layout.multi_part ? std::size_t(std::uint32_t(head[0])) : 0;
        if (part >= found.size()) return {};
        const Imf::Header& header = layout.headers[part];
        const std::int64_t line = std::int64_t(head[words - 2]) - header.dataWindow().min.y;
        const std::int64_t lines = lines_per_block(header.compression());
        if (line < 0 || line % lines != 0 || std::uint64_t(line / lines) >= found[part].size()) return {};
        std::uint64_t& offset = found[part][std::size_t(line / lines)];
        if (offset != 0 || head[words - 1] < 0) return {};
        offset = position;
        position += words * 4 + std::uint64_t(head[words - 1]);
        if (position > file.byte_count()) return {};
    }
    return found;
}

}  // namespace

FileLayout read_layout(FileStream& file, const fs::path& path, const ReadLimits& limits) {
    int version = scan_headers(file, path);
    const std::uint64_t headers_end = file.tellg();
    FileLayout layout;
    layout.multi_part = Imf::isMultiPart(version);
    file.seekg(8);
    while (true) {
        Imf::Header header;
        header.readFrom(file, version);
        if (header.readsNothing()) break;
        // As the library does: the version field decides for flat single-part files, whatever the attribute
        // says.
        const bool flat_single = !layout.multi_part && !Imf::isNonImage(version);
        if (flat_single || !header.hasType()) {
            header.setType(Imf::isTiled(version) ? Imf::TILEDIMAGE : Imf::SCANLINEIMAGE);
        }
        check_part(path, header, limits);
        layout.headers.push_back(header);
        if (!layout.multi_part) break;
    }
    if (file.tellg() != headers_end)
        fail(path, "damaged header: its attributes do not end where their sizes say");
    std::uint64_t table = headers_end;
    for (const Imf::Header& header : layout.headers) {
        layout.block_tables.push_back(table);
        table += block_count(header) * sizeof(std::uint64_t);
        layout.largest_block_bytes = std::max(layout.largest_block_bytes, block_bytes(header));
    }
    if (table > file.byte_count()) {
        fail(path, fmt::format("cut off: the file has {} bytes, its headers and block tables take {}",
                               file.byte_count(), table));
    }
    if (has_empty_table(file, layout)) layout.found_blocks = found_blocks(file, layout, table);
    file.seekg(0);
    return layout;
}

void require_no_missing_block(const fs::path& path, const Imf::Header& header,
                              std::span<const std::uint64_t> offsets) {
    const auto missing = std::uint64_t(std::ranges::count(offsets, std::uint64_t(0)));
    if (missing == 0) return;
    const auto first = std::uint64_t(std::ranges::find(offsets, std::uint64_t(0)) - offsets.begin());
    fail(path, fmt::format(
                   "incomplete: {} of {} blocks are missing, the first is {} (its writer was stopped; write "
                   "it again)",
                   missing, offsets.size(), block_label(header, first)));
}

std::vector<std::uint64_t> part_offsets(FileStream& file, const FileLayout& layout, int part) {
    const auto index = std::size_t(part);
    return layout.found_blocks.empty()
               ? block_offsets(file, layout.headers[index], layout.block_tables[index])
               : layout.found_blocks[index];
}

void check_blocks(FileStream& file, const fs::path& path, const FileLayout& layout, int part) {
    const Imf::Header& header = layout.headers[std::size_t(part)];
    const std::vector<std::uint64_t> offsets = part_offsets(file, layout, part);
    require_no_missing_block(path, header, offsets);
    const std::size_t words = head_words(layout, header);
    for (std::uint64_t i = 0; i < offsets.size(); ++i) {
        check_block(file, path, header, i, offsets[i], words);
    }
}

}  // namespace aftershade::exr
