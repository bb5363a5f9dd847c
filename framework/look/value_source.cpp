#include "framework/look/value_source.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/base/whole_number.h"
#include "framework/capture/cryptomatte.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/image/color_space.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr const char *kDepthSource = "depth", *kLuminanceSource = "luminance";

const char* source_of(PixelValue::Measure measure) {
    return measure == PixelValue::Measure::depth ? kDepthSource : kLuminanceSource;
}

const char* unit_of(PixelValue::Measure measure) {
    return measure == PixelValue::Measure::depth ? "m" : "ev";
}

struct SourceReader {
    const ParamSpec& spec;
    const std::string& label;
    Diagnostics& diagnostics;

    std::optional<ValueSource> keys(const Node& node) {
        ObjectReader reader(node, label, diagnostics);
        const Node* keys = reader.object("keys", ObjectReader::Presence::required);
        KeyedValue value;
        value.ease = read_ease(reader, label, diagnostics).value_or(Ease{});
        reader.finish();
        if (!keys) return std::nullopt;
        bool sound = !keys->members.empty();
        if (!sound) diagnostics.error(keys->place, label + ": 'keys' has no frame");
        if (spec.bind == ParamBind::define) {
            diagnostics.error(keys->place, label + " is compiled into the shader and cannot have keys");
            sound = false;
        }
        for (const Member& member : keys->members) {
            const auto frame = whole_number(member.key);
            if (!frame)
                diagnostics.error(member.key_place, label + ": '" + member.key + "' is not a frame number");
            auto parsed = eased_key(member.value);
            if (frame && parsed && value.keys.contains(*frame))
                diagnostics.error(member.key_place,
                                  label + ": frame " + std::to_string(*frame) + " has two keys");
            sound = sound && frame && parsed;
            if (frame && parsed) value.keys.insert_or_assign(*frame, std::move(*parsed));
        }
        return sound ? std::optional<ValueSource>(value) : std::nullopt;
    }

    std::optional<KeyedValue::Key> eased_key(const Node& node) {
        const bool has_ease = node.is_object() && node.find("value");
        if (!has_ease) {
            auto value = key(node);
            return value ? std::optional(KeyedValue::Key{std::move(*value), {}}) : std::nullopt;
        }
        ObjectReader reader(node, label, diagnostics);
        const Node* literal = reader.any("value");
        const auto ease = read_ease(reader, label, diagnostics);
        reader.finish();
        auto value = key(*literal);
        return value ? std::optional(KeyedValue::Key{std::move(*value), ease}) : std::nullopt;
    }

    std::optional<KeyValue> key(const Node& node) {
        if (node.is_object() && node.find("from")) return from(node);
        if (auto literal = parse_param_value(spec, node, label, diagnostics))
            return KeyValue(std::move(*literal));
        return std::nullopt;
    }

    std::optional<KeyValue> from(const Node& node) {
        ObjectReader reader(node, label, diagnostics);
        const auto source = reader.text("from", ObjectReader::Presence::required);
        if (!source) return std::nullopt;
        if (source == kDepthSource) return pixels(PixelValue::Measure::depth, reader, node);
        if (source == kLuminanceSource) return pixels(PixelValue::Measure::luminance, reader, node);
        reader.finish();
        std::vector<std::string> known = camera_sources(spec.type);
        known.insert(known.begin(), {kDepthSource, kLuminanceSource});
        const Place& place = node.find("from")->place;
        if (std::find(known.begin(), known.end(), *source) == known.end()) {
            diagnostics.error(place, label + ": " + unknown_source(*source, known));
            return std::nullopt;
        }
        const std::string field = source->substr(kFromCamera.size());
        if (spec.type->is_choice) return CameraValue{field};
        if (!is_scalar(place)) return std::nullopt;
        const CameraField& camera_field = *find_camera_field(field);
        if (!converts_to(camera_field, spec)) {
            const std::string& unit = camera_field.unit;
            diagnostics.error(place, label + ": " + *source + " is in " + (unit.empty() ? "no unit" : unit) +
                                         ", which cannot be converted to " +
                                         (spec.unit.empty() ? "a pure number" : spec.unit));
            return std::nullopt;
        }
        return CameraValue{field};
    }

