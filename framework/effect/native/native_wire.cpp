#include "framework/effect/native/native_wire.h"

#include <algorithm>
#include <cstring>
#include <utility>
#include <variant>

#include "framework/base/error.h"
#include "framework/effect/param_types.h"

namespace aftershade {

namespace {

[[noreturn]] void broken() {
    throw Error(ErrorKind::effect, "the process of the plug-ins sent a message that a host never sends");
}

/// A number of an enum whose values are 0 to `most`.
template <class Enum>
Enum take_enum(WireReader& in, Enum most) {
    const std::int64_t value = in.number();
    if (value < 0 || value > std::int64_t(most)) broken();
    return Enum(value);
}

template <class Map, class Put>
void put_map(WireWriter& out, const Map& map, const Put& put_value) {
    out.number(std::int64_t(map.size()));
    for (const auto& [name, value] : map) {
        out.text(name);
        put_value(value);
    }
}

template <class Map, class Take>
void take_map(WireReader& in, Map& map, const Take& take_value) {
    for (std::size_t left = in.count(); left > 0; --left) {
        std::string name = in.text();
        map.insert_or_assign(std::move(name), take_value());
    }
}

void put_value(WireWriter& out, const ParamValue& value) {
    out.number(std::int64_t(value.index()));
    if (const auto* flag = std::get_if<bool>(&value)) out.flag(*flag);
    if (const auto* number = std::get_if<std::int64_t>(&value)) out.number(*number);
    if (const auto* real = std::get_if<double>(&value)) out.real(*real);
    if (const auto* text = std::get_if<std::string>(&value)) out.text(*text);
    if (const auto* vector = std::get_if<std::vector<double>>(&value)) {
        out.number(std::int64_t(vector->size()));
        for (const double each : *vector) out.real(each);
    }
}

ParamValue take_value(WireReader& in) {
    switch (in.number()) {
        case 0: return in.flag();
        case 1: return in.number();
        case 2: return in.real();
        case 3: return in.text();
        case 4: {
            std::vector<double> vector(in.count(sizeof(double)));
            for (double& each : vector) each = in.real();
            return vector;
        }
        default: return CurveValue{};
    }
}

void put_matrix(WireWriter& out, const std::optional<CameraMatrix>& matrix) {
    out.flag(matrix.has_value());
    if (matrix)
        for (const double each : *matrix) out.real(each);
}

std::optional<CameraMatrix> take_matrix(WireReader& in) {
    if (!in.flag()) return std::nullopt;
    CameraMatrix matrix{};
    for (double& each : matrix) each = in.real();
    return matrix;
}

template <class Scalar>
void put_scalars(WireWriter& out, const std::vector<Scalar>& values) {
    out.number(std::int64_t(values.size()));
    for (const Scalar value : values) {
        if constexpr (std::is_floating_point_v<Scalar>) out.real(double(value));
        else out.number(std::int64_t(value));
    }
}

template <class Scalar>
std::vector<Scalar> take_scalars(WireReader& in) {
    std::vector<Scalar> values(in.count(sizeof(std::int64_t)));
    for (Scalar& value : values) {
        if constexpr (std::is_floating_point_v<Scalar>) value = Scalar(in.real());
        else value = Scalar(in.number());
    }
    return values;
}

NativeUniform take_uniform(WireReader& in) {
    switch (in.number()) {
        case 0: return take_scalars<float>(in);
        case 1: return take_scalars<std::int32_t>(in);
        case 2: return take_scalars<std::uint32_t>(in);
        default: broken();
    }
}

NativeTable take_table(WireReader& in) {
    NativeTable table;
    table.element = take_enum(in, NativeElement::uvec4);
    table.width = int(in.number());
    table.height = int(in.number());
    const std::string bytes = in.text();
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    table.bytes.assign(first, first + bytes.size());
    return table;
}

}  // namespace

void WireWriter::number(std::int64_t value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void WireWriter::real(double value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void WireWriter::text(std::string_view value) {
    number(std::int64_t(value.size()));
    bytes_.append(value);
}

std::string_view WireReader::take(std::size_t bytes) {
    if (bytes > rest_.size()) broken();
    const std::string_view taken = rest_.substr(0, bytes);
    rest_.remove_prefix(bytes);
    return taken;
}

std::int64_t WireReader::number() {
    std::int64_t value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
}

double WireReader::real() {
    double value = 0;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
}

std::string WireReader::text() {
    return std::string(take(count()));
}

std::size_t WireReader::count(std::size_t bytes_each) {
    const std::int64_t count = number();
    if (count < 0 || std::uint64_t(count) > rest_.size() / bytes_each) broken();
    return std::size_t(count);
}

void WireReader::expect_end() const {
    if (!rest_.empty()) broken();
}

void put(WireWriter& out, const NativeDeclaration& declaration) {
    out.text(declaration.effect_id);
    out.text(declaration.effect_version);
    put_map(out, declaration.uniforms, [&](const NativeUniformType& type) {
        out.number(std::int64_t(type.scalar));
        out.number(type.components);
    });
    put_map(out, declaration.tables, [&](const NativeTableType& type) {
        out.number(std::int64_t(type.element));
        out.number(type.max_width);
        out.number(type.max_height);
    });
    out.number(std::int64_t(declaration.passes.size()));
    for (const std::string& pass : declaration.passes) out.text(pass);
}

NativeDeclaration take_declaration(WireReader& in) {
    NativeDeclaration declaration;
    declaration.effect_id = in.text();
    declaration.effect_version = in.text();
    take_map(in, declaration.uniforms, [&] {
        const auto scalar = take_enum(in, NativeScalar::uint_);
        return NativeUniformType{scalar, int(in.number())};
    });
    take_map(in, declaration.tables, [&] {
        const auto element = take_enum(in, NativeElement::uvec4);
        const int width = int(in.number());
        return NativeTableType{element, width, int(in.number())};
    });
    for (std::size_t left = in.count(); left > 0; --left) declaration.passes.push_back(in.text());
    return declaration;
}

void put(WireWriter& out, const NativeFrame& frame) {
    out.number(std::int64_t(frame.specs->size()));
    for (const ParamSpec& spec : *frame.specs) {
        out.text(spec.name);
        out.text(param_type_name(spec.type));
        out.text(spec.unit);
        put_value(out, frame.params->get(spec.name));
    }
    out.flag(frame.camera != nullptr);
    if (frame.camera) {
        put_map(out, frame.camera->values(), [&](double value) { out.real(value); });
        put_matrix(out, frame.camera->camera_from_world);
        put_matrix(out, frame.camera->ndc_from_world);
    }
    put_map(out, frame.metadata, [&](const std::string& text) { out.text(text); });
    out.number(std::int64_t(frame.images.size()));
    for (const NativeImage& image : frame.images) {
        out.text(image.name);
        out.text(image.role);
        for (const int each : {image.width_px, image.height_px, image.channels}) out.number(each);
        out.flag(image.present);
    }
    for (const int each :
         {frame.number, frame.width_px, frame.height_px, frame.display_width_px, frame.display_height_px})
        out.number(each);
    out.real(frame.fps);
    out.flag(frame.history_valid);
    out.number(frame.step_seed);
}

void take_frame(WireReader& in, WireFrame& wire) {
    for (std::size_t left = in.count(); left > 0; --left) {
        ParamSpec spec;
        spec.name = in.text();
        const std::string type = in.text();
        for (const ParamType known : param_types())
            if (param_type_name(known) == type) spec.type = known;
        spec.unit = in.text();
        wire.params.set(spec.name, take_value(in));
        wire.specs.push_back(std::move(spec));
    }
    NativeFrame& frame = wire.frame;
    frame.specs = &wire.specs;
    frame.params = &wire.params;
    if (in.flag()) {
        frame.camera = &wire.camera;
        for (std::size_t left = in.count(); left > 0; --left) {
            const std::string name = in.text();
            wire.camera.set(name, in.real());
        }
        wire.camera.camera_from_world = take_matrix(in);
        wire.camera.ndc_from_world = take_matrix(in);
    }
    take_map(in, frame.metadata, [&] { return in.text(); });
    for (std::size_t left = in.count(); left > 0; --left) {
        NativeImage image;
        image.name = in.text();
        image.role = in.text();
        for (int* each : {&image.width_px, &image.height_px, &image.channels}) *each = int(in.number());
        image.present = in.flag();
        frame.images.push_back(std::move(image));
    }
    for (int* each : {&frame.number, &frame.width_px, &frame.height_px, &frame.display_width_px,
                      &frame.display_height_px})
        *each = int(in.number());
    frame.fps = in.real();
    frame.history_valid = in.flag();
    frame.step_seed = std::uint32_t(in.number());
}

void put(WireWriter& out, const NativeResult& result) {
    put_map(out, result.uniforms, [&](const NativeUniform& uniform) {
        out.number(std::int64_t(uniform.index()));
        std::visit([&](const auto& values) { put_scalars(out, values); }, uniform);
    });
    put_map(out, result.tables, [&](const NativeTable& table) {
        out.number(std::int64_t(table.element));
        out.number(table.width);
        out.number(table.height);
        out.text({reinterpret_cast<const char*>(table.bytes.data()), table.bytes.size()});
    });
    put_map(out, result.repeats, [&](int count) { out.number(count); });
    put_map(out, result.enabled, [&](bool enabled) { out.flag(enabled); });
    out.number(result.warm_up_frames);
    out.number(result.overscan_px);
    out.number(std::int64_t(result.log.size()));
    for (const NativeLogLine& line : result.log) {
        out.number(std::int64_t(line.level));
        out.text(line.text);
    }
}

NativeResult take_result(WireReader& in) {
    NativeResult result;
    take_map(in, result.uniforms, [&] { return take_uniform(in); });
    take_map(in, result.tables, [&] { return take_table(in); });
    take_map(in, result.repeats, [&] { return int(in.number()); });
    take_map(in, result.enabled, [&] { return in.flag(); });
    result.warm_up_frames = int(in.number());
    result.overscan_px = int(in.number());
    for (std::size_t left = in.count(); left > 0; --left) {
        const auto level = take_enum(in, NativeLogLevel::error);
        result.log.push_back({level, in.text()});
    }
    return result;
}

}  // namespace aftershade
