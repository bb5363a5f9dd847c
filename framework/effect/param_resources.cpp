#include "framework/effect/param_resources.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <map>
#include <utility>

#include "framework/base/error.h"
#include "framework/document/param_type.h"
#include "framework/file/picture.h"

namespace aftershade {

namespace {

// Where GLSL's std430 puts the members of a structure (OpenGL 4.5 core specification, section 7.6.2.2).

/// Adds members one by one. Sizes and offsets are in bytes.
class Std430Struct {
public:
    /// A member of 1 to 4 components of 4 bytes each; its offset. vec2 aligns to 8, vec3 and vec4 to 16.
    std::size_t add_vector(int components) {
        const std::size_t size = 4 * std::size_t(components);
        return add(size, components == 3 ? 16 : size);
    }
    /// A member that is a structure (or the first element of an array of it).
    std::size_t add_struct(const Std430Struct& member) { return add(member.size(), member.alignment_); }
    /// To the next element of an array of it.
    std::size_t size() const { return rounded(end_, alignment_); }

private:
    static std::size_t rounded(std::size_t value, std::size_t to) { return (value + to - 1) / to * to; }
    std::size_t add(std::size_t size, std::size_t alignment) {
        const std::size_t offset = rounded(end_, alignment);
        end_ = offset + size;
        alignment_ = std::max(alignment_, alignment);
        return offset;
    }
    std::size_t end_ = 0;
    std::size_t alignment_ = 4;
};

ParamTexture image_texture(const Image& image) {
    const auto texels = image.floats();
    return {image.width(), image.height(), 1, gpu::TextureFormat::rgba32f, {texels.begin(), texels.end()}};
}

ParamTexture table_texture(const ColorTransform& transform) {
    const int rows = int(transform.texels.size() / (std::size_t(kLutRow) * std::size_t(transform.channels)));
    const bool is_pairs = transform.channels == 2;
    return {kLutRow, rows, 1, is_pairs ? gpu::TextureFormat::rg32f : gpu::TextureFormat::rgba32f,
            transform.texels};
}

ParamTexture lut_texture(const Lut& lut) {
    ParamTexture texture;
    const bool is_cube = lut.dimensions == 3;
    texture.width = is_cube ? lut.size : std::min(lut.size, kLutRow);
    texture.height = is_cube ? lut.size : (lut.size + kLutRow - 1) / kLutRow;
    texture.layers = is_cube ? lut.size : 1;
    texture.texels.resize(std::size_t(texture.width) * std::size_t(texture.height) *
                          std::size_t(texture.layers) * 4);
    for (std::size_t i = 0; i < lut.values.size() / 3; ++i)
        std::copy_n(&lut.values[i * 3], 3, &texture.texels[i * 4]);
    return texture;
}

/// Ids first..last have the row of that index.
struct Entry {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    std::size_t row = 0;
};

std::map<std::uint32_t, std::size_t> rows_by_name(const TableValue& table, const ObjectIds& ids) {
    std::map<std::uint32_t, std::size_t> rows;
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const std::string& name = table.rows[i].first.name;
        if (name.empty()) continue;
        if (const auto id = ids(name)) rows.emplace(*id, i);
    }
    return rows;
}

/// Rising, none over another: a named object takes its id out of the range it lies in.
std::vector<Entry> sorted_entries(const TableValue& table, const ObjectIds& ids) {
    const auto named = rows_by_name(table, ids);
    std::vector<Entry> entries;
    for (const auto& [id, row] : named) entries.push_back({id, id, row});
    for (std::size_t i = 0; i < table.rows.size(); ++i) {
        const TableKey& key = table.rows[i].first;
        if (!key.name.empty()) continue;
        std::uint64_t first = key.first;  // one more than the last id must fit
        for (auto hole = named.lower_bound(key.first); hole != named.end() && hole->first <= key.last;
             ++hole) {
            if (hole->first > first) entries.push_back({std::uint32_t(first), hole->first - 1, i});
            first = std::uint64_t(hole->first) + 1;
        }
        if (first <= key.last) entries.push_back({std::uint32_t(first), key.last, i});
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return a.first < b.first; });
    return entries;
}

