#include "framework/look/value_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/capture/cryptomatte.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

std::optional<int> frame_number(const std::string& text) {
    int number = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return number;
}

struct SourceReader {
    const ParamSpec& spec;
    const std::string& label;
    Diagnostics& diagnostics;

    std::optional<ValueSource> keys(const Node& node) {
        ObjectReader reader(node, label, diagnostics);
        const Node* keys = reader.object("keys", ObjectReader::Presence::required);
        const auto interpolation =
            reader.choice("interpolation", std::vector<std::string>{"linear", "smooth", "step"});
        reader.finish();
        if (!keys) return std::nullopt;
        KeyedValue value;
        if (interpolation == "smooth") value.interpolation = KeyedValue::Interpolation::smooth;
        if (interpolation == "step") value.interpolation = KeyedValue::Interpolation::step;
        bool sound = !keys->members.empty();
        if (!sound) diagnostics.error(keys->place, label + ": 'keys' has no frame");
        if (spec.bind == ParamBind::define) {
            diagnostics.error(keys->place, label + " is compiled into the shader and cannot have keys");
            sound = false;
        }
        for (const Member& member : keys->members) {
            const auto frame = frame_number(member.key);
            if (!frame)
                diagnostics.error(member.key_place, label + ": '" + member.key + "' is not a frame number");
            const auto parsed = parse_param_value(spec, member.value, label, diagnostics);
            if (frame && parsed && value.keys.contains(*frame))
                diagnostics.error(member.key_place,
                                  label + ": frame " + std::to_string(*frame) + " has two keys");
            sound = sound && frame && parsed;
            if (frame && parsed) value.keys[*frame] = *parsed;
        }
        return sound ? std::optional<ValueSource>(value) : std::nullopt;
    }

