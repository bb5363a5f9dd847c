#include "framework/look/object_matches.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::size_t kMaxIds = 64;                // kept for the message
constexpr std::size_t kShownIds = 8;               // in the message
constexpr std::size_t kShownObjects = 8;           // likewise
constexpr std::uint32_t kSmallestHash = 1u << 23;  // of a name: the exponent is never 0
constexpr double kLeastWidth_px = 0.1;

/// Sorted, each once. Neighbours are mostly of one object.
std::vector<std::uint32_t> distinct_ids(const Image& image) {
    std::vector<std::uint32_t> ids;
    for (const std::uint32_t id : image.uints())
        if (ids.empty() || ids.back() != id) ids.push_back(id);
    std::ranges::sort(ids);
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    return ids;
}

bool are_named(const std::vector<TableKey>& keys) {
    return std::ranges::any_of(keys, [](const TableKey& key) { return !key.name.empty(); });
}

/// "object 3, 'Wheel' and 2 more"
std::string list_of_objects(const std::vector<TableKey>& keys) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(keys.size(), kShownObjects); ++i)
        texts.push_back(object_text(keys[i]));
    if (keys.size() > kShownObjects) texts.push_back(std::to_string(keys.size() - kShownObjects) + " more");
    return joined(texts, " and ");
}

}  // namespace

namespace {

std::vector<ParamValue> values_of(const PipelineStep& step, const std::string& param) {
    for (const ParamSpec& spec : step.manifest->params)
        if (spec.name == param) return step.known_values(spec);
    return {};
}

/// The focal length over the sensor width, from the step's parameters; 0 where it has no such parameters.
double focal_per_width(const PipelineStep& step) {
    double focal_length_mm = 0, sensor_width_mm = 0;
    for (const ParamSpec& spec : step.manifest->params) {
        const bool is_focal_length = spec.from == "camera.focal_length";
        if (!is_focal_length && spec.from != "camera.sensor_width") continue;
        const std::vector<ParamValue> values = step.known_values(spec);
        if (values.empty()) return 0;
        (is_focal_length ? focal_length_mm : sensor_width_mm) = std::get<double>(values.front());
    }
    return sensor_width_mm > 0 ? focal_length_mm / sensor_width_mm : 0;
}

/// 0 where the projection has none: it is parallel, or not known.
double focal_length_px(const CaptureHeader& header, double otherwise_per_width) {
    const int width = header.display_window.width();
    const Camera& camera = header.camera;
    if (camera.camera_from_world && camera.ndc_from_world) {
        const CameraMatrix &view = *camera.camera_from_world, &ndc = *camera.ndc_from_world;
        const auto dot = [&](std::size_t of_ndc, std::size_t of_view) {
            double sum = 0;
            for (std::size_t k = 0; k < 3; ++k) sum += ndc[4 * of_ndc + k] * view[4 * of_view + k];
            return sum;
        };
        const double w_per_z = std::abs(dot(3, 2));
        return w_per_z > 0 ? std::abs(dot(0, 0)) / w_per_z * width / 2 : 0;
    }
    const auto focal_length_mm = camera.get("focal_length"), sensor_width_mm = camera.get("sensor_width");
    const bool is_known = focal_length_mm && sensor_width_mm && *sensor_width_mm > 0;
    return width * (is_known ? *focal_length_mm / *sensor_width_mm : otherwise_per_width);
}

}  // namespace

ObjectMatches::ObjectMatches(const Pipeline& pipeline) {
    const auto add = [&](const Place& place, const std::string& user, std::vector<TableKey> keys,
                         const RoleId& role) {
        Entry entry{.user = to_string(place) + ": " + user, .ranges = id_ranges(keys), .role = role};
        entry.keys = std::move(keys);
        entries_.push_back(std::move(entry));
    };
    for (const PipelineStep& step : pipeline.steps) {
        // An object_id that a step makes is not the capture's.
        if (!pipeline.writes_role(kObjectIdRole))
            for (const ParamSpec& spec : step.manifest->params)
                if (is_param_buffer(spec.type) && step.values.contains(spec.name))
                    for (const ParamValue& value : step.known_values(spec))
                        for (const auto& [key, row] : spec.type->table->rows(value).rows)
                            add(step.places.at(spec.name), step.name + "." + spec.name, {key}, kObjectIdRole);
        if (step.mask && step.mask->names_objects())
            add(step.mask->place, "the mask of step '" + step.name + "'", step.mask->objects,
                RoleId::coverage(step.mask->objects));
        else if (step.mask)
            for (const TableKey& key : step.mask->objects)
                add(step.mask->place, "the mask of step '" + step.name + "'", {key}, kObjectIdRole);
        add_entries_of_scattering(step);
    }
}

