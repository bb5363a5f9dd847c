#include "framework/batch/case_origin.h"

#include <nlohmann/json.hpp>

#include "framework/base/text.h"

namespace aftershade {

using Json = nlohmann::ordered_json;

namespace {

std::map<std::string, std::string> texts_of(const Json& object) {
    std::map<std::string, std::string> texts;
    if (!object.is_object()) return texts;
    for (const auto& [key, value] : object.items())
        if (value.is_string()) texts[printable(key)] = printable(value.get<std::string>());
    return texts;
}

}  // namespace

void add_origin(const CaseOrigin& origin, Json& sidecar) {
    if (origin == CaseOrigin{}) return;
    sidecar["files"] = origin.files;
    sidecar["values"] = origin.values;
    Json& steps = sidecar["steps"] = Json::object();
    for (const StepHashes& step : origin.steps) steps[step.step] = step.outputs;
}

CaseOrigin origin_of(const Json& sidecar) {
    CaseOrigin origin;
    origin.files = texts_of(sidecar.value("files", Json()));
    origin.values = texts_of(sidecar.value("values", Json()));
    const Json steps = sidecar.value("steps", Json());
    if (steps.is_object())
        for (const auto& [step, outputs] : steps.items())
            origin.steps.push_back({printable(step), texts_of(outputs)});
    return origin;
}

}  // namespace aftershade