    std::optional<KeyValue> pixels(PixelValue::Measure measure, ObjectReader& reader, const Node& node) {
        PixelValue value;
        value.measure = measure;
        const Node* uv = reader.array("uv");
        const Node* object = reader.any("object");
        reader.finish();
        if (!is_scalar(node.place)) return std::nullopt;
        const std::string source = source_of(measure), unit = unit_of(measure);
        if (!convert_unit(1, unit, spec.unit)) {
            diagnostics.error(node.place, label + ": " + source + " is in " + unit +
                                              ", which cannot be converted to " +
                                              (spec.unit.empty() ? "a pure number" : spec.unit));
            return std::nullopt;
        }
        if ((uv != nullptr) == (object != nullptr)) {
            diagnostics.error(node.place,
                              label + ": a value from " + source + " has one of 'uv' and 'object'");
            return std::nullopt;
        }
        if (uv) {
            const auto fits = [](const Node& n) { return n.is_number() && n.number >= 0 && n.number <= 1; };
            if (uv->items.size() != 2 || !fits(uv->items[0]) || !fits(uv->items[1])) {
                diagnostics.error(uv->place, label + ": 'uv' is two numbers from 0 to 1: right and down");
                return std::nullopt;
            }
            value.uv = {uv->items[0].number, uv->items[1].number};
            return value;
        }
        const int errors_before = diagnostics.error_count();
        value.objects = parse_object_keys(*object, label, diagnostics);
        if (diagnostics.error_count() > errors_before) return std::nullopt;
        return value;
    }

    bool is_scalar(const Place& place) {
        const bool scalar = is_scalar_type(spec.type);
        if (!scalar)
            diagnostics.error(place, label + " is a " + std::string(param_type_name(spec.type)) +
                                         ", which a single number of the capture cannot fill");
        return scalar;
    }
};

[[noreturn]] void refuse(const std::string& label, const CaptureHeader& header, const std::string& why) {
    throw Error(ErrorKind::capture, header.path.string() + ": " + label + ": " + why);
}

/// A number of the capture as a value of the parameter, which it must fit.
ParamValue fitted(double number, const ParamSpec& spec, const std::string& label, const std::string& origin,
                  const CaptureHeader& header) {
    if (!(number >= spec.min.value_or(number)) || !(number <= spec.max.value_or(number)))
        throw Error(ErrorKind::capture,
                    header.path.string() + ": " + origin + " is " + format_number(number) +
                        ", outside the range of " + label +
                        " (set the parameter in the look, or correct the capture's camera)");
    return value_of_numbers(spec, {number});
}

/// What a value takes of a pixel: metres, or the light's luminance. Not finite where it has none.
class Measured {
public:
    Measured(const PixelValue& value, const Capture& capture)
        : is_depth_(value.measure == PixelValue::Measure::depth),
          image_(capture.images.at(is_depth_ ? kDepthRole : kColorRole)),
          weights_(luminance_weights(capture.header.primaries)) {}

    double at(std::size_t pixel) const {
        if (is_depth_) return double(image_.floats()[pixel]);
        const float* light = &image_.floats()[pixel * std::size_t(image_.channels())];
        double luminance = 0;
        for (int c = 0; c < 3; ++c) luminance += weights_[std::size_t(c)] * double(light[c]);
        return luminance;
    }
    double at(int x, int y) const {
        return at(std::size_t(y) * std::size_t(image_.width()) + std::size_t(x));
    }

    /// In the source's unit: the grey card's 18 % is that of ISO 2720, which exposure meters are set to.
    double value(double measured) const { return is_depth_ ? measured : std::log2(0.18 / measured); }
    /// What a pixel without a value lacks.
    const char* lack() const { return is_depth_ ? "a depth" : "light"; }
    bool is_there(double measured) const { return std::isfinite(measured) && (is_depth_ || measured > 0); }

private:
    bool is_depth_;
    const Image& image_;
    std::array<double, 3> weights_;
};

/// By their coverage where they have names: so a look may name materials beside objects, which no single
/// object_id has.
RoleId role_of_objects(const std::vector<TableKey>& objects) {
    const bool has_name = std::ranges::any_of(objects, [](const TableKey& key) { return !key.name.empty(); });
    return has_name ? RoleId::coverage(objects) : kObjectIdRole;
}