void ObjectMatches::add_entries_of_scattering(const PipelineStep& step) {
    const auto user = [&](const ParamSpec& spec) {
        const auto place = step.places.find(spec.name);
        return (place == step.places.end() ? "" : to_string(place->second) + ": ") + step.name + "." +
               spec.name;
    };
    const auto& inputs = step.manifest->inputs;
    std::vector<IdRange> objects;
    for (const ParamSpec& spec : step.manifest->params) {
        if (!spec.warn_if_empty) continue;
        bool is_empty = true;
        for (const ParamValue& value : step.known_values(spec))
            for (const auto& [key, row] : spec.type->table->rows(value).rows) {
                is_empty = false;
                const std::vector<IdRange> more = id_ranges({&key, 1});
                objects.insert(objects.end(), more.begin(), more.end());
            }
        if (is_empty && !step.mask)
            entries_.push_back({.user = user(spec),
                                .role = kObjectIdRole,
                                .asks = Asks::few,
                                .has_mask_input = std::ranges::any_of(
                                    inputs, [](const InputSpec& in) { return in.role == kMaskRole; })});
    }
    for (const ParamSpec& spec : step.manifest->params) {
        if (spec.per_metre.empty()) continue;
        const std::vector<ParamValue> units = values_of(step, spec.per_metre);
        double length_mm = 0;
        for (const ParamValue& value : step.known_values(spec))
            length_mm = std::max(length_mm, spec.type->length_mm(value));
        if (units.empty() || length_mm <= 0) continue;
        double least_unit = std::numeric_limits<double>::infinity();
        for (const ParamValue& unit : units) least_unit = std::min(least_unit, std::get<double>(unit));
        entries_.push_back({.user = user(spec),
                            .ranges = objects,
                            .role = kDepthRole,
                            .asks = Asks::wide,
                            .length_m = length_mm / least_unit,
                            .focal_per_width = focal_per_width(step),
                            .remedy = spec.per_metre + ", now " + format_number(least_unit) +
                                      ", is the millimetres of the profile for each metre of the capture"});
    }
}

bool ObjectMatches::is_in(const Entry& entry, const Capture& capture,
                          const std::vector<std::uint32_t>& ids) const {
    if (entry.role.is_coverage()) {
        const auto values = capture.images.at(entry.role).floats();
        return std::ranges::any_of(values, [](float share) { return share > 0; });
    }
    return std::ranges::any_of(entry.ranges, [&](const IdRange& range) {
        const auto found = std::ranges::lower_bound(ids, range.first);
        return found != ids.end() && *found <= range.last;
    });
}

void ObjectMatches::set(std::size_t index, bool is_found, double px) {
    Entry& entry = entries_[index];
    entry.px = std::max(entry.px, px);
    const State now = is_found ? State::found : State::missed;
    if (entry.state == State::found || entry.state == now) return;
    entry.state = now;
    sightings_.push_back({int(index), is_found, px});
}

/// Where the depth is known, only pixels in which something was hit count.
void ObjectMatches::look_for_several(std::size_t index, const Capture& capture) {
    const auto ids = capture.images.find(kObjectIdRole), depth = capture.images.find(kDepthRole);
    const bool is_masked = entries_[index].has_mask_input && capture.images.contains(kMaskRole);
    if (ids == capture.images.end() || is_masked) return;
    const std::span<const std::uint32_t> values = ids->second.uints();
    std::optional<std::uint32_t> first;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const bool is_hit =
            depth == capture.images.end() ? values[i] != 0 : std::isfinite(depth->second.floats()[i]);
        if (!is_hit || first == values[i]) continue;
        if (first) return set(index, false);
        first = values[i];
    }
}

