// Settings of --visibility, for the tests of this folder.
#pragma once

#include "framework/scene/visibility.h"

namespace aftershade::scene {

inline VisibilitySettings with_samples(int samples) {
    VisibilitySettings settings;
    settings.samples = samples;
    return settings;
}

}  // namespace aftershade::scene
