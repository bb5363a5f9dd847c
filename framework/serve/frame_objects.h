// The objects and materials of one frame by their names, as looks may write them.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/capture/capture.h"
#include "framework/capture/sequence.h"

namespace aftershade::serve {

class FrameObjects {
public:
    /// Lists the objects of one file of a sequence, whose capture was read whole: by its Cryptomattes, else
    /// by its role object_id.
    FrameObjects(const CaptureReader& reader, const Sequence& sequence, int file, const Capture& whole);

    /// [{"kind", "name", "id", "share"}] of all pixels, the largest first. Without "name" where there is only
    /// the number. `reader` and `file` are those of the constructor.
    nlohmann::ordered_json list(const CaptureReader& reader, int file) const;
    /// [{"kind", "name", "id"}] at a pixel of the working grid.
    nlohmann::ordered_json at(std::pair<int, int> place) const;

private:
    struct Layer {
        std::string kind;         // "object", "material" or "asset"
        std::string cryptomatte;  // "" for object_id
        Image ids;
        std::map<std::uint32_t, std::string> names;
    };
    bool is_hidden(const Layer& layer, const std::string& name) const;

    std::vector<Layer> layers_;
};

}  // namespace aftershade::serve