/// Writes the storage block that table_glsl declares.
class TableWriter {
public:
    TableWriter(const ParamSpec& spec, std::size_t entry_count) : spec_(spec) {
        for (const ParamSpec& column : spec.columns)
            cell_offsets_.push_back(row_.add_vector(component_count(column.type)));
        entry_.add_vector(1);
        entry_.add_vector(1);
        row_offset_ = entry_.add_struct(row_);
        Std430Struct block;
        block.add_vector(1);
        default_offset_ = block.add_struct(row_);
        entries_offset_ = block.add_struct(entry_);
        // A block's buffer holds at least one element of its last array.
        bytes_.resize(entries_offset_ + std::max<std::size_t>(entry_count, 1) * entry_.size());
        put(0, std::uint32_t(entry_count));
    }

    void put_default(const TableValue::Row& row) { put_row(default_offset_, row); }

    void put_entry(std::size_t index, std::uint32_t first, std::uint32_t last, const TableValue::Row& row) {
        const std::size_t at = entries_offset_ + index * entry_.size();
        put(at, first);
        put(at + 4, last);
        put_row(at + row_offset_, row);
    }

    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    template <typename T>
    void put(std::size_t at, T value) {
        static_assert(sizeof(T) == 4);
        std::memcpy(&bytes_[at], &value, sizeof(T));
    }

    void put_row(std::size_t at, const TableValue::Row& row) {
        for (std::size_t i = 0; i < spec_.columns.size(); ++i) {
            const bool is_integer = spec_.columns[i].type->is_integer;
            for (std::size_t c = 0; c < row[i].size(); ++c) {
                const std::size_t cell = at + cell_offsets_[i] + c * 4;
                if (is_integer) put(cell, std::int32_t(row[i][c]));
                else put(cell, float(row[i][c]));
            }
        }
    }

    const ParamSpec& spec_;
    Std430Struct row_;
    Std430Struct entry_;
    std::vector<std::size_t> cell_offsets_;
    std::size_t row_offset_ = 0;
    std::size_t default_offset_ = 0;
    std::size_t entries_offset_ = 0;
    std::vector<std::byte> bytes_;
};

/// `message` without the path that it begins with, which is the place already.
std::string without_path(const std::string& message, const std::string& path) {
    const std::string prefix = path + ": ";
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
}

}  // namespace

std::optional<ParamFile> load_param_file(const ParamSpec& spec, const std::filesystem::path& path,
                                         Diagnostics& diagnostics) {
    assert(is_file_type(spec.type) && !is_ocio_file(spec));
    if (path.empty()) return ParamFile{};
    if (spec.file_kind == FileKind::lut) {
        auto lut = read_lut(path, diagnostics);
        return lut ? std::optional<ParamFile>(std::move(*lut)) : std::nullopt;
    }
    try {
        return read_picture(path, spec.file_is_data ? PictureSpace::data : PictureSpace::srgb);
    } catch (const Error& error) {
        diagnostics.error({path.string()}, without_path(error.what(), path.string()));
        return std::nullopt;
    }
}

gpu::TextureFormat param_texture_format(int channels) {
    return channels == 1 ? gpu::TextureFormat::r32f : gpu::TextureFormat::rgba32f;
}

ParamTexture param_texture(const ParamSpec& spec, const ParamValue& value) {
    const TexelSize size = spec.type->texture->size(value);
    return {size.width, size.height, 1, param_texture_format(size.channels),
            spec.type->texture->texels(spec, value)};
}

ParamTexture file_texture(const ParamFile& file) {
    assert(file.index() != 0);
    if (const auto* lut = std::get_if<Lut>(&file)) return lut_texture(*lut);
    if (const auto* transform = std::get_if<ColorTransform>(&file)) return table_texture(*transform);
    return image_texture(std::get<Image>(file));
}

std::size_t table_buffer_bytes(const ParamSpec& spec, std::size_t entries) {
    return TableWriter(spec, entries).take().size();
}

std::vector<std::byte> table_buffer(const ParamSpec& spec, const TableValue& table, const ObjectIds& ids) {
    const std::vector<Entry> entries = sorted_entries(table, ids);
    TableWriter writer(spec, entries.size());
    writer.put_default(table.default_row);
    for (std::size_t i = 0; i < entries.size(); ++i)
        writer.put_entry(i, entries[i].first, entries[i].last, table.rows[entries[i].row].second);
    return writer.take();
}

}  // namespace aftershade