    std::optional<ValueSource> from(const Node& node) {
        ObjectReader reader(node, label, diagnostics);
        const auto source = reader.text("from", ObjectReader::Presence::required);
        if (!source) return std::nullopt;
        if (source == "depth") return depth(reader, node);
        reader.finish();
        std::vector<std::string> known = camera_sources(spec.type);
        known.insert(known.begin(), "depth");
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

    std::optional<ValueSource> depth(ObjectReader& reader, const Node& node) {
        DepthValue value;
        const Node* uv = reader.array("uv");
        const Node* object = reader.any("object");
        reader.finish();
        if (!is_scalar(node.place)) return std::nullopt;
        if (!convert_unit(1, "m", spec.unit)) {
            diagnostics.error(node.place, label + ": depth is in m, which cannot be converted to " +
                                              (spec.unit.empty() ? "a pure number" : spec.unit));
            return std::nullopt;
        }
        if ((uv != nullptr) == (object != nullptr)) {
            diagnostics.error(node.place, label + ": a value from depth has one of 'uv' and 'object'");
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

double median_depth_m(const std::vector<TableKey>& objects, const std::string& label,
                      const Capture& capture) {
    const std::vector<IdRange> wanted = id_ranges(objects);
    const auto ids = capture.images.at(kObjectIdRole).uints();
    const auto depths = capture.images.at(kDepthRole).floats();
    std::vector<float> found;
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (std::isfinite(depths[i]) && contains(wanted, ids[i])) found.push_back(depths[i]);
    if (found.empty()) {
        const bool is_one = objects.size() == 1 && objects[0].first == objects[0].last;
        std::vector<std::string> names;
        for (const TableKey& key : objects) names.push_back(object_text(key));
        refuse(label, capture.header,
               joined(names, " and ") + (is_one ? " has" : " have") + " no pixel with a depth in this frame");
    }
    const auto middle = found.begin() + std::ptrdiff_t(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    return double(*middle);
}

double depth_at_m(const std::array<double, 2>& uv, const std::string& label, const Capture& capture) {
    const Window& display = capture.header.display_window;
    const Window& data = capture.header.data_window;
    const int x = display.min_x + std::min(int(uv[0] * display.width()), display.width() - 1);
    const int y = display.min_y + std::min(int(uv[1] * display.height()), display.height() - 1);
    const std::string where = "pixel (" + std::to_string(x) + ", " + std::to_string(y) + ")";
    if (!data.contains(x, y)) refuse(label, capture.header, where + " is outside the data window");
    const float depth = capture.images.at(kDepthRole).at(x - data.min_x, y - data.min_y, 0);
    if (!std::isfinite(depth)) refuse(label, capture.header, "nothing was hit at " + where);
    return double(depth);
}

ParamValue keyed_at(const KeyedValue& value, const ParamSpec& spec, int frame) {
    const auto after = value.keys.lower_bound(frame);
    if (after == value.keys.end()) return value.keys.rbegin()->second;
    if (after == value.keys.begin() || after->first == frame) return after->second;
    const auto before = std::prev(after);
    if (value.interpolation == KeyedValue::Interpolation::step) return before->second;
    double t = double(frame - before->first) / double(after->first - before->first);
    if (value.interpolation == KeyedValue::Interpolation::smooth) t = t * t * (3 - 2 * t);
    return interpolate(spec, before->second, after->second, t);
}

}  // namespace

std::optional<ValueSource> parse_value_source(const ParamSpec& spec, const Node& node,
                                              const std::string& label, Diagnostics& diagnostics) {
    SourceReader reader{spec, label, diagnostics};
    if (node.is_object() && node.find("keys")) return reader.keys(node);
    if (node.is_object() && node.find("from")) return reader.from(node);
    if (auto value = parse_param_value(spec, node, label, diagnostics)) return ValueSource(std::move(*value));
    return std::nullopt;
}

std::string format_source(const ValueSource& source) {
    if (const auto* value = std::get_if<ParamValue>(&source)) return format_value(*value);
    if (const auto* camera = std::get_if<CameraValue>(&source))
        return "{\"from\": \"camera." + camera->field + "\"}";
    if (const auto* depth = std::get_if<DepthValue>(&source)) {
        const std::string begin = "{\"from\": \"depth\", ";
        if (depth->uv)
            return begin + "\"uv\": [" + format_number((*depth->uv)[0]) + ", " +
                   format_number((*depth->uv)[1]) + "]}";
        return begin + "\"object\": " + format_object_keys(depth->objects) + "}";
    }
    const auto& keyed = std::get<KeyedValue>(source);
    std::string text;
    for (const auto& [frame, value] : keyed.keys)
        text += (text.empty() ? "" : ", ") + ("\"" + std::to_string(frame) + "\": ") + format_value(value);
    const std::array<std::string, 3> names = {"linear", "smooth", "step"};
    return "{\"keys\": {" + text + "}, \"interpolation\": \"" + names[std::size_t(keyed.interpolation)] +
           "\"}";
}

std::vector<std::string> roles_of(const ValueSource& source) {
    const auto* depth = std::get_if<DepthValue>(&source);
    if (!depth) return {};
    if (!depth->objects.empty()) return {kDepthRole, kObjectIdRole};
    return {kDepthRole};
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
    if (const auto* keyed = std::get_if<KeyedValue>(&source))
        return keyed_at(*keyed, spec, capture.header.frame);
    if (const auto* camera = std::get_if<CameraValue>(&source)) {
        auto value = camera_value(spec, camera->field, label, capture.header);
        if (!value)
            refuse(label, capture.header,
                   "the capture has no camera." + camera->field +
                       "; give it in the capture.json's \"camera\", or a value in the look");
        return *value;
    }
    const auto& depth = std::get<DepthValue>(source);
    for (const std::string& role : roles_of(source))
        if (!capture.images.contains(role)) refuse(label, capture.header, "the capture has no " + role);
    const double depth_m =
        depth.uv ? depth_at_m(*depth.uv, label, capture) : median_depth_m(depth.objects, label, capture);
    return fitted(*convert_unit(depth_m, "m", spec.unit), spec, label, "depth", capture.header);
}

}  // namespace aftershade
