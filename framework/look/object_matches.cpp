#include "framework/look/object_matches.h"

#include <algorithm>
#include <utility>

#include "framework/base/text.h"
#include "framework/document/param_type.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

constexpr std::size_t kMaxIds = 64;                // kept for the message
constexpr std::size_t kShownIds = 8;               // in the message
constexpr std::size_t kShownObjects = 8;           // likewise
constexpr std::uint32_t kSmallestHash = 1u << 23;  // of a name: the exponent is never 0

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

ObjectMatches::ObjectMatches(const Pipeline& pipeline) {
    const auto add = [&](const Place& place, const std::string& user, std::vector<TableKey> keys,
                         const std::string& role) {
        const std::vector<IdRange> ranges = id_ranges(keys);
        entries_.push_back({to_string(place) + ": " + user, std::move(keys), ranges, role});
    };
    for (const PipelineStep& step : pipeline.steps) {
        // An object_id that a step makes is not the capture's.
        if (!pipeline.writes_role(kObjectIdRole))
            for (const ParamSpec& spec : step.manifest->params)
                if (is_param_buffer(spec.type) && step.values.contains(spec.name))
                    for (const ParamValue& value : step.known_values(spec))
                        for (const auto& [key, row] : spec.type->table.rows(value).rows)
                            add(step.places.at(spec.name), step.name + "." + spec.name, {key}, kObjectIdRole);
        if (step.mask && step.mask->names_objects())
            add(step.mask->place, "the mask of step '" + step.name + "'", step.mask->objects,
                coverage_role(step.mask->objects));
        else if (step.mask)
            for (const TableKey& key : step.mask->objects)
                add(step.mask->place, "the mask of step '" + step.name + "'", {key}, kObjectIdRole);
    }
}

bool ObjectMatches::is_in(const Entry& entry, const Capture& capture,
                          const std::vector<std::uint32_t>& ids) const {
    if (is_coverage_role(entry.role)) {
        const auto values = capture.images.at(entry.role).floats();
        return std::ranges::any_of(values, [](float share) { return share > 0; });
    }
    return std::ranges::any_of(entry.ranges, [&](const IdRange& range) {
        const auto found = std::ranges::lower_bound(ids, range.first);
        return found != ids.end() && *found <= range.last;
    });
}

void ObjectMatches::set(std::size_t index, bool is_found) {
    Entry& entry = entries_[index];
    const State now = is_found ? State::found : State::missed;
    if (entry.state == State::found || entry.state == now) return;
    entry.state = now;
    sightings_.push_back({int(index), is_found});
}

void ObjectMatches::look_at(const Capture& capture) {
    const std::lock_guard lock(mutex_);
    std::vector<std::uint32_t> ids;
    for (std::size_t i = 0; i < entries_.size(); ++i) {
        const Entry& entry = entries_[i];
        const auto image = capture.images.find(entry.role);
        if (entry.state == State::found || image == capture.images.end()) continue;
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
            return Error(error.exit_code(), entry.user + ": " + error.what());
    return error;
}

std::vector<ObjectSighting> ObjectMatches::take_sightings() {
    const std::lock_guard lock(mutex_);
    return std::exchange(sightings_, {});
}

void ObjectMatches::add(const ObjectSighting& sighting) {
    const std::lock_guard lock(mutex_);
    if (sighting.index >= 0 && std::size_t(sighting.index) < entries_.size())
        set(std::size_t(sighting.index), sighting.is_found);
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
        std::vector<TableKey> keys = first.keys;
        while (i + 1 < entries_.size() && entries_[i + 1].user == first.user) {
            ++i;
            if (entries_[i].state == State::missed)
                keys.insert(keys.end(), entries_[i].keys.begin(), entries_[i].keys.end());
        }
        sentences.push_back(
            first.user + ": " + list_of_objects(keys) + (keys.size() == 1 ? " has" : " have") +
            " no pixel in any frame of this run (" +
            (are_named(keys) ? "`aftershade inspect CAPTURE --cryptomatte` lists the names and, without a "
                               "manifest, their hashes"
                             : "`aftershade inspect CAPTURE --pixel X,Y` prints the id at a pixel") +
            ids_text() + ")");
    }
    return sentences;
}

}  // namespace aftershade
