// Silent misses of a look: objects that it names and no frame contains, steps that work on all objects
// although few are likely meant, and scattering too narrow to be visible. No other check reports them.
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
    /// Sightings that look_at() found since the last call, for a process that gathers them from several.
    std::vector<ObjectSighting> take_sightings();
    void add(const ObjectSighting& sighting);
    /// A sentence with place and remedy for each value or mask whose objects no frame had, and for each step
    /// that is as the head of this file says; none for what no frame was searched for.
    std::vector<std::string> unmatched() const;

private:
    enum class State { not_searched, missed, found };
    enum class Asks {
        named,  ///< for a pixel of its objects
        few,    ///< for a frame of one object; missed once there are several
        wide    ///< for a pixel in which light goes kLeastWidth_px far
    };
    struct Entry {
        std::string user;  ///< "look.json:4:12: motion_blur.objects"
        std::vector<TableKey> keys{};
        std::vector<IdRange> ranges{};
        RoleId role;  ///< to search: object_id, or the coverage of a mask
        Asks asks = Asks::named;
        bool has_mask_input = false;  ///< few: the step takes the capture's mask
        double length_m = 0;          ///< wide: how far light goes
        double focal_per_width = 0;   ///< wide: of the lens where the capture has none
        std::string remedy{};         ///< wide: the parameter to change, and its value
        double px = 0;                ///< wide: the most so far
        State state = State::not_searched;
    };

    void add_entries_of_scattering(const PipelineStep& step);
    bool is_in(const Entry& entry, const Capture& capture, const std::vector<std::uint32_t>& ids) const;
    void look_for_several(std::size_t index, const Capture& capture);
    void look_for_width(std::size_t index, const Capture& capture);
    void set(std::size_t index, bool is_found, double px = 0);
    static std::string sentence(const Entry& entry);
    std::string ids_text() const;

    mutable std::mutex mutex_;
    std::vector<Entry> entries_;
    std::set<std::uint32_t> ids_;  // of all frames, at most kMaxIds
    std::vector<ObjectSighting> sightings_;
};

}  // namespace aftershade