/// The pixels that the objects cover by half or more.
std::vector<std::size_t> pixels_of_objects(const std::vector<TableKey>& objects, const Capture& capture) {
    std::vector<std::size_t> pixels;
    const auto coverage = capture.images.find(role_of_objects(objects));
    if (coverage != capture.images.end() && coverage->first.is_coverage()) {
        const auto shares = coverage->second.floats();
        for (std::size_t i = 0; i < shares.size(); ++i)
            if (shares[i] >= 0.5f) pixels.push_back(i);
        return pixels;
    }
    const std::vector<IdRange> wanted = id_ranges(objects);
    const auto ids = capture.images.at(kObjectIdRole).uints();
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (contains(wanted, ids[i])) pixels.push_back(i);
    return pixels;
}

double median_of_objects(const PixelValue& value, const std::string& label, const Capture& capture) {
    const Measured measured(value, capture);
    const std::vector<TableKey>& objects = value.objects;
    std::vector<double> found;
    for (const std::size_t pixel : pixels_of_objects(objects, capture))
        if (measured.is_there(measured.at(pixel))) found.push_back(measured.at(pixel));
    if (found.empty()) {
        const bool is_one = objects.size() == 1 && objects[0].first == objects[0].last;
        std::vector<std::string> names;
        for (const TableKey& key : objects) names.push_back(object_text(key));
        refuse(label, capture.header,
               joined(names, " and ") + (is_one ? " has" : " have") + " no pixel with " + measured.lack() +
                   " in this frame");
    }
    const auto middle = found.begin() + std::ptrdiff_t(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return measured.value(*middle);
}

double value_at_point(const PixelValue& value, const std::string& label, const Capture& capture) {
    const Window& display = capture.header.display_window;
    const Window& data = capture.header.data_window;
    const auto& uv = *value.uv;
    const int x = display.min_x + std::min(int(uv[0] * display.width()), display.width() - 1);
    const int y = display.min_y + std::min(int(uv[1] * display.height()), display.height() - 1);
    const std::string where = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    if (!data.contains(x, y)) refuse(label, capture.header, where + " is outside the data window");
    const Measured measured(value, capture);
    const double found = measured.at(x - data.min_x, y - data.min_y);
    if (!measured.is_there(found))
        refuse(label, capture.header,
               value.measure == PixelValue::Measure::depth ? "nothing was hit at " + where
                                                           : where + " has no light");
    return measured.value(found);
}

ValueSource as_source(const KeyValue& key) {
    return std::visit([](const auto& value) { return ValueSource(value); }, key);
}

ParamValue keyed_at(const KeyedValue& value, const ParamSpec& spec, const std::string& label,
                    const Capture& capture) {
    const int frame = capture.header.frame;
    const auto of = [&](const KeyedValue::Key& key) {
        return evaluate(as_source(key.value), spec, label, capture);
    };
    const auto after = value.keys.lower_bound(frame);
    if (after == value.keys.end()) return of(value.keys.rbegin()->second);
    if (after == value.keys.begin() || after->first == frame) return of(after->second);
    const auto before = std::prev(after);
    const Ease ease = before->second.ease.value_or(value.ease);
    if (ease.kind == Ease::Kind::step) return of(before->second);
    const double t = double(frame - before->first) / double(after->first - before->first);
    return interpolate(spec, of(before->second), of(after->second), ease.share(t));
}

}  // namespace

std::optional<ValueSource> parse_value_source(const ParamSpec& spec, const Node& node,
                                              const std::string& label, Diagnostics& diagnostics) {
    SourceReader reader{spec, label, diagnostics};
    if (node.is_object() && node.find("keys")) return reader.keys(node);
    if (const auto value = reader.key(node)) return as_source(*value);
    return std::nullopt;
}

std::vector<const PixelValue*> pixel_values(const ValueSource& source) {
    if (const auto* pixels = std::get_if<PixelValue>(&source)) return {pixels};
    std::vector<const PixelValue*> values;
    if (const auto* keyed = std::get_if<KeyedValue>(&source))
        for (const auto& [frame, key] : keyed->keys)
            if (const auto* pixels = std::get_if<PixelValue>(&key.value)) values.push_back(pixels);
    return values;
}

