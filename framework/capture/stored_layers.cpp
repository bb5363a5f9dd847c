#include "framework/capture/stored_layers.h"

#include <cstddef>

namespace aftershade {

std::vector<std::string> present_of(const std::vector<std::string>& names) {
    std::vector<std::string> present;
    for (const std::string& name : names)
        if (!name.empty()) present.push_back(name);
    return present;
}

namespace {

/// One layer over the grid, in the role's channel order. Of a component that the file lacks, alpha is 1, or
/// what deep samples cover, and others 0.
Image read_layer(const FrameFile& file, const std::vector<std::string>& names, const Window& grid,
                 float outside, const DeepRead& how) {
    const std::vector<std::string> present = present_of(names);
    if (present.empty()) return Image(grid.width(), grid.height(), int(names.size()));
    Image stored = file.read_floats(present, grid, outside, how);
    if (present.size() == names.size()) return stored;

    constexpr std::size_t kAlpha = 3;
    Image filled(stored.width(), stored.height(), int(names.size()));
    Image covered;
    if (file.deep_part_of(present.front())) covered = file.read_deep_alpha(present.front(), grid, how);
    const std::size_t pixels = stored.floats().size() / present.size();
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
        std::size_t next = 0;
        for (std::size_t c = 0; c < names.size(); ++c) {
            const float absent = c != kAlpha ? 0.0f : covered.empty() ? 1.0f : covered.floats()[pixel];
            filled.floats()[pixel * names.size() + c] =
                names[c].empty() ? absent : stored.floats()[pixel * present.size() + next++];
        }
    }
    return filled;
}

}  // namespace

Image read_layers(const FrameFile& file, const FoundChannels& channels, const Window& grid, float outside,
                  const DeepRead& how) {
    Image image = read_layer(file, channels[0], grid, outside, how);
    for (std::size_t i = 1; i < channels.size(); ++i) {
        const Image layer = read_layer(file, channels[i], grid, outside, how);
        for (std::size_t j = 0; j < layer.floats().size(); ++j) image.floats()[j] += layer.floats()[j];
    }
    return image;
}

}  // namespace aftershade
