#include "framework/file/exr_internal.h"

#include "framework/base/atomic_file.h"

#include <Imath/ImathBox.h>
#include <Imath/ImathMatrix.h>
#include <Imath/ImathVec.h>
#include <OpenEXR/ImfBoxAttribute.h>
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfChromaticitiesAttribute.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFloatVectorAttribute.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfMatrixAttribute.h>
#include <OpenEXR/ImfRationalAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfStringVectorAttribute.h>
#include <OpenEXR/ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

namespace aftershade {

namespace {

const Imf::Attribute* find_attribute(const std::shared_ptr<const ExrMetadata::Impl>& impl,
                                     const std::string& name) {
    if (!impl) return nullptr;
    const Imf::Header::ConstIterator found = impl->header.find(name);
    return found == impl->header.end() ? nullptr : &found.attribute();
}

template <class T>
const T* value_as(const Imf::Attribute& attribute) {
    const auto* typed = dynamic_cast<const Imf::TypedAttribute<T>*>(&attribute);
    return typed ? &typed->value() : nullptr;
}

bool describes_one_part(std::string_view name) {
    constexpr std::array<std::string_view, 18> kNames = {"channels",
                                                         "compression",
                                                         "dataWindow",
                                                         "displayWindow",
                                                         "lineOrder",
                                                         "name",
                                                         "pixelAspectRatio",
                                                         "screenWindowCenter",
                                                         "screenWindowWidth",
                                                         "tiles",
                                                         "type",
                                                         "view",
                                                         "version",
                                                         "chunkCount",
                                                         "preview",
                                                         "multiView",
                                                         "colorInteropID",
                                                         "maxSamplesPerPixel"};
    return std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

template <class Vector>
std::vector<float> components(const Vector& vector) {
    std::vector<float> result;
    for (unsigned i = 0; i < Vector::dimensions(); ++i) result.push_back(static_cast<float>(vector[int(i)]));
    return result;
}

template <class Matrix>
std::vector<float> rows(const Matrix& matrix) {
    std::vector<float> result;
    for (unsigned row = 0; row < Matrix::dimensions(); ++row) {
        for (unsigned column = 0; column < Matrix::dimensions(); ++column) {
            result.push_back(static_cast<float>(matrix[int(row)][int(column)]));
        }
    }
    return result;
}

std::optional<std::vector<float>> vector_value(const Imf::Attribute& attribute) {
    if (const auto* v = value_as<Imath::V2i>(attribute)) return components(*v);
    if (const auto* v = value_as<Imath::V2f>(attribute)) return components(*v);
    if (const auto* v = value_as<Imath::V3i>(attribute)) return components(*v);
    if (const auto* v = value_as<Imath::V3f>(attribute)) return components(*v);
    if (const auto* m = value_as<Imath::M33f>(attribute)) return rows(*m);
    if (const auto* m = value_as<Imath::M44f>(attribute)) return rows(*m);
    if (const auto* values = value_as<std::vector<float>>(attribute)) return *values;
    if (const auto* b = value_as<Imath::Box2i>(attribute)) {
        return std::vector<float>{float(b->min.x), float(b->min.y), float(b->max.x), float(b->max.y)};
    }
    if (const auto* c = value_as<Imf::Chromaticities>(attribute)) {
        return std::vector<float>{c->red.x,  c->red.y,  c->green.x, c->green.y,
                                  c->blue.x, c->blue.y, c->white.x, c->white.y};
    }
    return std::nullopt;
}

}  // namespace

bool is_exr_file(const std::filesystem::path& path) {
    return file_begins_with(path, exr::kMagic);
}

const std::vector<std::string>& exr_compression_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> known;
        for (int i = 0; i < Imf::NUM_COMPRESSION_METHODS; ++i)
            known.emplace_back(exr::kCompressions[std::size_t(i)].name);
        return known;
    }();
    return names;
}

std::string exr_flatten_remedy(const std::filesystem::path& path) {
    return "flatten it: oiiotool " + printed_command({path.string()}) + " --flatten -o OUT.exr";
}

std::optional<int> exr_compression_level(std::string_view text) {
    for (const std::string_view method : {"zip:", "zips:"}) {
        if (!text.starts_with(method) || text.size() != method.size() + 1) continue;
        const int level = text.back() - '0';
        if (level >= 1 && level <= 9) return level;
    }
    return {};
}

bool is_lossy_compression(std::string_view name) {
    const auto* found = std::ranges::find(exr::kCompressions, name, &exr::CompressionMethod::name);
    return found != exr::kCompressions.end() && found->is_lossy;
}

ExrMetadata::ExrMetadata() = default;

std::vector<std::string> ExrMetadata::names() const {
    std::vector<std::string> result;
    if (!impl) return result;
    for (auto i = impl->header.begin(); i != impl->header.end(); ++i) result.emplace_back(i.name());
    return result;
}

std::optional<ExrValue> ExrMetadata::value(const std::string& name) const {
    const Imf::Attribute* attribute = find_attribute(impl, name);
    if (!attribute) return std::nullopt;
    if (const auto* v = value_as<std::string>(*attribute)) return *v;
    if (const auto* v = value_as<int>(*attribute)) return *v;
    if (const auto* v = value_as<float>(*attribute)) return *v;
    if (const auto* v = value_as<double>(*attribute)) return static_cast<float>(*v);
    if (std::optional<std::vector<float>> v = vector_value(*attribute)) return std::move(*v);
    return std::nullopt;
}

