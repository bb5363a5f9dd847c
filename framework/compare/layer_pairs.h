// Which layer of one file is compared with which of the other.
#pragma once

#include <span>
#include <vector>

#include "framework/compare/layer.h"

namespace aftershade {

/// For each layer of `reference` the layer of `test`, or nullptr; no layer of `test` twice. Layers of one key
/// first; then by the whole names of their channels, as a file of one part has them: Z of the part "depth" is
/// "depth.Z". Where one file has one part, also by the names within the parts, if only one layer fits: R, G
/// and B of the part "rgba" are R, G and B.
std::vector<const LayerInfo*> paired_layers(std::span<const LayerInfo> reference,
                                            std::span<const LayerInfo> test);

}  // namespace aftershade