/// At the nearest pixel that may scatter.
void ObjectMatches::look_for_width(std::size_t index, const Capture& capture) {
    const Entry& entry = entries_[index];
    const auto depth = capture.images.find(kDepthRole), ids = capture.images.find(kObjectIdRole);
    const double focal_px = focal_length_px(capture.header, entry.focal_per_width);
    if (depth == capture.images.end() || focal_px <= 0) return;
    const std::span<const float> values = depth->second.floats();
    float nearest_m = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (values[i] > 0 && values[i] < nearest_m &&
            (entry.ranges.empty() || ids == capture.images.end() ||
             contains(entry.ranges, ids->second.uints()[i])))
            nearest_m = values[i];
    if (!std::isfinite(nearest_m)) return;
    const double px = entry.length_m * focal_px / double(nearest_m);
    set(index, px >= kLeastWidth_px, px);
}

void ObjectMatches::look_at(const Capture& capture) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        const auto image = capture.images.find(entry.role);
        if (entry.state == State::found || image == capture.images.end()) continue;
        if (entry.asks == Asks::few && entry.state == State::not_searched) look_for_several(i, capture);
        if (entry.asks == Asks::wide) look_for_width(i, capture);
        if (entry.asks != Asks::named) continue;
        if (entry.role == kObjectIdRole && ids.empty()) {
            ids = distinct_ids(image->second);
            for (auto id = ids.begin(); id != ids.end() && ids_.size() < kMaxIds; ++id) ids_.insert(*id);
        }
        set(i, is_in(entry, capture, ids));
    }
}

Error ObjectMatches::placed(const UnknownObject& error) const {
    for (const Entry& entry : entries_)
        if (std::ranges::find(entry.keys, error.object(), &TableKey::name) != entry.keys.end())
            return Error(error.kind(), entry.user + ": " + error.what());
    return static_cast<const Error&>(error);
}

std::vector<ObjectSighting> ObjectMatches::take_sightings() {
    const std::lock_guard lock(mutex_);
    return std::exchange(sightings_, {});
}

void ObjectMatches::add(const ObjectSighting& sighting) {
    const std::lock_guard lock(mutex_);
    if (sighting.index >= 0 && std::size_t(sighting.index) < entries_.size())
        set(std::size_t(sighting.index), sighting.is_found, sighting.px);
}

std::string ObjectMatches::sentence(const Entry& entry) {
    if (entry.asks == Asks::few)
        return entry.user +
               " is empty, so the step works on every object, and frames have several (name those that are "
               "meant, or give the step a mask)";
    return entry.user + ": light goes at most " + fmt::format("{:.2g}", entry.px) +
           " px far, by the profile's d, at the nearest pixel, and below " + format_number(kLeastWidth_px) +
           " px nothing of it is seen (the scene's unit may be another than the metre: " + entry.remedy + ")";
}

/// "; object_id has 0, 1 and 2"
std::string ObjectMatches::ids_text() const {
    std::vector<std::string> texts;
    for (const std::uint32_t id : ids_)
        if (id < kSmallestHash) texts.push_back(std::to_string(id));
    if (texts.empty()) return "";
    if (texts.size() > kShownIds) {
        texts.resize(kShownIds);
        texts.emplace_back("others");
    }
    return "; object_id has " + joined(texts, " and ");
}

std::vector<std::string> ObjectMatches::unmatched() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> sentences;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        if (entries_[i].state != State::missed) continue;
        const Entry& first = entries_[i];
        if (first.asks != Asks::named) {
            sentences.push_back(sentence(first));
            continue;
        }
        std::vector<TableKey> keys = first.keys;
        while (i + 1 < entries_.size() && entries_[i + 1].user == first.user) {
            ++i;
            if (entries_[i].state == State::missed)
                keys.insert(keys.end(), entries_[i].keys.begin(), entries_[i].keys.end());
        }
        sentences.push_back(first.user + ": " + list_of_objects(keys) +
                            (keys.size() == 1 ? " has" : " have") + " no pixel in any frame of this run (" +
                            (are_named(keys)
                                 ? advice("`aftershade inspect CAPTURE ", Option::cryptomatte, "",
                                          "` lists the names and, without a manifest, their hashes")
                                 : advice("`aftershade inspect CAPTURE ", Option::pixel, "X,Y",
                                          "` prints the id at a pixel")) +
                            ids_text() + ")");
    }
    return sentences;
}

}  // namespace aftershade
