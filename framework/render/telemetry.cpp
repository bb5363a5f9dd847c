#include "framework/render/telemetry.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

namespace aftershade {

namespace {

using Json = nlohmann::ordered_json;

std::size_t bin_of(const TelemetrySpec& spec, double value) {
    const double place = (value - spec.from) / (spec.to - spec.from) * spec.bins;
    return std::size_t(std::clamp(std::floor(place), 0.0, double(spec.bins - 1)));
}

Json statistic_json(const Statistic& statistic) {
    Json result{{"count", statistic.count},         {"sum", statistic.sum}, {"mean", statistic.mean},
                {"deviation", statistic.deviation}, {"min", statistic.min}, {"max", statistic.max}};
    if (statistic.non_finite > 0) result["non_finite"] = statistic.non_finite;
    if (!statistic.histogram.empty())
        result["histogram"] = {
            {"from", statistic.from}, {"to", statistic.to}, {"counts", statistic.histogram}};
    return result;
}

}  // namespace

Statistic statistic_of(const TelemetrySpec& spec, const Image& of, const Image* where) {
    Statistic result;
    result.from = spec.from;
    result.to = spec.to;
    result.histogram.resize(std::size_t(spec.bins));
    double mean = 0, squares = 0;  // Welford's
    for (int y = 0; y < of.height(); ++y)
        for (int x = 0; x < of.width(); ++x) {
            if (where && !(where->at(x, y, spec.where->channel) > 0)) continue;
            double value = of.at(x, y, spec.of.channel);
            if (spec.squared) value *= value;
            if (!std::isfinite(value)) {
                ++result.non_finite;
                continue;
            }
            if (++result.count == 1) result.min = result.max = value;
            result.sum += value;
            const double off = value - mean;
            mean += off / double(result.count);
            squares += off * (value - mean);
            result.min = std::min(result.min, value);
            result.max = std::max(result.max, value);
            if (spec.bins > 0) ++result.histogram[bin_of(spec, value)];
        }
    result.mean = mean;
    if (result.count > 0) result.deviation = std::sqrt(squares / double(result.count));
    return result;
}

std::string telemetry_json(const FrameTelemetry& telemetry) {
    Json result{{"aftershade", 1}, {"frame", telemetry.frame}, {"steps", Json::object()}};
    for (const auto& [step, statistics] : telemetry.steps)
        for (const auto& [name, statistic] : statistics)
            result["steps"][step][name] = statistic_json(statistic);
    Json& memory = result["memory"];
    memory["textures"] = Json::object();
    for (const auto& [format, used] : telemetry.textures)
        memory["textures"][format] = {{"count", used.textures}, {"bytes", used.bytes}};
    memory["buffer_bytes"] = telemetry.buffer_bytes;
    memory["bytes"] = telemetry.bytes;
    memory["bytes_unaliased"] = telemetry.bytes_unaliased;
    Json& passes = result["passes_ms"] = Json::object();
    for (const graph::PassTime& time : telemetry.passes)
        passes[time.pass] = passes.value(time.pass, 0.0) + time.milliseconds;
    return result.dump(2) + "\n";
}

}  // namespace aftershade