void ExrMetadata::complete_from(const ExrMetadata& other, bool only_texts) {
    if (!other.impl) return;
    std::shared_ptr<Impl> merged;  // made when there is something to take over
    for (auto entry = other.impl->header.begin(); entry != other.impl->header.end(); ++entry) {
        const bool is_text = value_as<std::string>(entry.attribute()) != nullptr;
        if (describes_one_part(entry.name()) || (only_texts && !is_text) ||
            find_attribute(impl, entry.name()))
            continue;
        if (!merged) merged = impl ? std::make_shared<Impl>(*impl) : std::make_shared<Impl>();
        merged->header.insert(entry.name(), entry.attribute());
    }
    if (merged) impl = std::move(merged);
}

std::optional<std::string> ExrMetadata::text(const std::string& name) const {
    const Imf::Attribute* attribute = find_attribute(impl, name);
    const std::string* found = attribute ? value_as<std::string>(*attribute) : nullptr;
    return found ? std::optional<std::string>(*found) : std::nullopt;
}

std::optional<std::vector<std::string>> ExrMetadata::texts(const std::string& name) const {
    const Imf::Attribute* attribute = find_attribute(impl, name);
    const Imf::StringVector* found = attribute ? value_as<Imf::StringVector>(*attribute) : nullptr;
    return found ? std::optional<std::vector<std::string>>(*found) : std::nullopt;
}

std::optional<double> ExrMetadata::number(const std::string& name) const {
    const Imf::Attribute* attribute = find_attribute(impl, name);
    if (!attribute) return std::nullopt;
    if (const auto* v = value_as<int>(*attribute)) return *v;
    if (const auto* v = value_as<float>(*attribute)) return *v;
    if (const auto* v = value_as<double>(*attribute)) return *v;
    if (const auto* v = value_as<Imf::Rational>(*attribute)) {
        return v->d == 0 ? std::nullopt : std::optional<double>(double(*v));
    }
    const std::string* found = value_as<std::string>(*attribute);
    if (!found) return std::nullopt;
    double result = 0;
    const char* end = found->data() + found->size();
    const std::from_chars_result parsed = std::from_chars(found->data(), end, result);
    return parsed.ec == std::errc() && parsed.ptr == end ? std::optional<double>(result) : std::nullopt;
}

namespace exr {

Window to_window(const Imath::Box2i& box) {
    return {box.min.x, box.min.y, box.max.x, box.max.y};
}

Imath::Box2i to_box(const Window& window) {
    return {Imath::V2i(window.min_x, window.min_y), Imath::V2i(window.max_x, window.max_y)};
}

Imf::PixelType to_imf(PixelType type) {
    switch (type) {
        case PixelType::half: return Imf::HALF;
        case PixelType::float32: return Imf::FLOAT;
        case PixelType::uint32: return Imf::UINT;
    }
    return Imf::NUM_PIXELTYPES;
}

ExrPart describe_part(const Imf::Header& header) {
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    if (header.hasView()) part.view = header.view();
    if (header.hasType()) part.type = header.type();
    const auto compression = std::size_t(header.compression());
    part.compression = compression < kCompressions.size() ? kCompressions[compression].name : "unknown";
    part.data_window = to_window(header.dataWindow());
    part.display_window = to_window(header.displayWindow());
    part.pixel_aspect = header.pixelAspectRatio();
    part.has_smaller_levels = header.hasTileDescription() &&
                              header.tileDescription().mode != Imf::ONE_LEVEL && is_tiled_part(header);
    for (auto i = header.channels().begin(); i != header.channels().end(); ++i) {
        const Imf::Channel& channel = i.channel();
        const PixelType type = channel.type == Imf::HALF    ? PixelType::half
                               : channel.type == Imf::FLOAT ? PixelType::float32
                                                            : PixelType::uint32;
        part.channels.push_back({i.name(), type, channel.xSampling, channel.ySampling});
    }
    part.metadata.impl = std::make_shared<const ExrMetadata::Impl>(ExrMetadata::Impl{header});
    return part;
}

std::string part_label(const std::vector<ExrPart>& parts, int part) {
    if (parts.size() == 1) return "the file";
    return fmt::format("part {} '{}'", part, parts[std::size_t(part)].name);
}

namespace {

std::string reason_of(std::string reason) {
    const std::size_t name_end = reason.rfind("\". ");
    if (name_end != std::string::npos) reason.erase(0, name_end + 3);
    while (!reason.empty() && (reason.back() == '.' || reason.back() == ' ')) reason.pop_back();
    return reason.empty() ? "unknown reason" : reason;
}

}  // namespace

// Names in files and paths are in the library's messages, too, and may say anything.
bool is_memory_text(std::string_view text) {
    const std::string reason = reason_of(std::string(text));
    return reason == "std::bad_alloc" || reason.ends_with(" std::bad_alloc") ||
           reason.starts_with("Failed to allocate memory");
}

std::string library_reason(const std::exception& error) {
    return reason_of(error.what());
}

}  // namespace exr
Chromaticities stored_primaries(const ExrMetadata& metadata) {
    Chromaticities primaries = kRec709;
    const auto value = metadata.value("chromaticities");
    const auto* stored = value ? std::get_if<std::vector<float>>(&*value) : nullptr;
    if (stored && stored->size() == primaries.size())
        std::copy(stored->begin(), stored->end(), primaries.begin());
    return primaries;
}

}  // namespace aftershade
