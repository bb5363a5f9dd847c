// Which objects that a look names no frame has had: a number that is wrong would otherwise change nothing,
// and nothing would show it.
#pragma once

#include <cstdint>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "framework/base/error.h"
#include "framework/base/status.h"
#include "framework/capture/capture.h"
#include "framework/capture/cryptomatte.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// [thread-safe]
class ObjectMatches {
public:
    /// Objects in values of steps and in masks. A value from depth is left out: it is an error where its
    /// object has no pixel.
    explicit ObjectMatches(const Pipeline& pipeline);

    /// Call with whole frames, before they are cropped.
    void look_at(const Capture& capture);
    /// The error with the place that names the object, before it.
    Error placed(const UnknownObject& error) const;
    /// What look_at() found since the last call, for a process that gathers it from several.
    std::vector<ObjectSighting> take_sightings();
    void add(const ObjectSighting& sighting);
    /// A sentence with place and remedy for each value or mask whose objects no frame had; none for objects
    /// that no frame was searched for.
    std::vector<std::string> unmatched() const;

private:
    enum class State { not_searched, missed, found };
    struct Entry {
        std::string user;  ///< "look.json:4:12: motion_blur.objects"
        std::vector<TableKey> keys;
        std::vector<IdRange> ranges;
        std::string role;  ///< to search: object_id, or the coverage of a mask
        State state = State::not_searched;
    };

    bool is_in(const Entry& entry, const Capture& capture, const std::vector<std::uint32_t>& ids) const;
    void set(std::size_t index, bool is_found);
    std::string ids_text() const;

    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
    std::set<std::uint32_t> ids_;  // of all frames, at most kMaxIds
    std::vector<ObjectSighting> sightings_;
};

}  // namespace aftershade
