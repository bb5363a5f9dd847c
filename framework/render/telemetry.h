// Numbers of a frame: what effects say of themselves, and what the frame took. No GL.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "framework/effect/manifest/manifest.h"
#include "framework/graph/executor.h"
#include "framework/image/image.h"

namespace aftershade {

/// Statistic of the finite values of one channel of a texture, where its TelemetrySpec counts them.
struct Statistic {
    std::int64_t count = 0;       ///< texels; with 0 of them the numbers below are 0
    std::int64_t non_finite = 0;  ///< NaN and infinities, not in `count`
    double sum = 0;
    double mean = 0;
    double deviation = 0;  ///< of these texels around their mean
    double min = 0;
    double max = 0;
    double from = 0, to = 0;              ///< of the histogram
    std::vector<std::int64_t> histogram;  ///< of the spec's bins; what lies outside is in the first and last
};

/// `where` has the size of `of`, or is nullptr: all texels.
Statistic statistic_of(const TelemetrySpec& spec, const Image& of, const Image* where);

/// Textures of one format, as they lie in memory: those that share memory count once.
struct FormatMemory {
    int textures = 0;
    std::uint64_t bytes = 0;
};

struct FrameTelemetry {
    int frame = 0;
    /// By step and name; statistics whose textures no pass writes with the step's parameters are left out.
    std::map<std::string, std::map<std::string, Statistic>> steps;
    std::map<std::string, FormatMemory> textures;  ///< by format
    std::uint64_t buffer_bytes = 0;
    std::uint64_t bytes = 0;            ///< of all textures and buffers
    std::uint64_t bytes_unaliased = 0;  ///< what these would take if none shared memory
    std::vector<graph::PassTime> passes;
};

/// How a draw runs.
struct DrawnPass {
    std::string pass;
    bool computes = false;  ///< as a compute shader
    std::string why_drawn;  ///< why not, where that is wanted
};

/// One JSON object: {"aftershade": 1, "frame": 12, "steps": {"sss_adaptive": {"samples": {"mean": ...}}},
/// "memory": {"textures": {"rgba32f": {"count": 7, "bytes": 123}}, ...}, "passes_ms": {...}}.
/// Passes of one name are added up. A histogram is {"from", "to", "counts"}.
std::string telemetry_json(const FrameTelemetry& telemetry);

}  // namespace aftershade
