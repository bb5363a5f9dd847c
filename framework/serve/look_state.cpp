#include "framework/serve/look_state.h"

#include <algorithm>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/document/document.h"
#include "framework/look/look.h"
#include "framework/render/frame_drive.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

/// A value as JSON; the text itself where it reads as none.
Json json_of(const std::string& text) {
    Json value = Json::parse(text, nullptr, false);
    return value.is_discarded() ? Json(text) : value;
}

/// "capture: camera.focus_distance"; `resolved` is null where only a picture has the value.
std::string origin_word(const PipelineStep& step, const ParamSpec& spec, const Json* literal,
                        const ResolvedValue* resolved) {
    if (literal && literal->is_object() && literal->contains("var")) return "variable";
    const auto asked = step.values.find(spec.name);
    if (asked == step.values.end())
        return resolved && resolved->origin == "the manifest" ? "default" : "capture: " + spec.from;
    if (std::holds_alternative<KeyedValue>(asked->second)) return "key";
    if (const auto* camera = std::get_if<CameraValue>(&asked->second))
        return "capture: camera." + camera->field;
    if (const auto* pixels = std::get_if<PixelValue>(&asked->second))
        return pixels->measure == PixelValue::Measure::depth ? "capture: depth" : "capture: luminance";
    const std::string& origin = step.origins.at(spec.name);
    return origin.starts_with("preset") ? "preset" : origin == "the look" ? "look" : origin;
}

Json param_json(const PipelineStep* step, const ParamSpec& spec, const Json* literal,
                const FrameInputs& frame) {
    Json param = Json::object();
    if (literal) param["value"] = *literal;
    if (!step) {
        param["effective"] = literal ? *literal : json_of(format_value(spec, spec.default_value));
        param["from"] = literal ? "look" : "default";
        return param;
    }
    try {
        const ResolvedValue resolved = resolve_param(*step, spec, frame);
        param["effective"] = json_of(format_value(spec, resolved.value));
        param["from"] = origin_word(*step, spec, literal, &resolved);
    } catch (const Error& error) {
        // A depth is taken from pixels, which only a picture has.
        param["effective"] = nullptr;
        param["from"] = origin_word(*step, spec, literal, nullptr);
        param["why"] = error.what();
    }
    return param;
}

/// What the text itself says of a step.
Json written_step(const Json& written, std::size_t index) {
    const auto text_of = [&](const char* key) {
        return written.contains(key) && written[key].is_string() ? written[key] : Json();
    };
    Json step = {{"index", index}, {"effect", text_of("effect")}, {"name", text_of("name")}};
    if (step["name"].is_null() && step["effect"].is_string())
        step["name"] = default_step_name(step["effect"].get<std::string>());
    if (written.contains("use")) step["use"] = written["use"];
    const bool has_switch = written.contains("enabled") && written["enabled"].is_boolean();
    step["enabled"] = has_switch ? written["enabled"].get<bool>() : true;
    for (const char* key : {"mix", "preset", "mask", "in"})
        step[key] = written.contains(key) ? written[key] : Json();
    step["params"] = Json::object();
    return step;
}

}  // namespace

Json faults_json(const Diagnostics& faults) {
    Json list = Json::array();
    for (const Diagnostic& fault : faults.all())
        list.push_back({{"line", fault.place.line},
                        {"column", fault.place.column},
                        {"where", to_string(fault.place)},
                        {"severity", fault.severity == Severity::error ? "error" : "warning"},
                        {"message", fault.message}});
    return list;
}

Json steps_json(const std::string& text, const BoundText* bound, EffectRegistry& effects,
                const CaptureHeader& header) {
    Json list = Json::array();
    const Json document = Json::parse(text, nullptr, false, true);
    if (!document.is_object() || !document.contains("steps") || !document["steps"].is_array()) return list;
    Capture capture;
    capture.header = header;
    const FrameInputs frame = FrameSetting{}.inputs(capture);
    for (const Json& written : document["steps"]) {
        if (!written.is_object()) continue;
        Json step = written_step(written, list.size());
        const std::string effect = step["effect"].is_string() ? step["effect"].get<std::string>() : "";
        Diagnostics ignored;  // bind() lists them
        const PipelineStep* found = nullptr;
        if (bound && step["name"].is_string())
            for (const PipelineStep& one : bound->pipeline.steps)
                if (one.name == step["name"].get<std::string>()) found = &one;
        // The path of an ISF file begins at the look's folder, which is not here.
        const EffectManifest* manifest = effects.contains(effect) ? effects.find(effect, ignored) : nullptr;
        if (found && is_isf_path(found->manifest->document)) manifest = found->manifest;
        const Json params = written.value("params", Json::object());
        if (manifest)
            for (const ParamSpec& spec : manifest->params) {
                const bool is_written = params.is_object() && params.contains(spec.name);
                step["params"][spec.name] =
                    param_json(found, spec, is_written ? &params[spec.name] : nullptr, frame);
            }
        list.push_back(std::move(step));
    }
    return list;
}

std::shared_ptr<BoundText> bind_text(const std::string& text, const std::filesystem::path& path,
                                     const std::shared_ptr<EffectRegistry>& effects, Diagnostics& faults) {
    const auto node = parse_document(text, path.string(), faults);
    auto look = node ? parse_look(*node, faults) : std::nullopt;
    if (!look) return nullptr;
    auto bound = std::make_shared<BoundText>();
    bound->text = text;
    bound->effects = effects;
    bound->look = std::move(*look);
    bound->pipeline = bind_pipeline(bound->look, *effects, {}, faults);
    return bound;
}

}  // namespace aftershade::serve