std::string format_source(const ValueSource& source) {
    if (const auto* value = std::get_if<ParamValue>(&source)) return format_value(*value);
    if (const auto* camera = std::get_if<CameraValue>(&source))
        return "{\"from\": \"camera." + camera->field + "\"}";
    if (const auto* pixels = std::get_if<PixelValue>(&source)) {
        const std::string begin = std::string("{\"from\": \"") + source_of(pixels->measure) + "\", ";
        if (pixels->uv)
            return begin + "\"uv\": [" + format_number((*pixels->uv)[0]) + ", " +
                   format_number((*pixels->uv)[1]) + "]}";
        return begin + "\"object\": " + format_object_keys(pixels->objects) + "}";
    }
    const auto& keyed = std::get<KeyedValue>(source);
    std::string text;
    for (const auto& [frame, key] : keyed.keys) {
        const std::string value = format_source(as_source(key.value));
        text += (text.empty() ? "" : ", ") + ("\"" + std::to_string(frame) + "\": ") +
                (key.ease ? "{\"value\": " + value + ", \"interpolation\": " + format_ease(*key.ease) + "}"
                          : value);
    }
    return "{\"keys\": {" + text + "}, \"interpolation\": " + format_ease(keyed.ease) + "}";
}

std::vector<RoleId> roles_of(const ValueSource& source) {
    std::vector<RoleId> roles;
    const auto add = [&](RoleId role) {
        if (std::ranges::find(roles, role) == roles.end()) roles.push_back(std::move(role));
    };
    for (const PixelValue* value : pixel_values(source)) {
        add(value->measure == PixelValue::Measure::depth ? kDepthRole : kColorRole);
        if (!value->objects.empty()) add(role_of_objects(value->objects));
    }
    return roles;
}

std::optional<ParamValue> camera_value(const ParamSpec& spec, const std::string& field,
                                       const std::string& label, const CaptureHeader& header) {
    if (spec.type->is_choice) {
        const std::string& name = header.camera.lens_model;
        if (name.empty()) return std::nullopt;
        if (std::find(spec.values.begin(), spec.values.end(), name) == spec.values.end())
            throw Error(ErrorKind::capture,
                        header.path.string() + ": camera." + field + " is '" + name +
                            "', outside the range of " + label +
                            " (set the parameter in the look, or correct the capture's camera)");
        return name;
    }
    auto number = header.camera.get(field);
    const std::string& unit = find_camera_field(field)->unit;
    if (number && unit != spec.unit) number = convert_unit(*number, unit, spec.unit);
    if (!number) return std::nullopt;
    return fitted(*number, spec, label, std::string(kFromCamera) + field, header);
}

ParamValue evaluate(const ValueSource& source, const ParamSpec& spec, const std::string& label,
                    const Capture& capture) {
    if (const auto* value = std::get_if<ParamValue>(&source)) return *value;
    if (const auto* keyed = std::get_if<KeyedValue>(&source)) return keyed_at(*keyed, spec, label, capture);
    if (const auto* camera = std::get_if<CameraValue>(&source)) {
        auto value = camera_value(spec, camera->field, label, capture.header);
        if (!value)
            refuse(label, capture.header,
                   "the capture has no camera." + camera->field +
                       "; give it in the capture.json's \"camera\", or a value in the look");
        return *value;
    }
    const auto& pixels = std::get<PixelValue>(source);
    for (const RoleId& role : roles_of(source))
        if (!capture.images.contains(role) && !(role.is_coverage() && capture.images.contains(kObjectIdRole)))
            refuse(label, capture.header,
                   "the capture has no " + (role.is_coverage() ? std::string(kObjectIdRole) : role.name()));
    const double value =
        pixels.uv ? value_at_point(pixels, label, capture) : median_of_objects(pixels, label, capture);
    return fitted(*convert_unit(value, unit_of(pixels.measure), spec.unit), spec, label,
                  source_of(pixels.measure), capture.header);
}

}  // namespace aftershade
