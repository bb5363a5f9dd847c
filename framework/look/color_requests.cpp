#include "framework/look/color_requests.h"

#include <set>
#include <string>
#include <utility>

namespace aftershade {

namespace {

/// `requests` with each value of one more parameter.
std::set<ColorRequest> with_values(const std::set<ColorRequest>& requests, const PipelineStep& step,
                                   const ParamSpec& spec) {
    std::set<ColorRequest> all;
    for (const ParamValue& value : step.known_values(spec))
        for (ColorRequest request : requests) {
            set_color_part(request, spec, value);
            all.insert(std::move(request));
        }
    return all;
}

}  // namespace

std::vector<StepColorRequest> color_requests(const PipelineStep& step) {
    std::vector<StepColorRequest> all;
    for (const ParamSpec& file : step.manifest->params) {
        if (!is_ocio_file(file)) continue;
        std::set<ColorRequest> requests{empty_request(file)};
        for (const ParamSpec& spec : step.manifest->params)
            if (!spec.ocio.empty() || spec.name == file.name) requests = with_values(requests, step, spec);
        for (const ColorRequest& request : requests)
            if (!request.is_file || !request.path.empty()) all.push_back({&file, request});
    }
    return all;
}

void check_color_requests(const PipelineStep& step, const Place& place, Diagnostics& diagnostics) {
    std::set<std::string> told;
    for (const StepColorRequest& asked : color_requests(step)) {
        const auto made = make_color_transform(asked.request);
        const auto* fault = std::get_if<ColorFault>(&made);
        if (!fault) continue;
        const std::string& param = param_at_fault(*step.manifest, *asked.file, *fault).name;
        const std::string text = step.name + "." + param + ": " + fault->text;
        const auto said = step.places.find(param);
        if (told.insert(text).second)
            diagnostics.error(said == step.places.end() ? place : said->second, text);
    }
}

}  // namespace aftershade
