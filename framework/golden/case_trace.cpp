#include "framework/golden/case_trace.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "framework/base/content_hash.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/document/object_keys.h"
#include "framework/document/param_type.h"
#include "framework/file/exr_file.h"
#include "framework/golden/capture_hash.h"
#include "framework/look/look_content.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kDigits = 16;

std::string short_hash(std::string_view bytes) {
    return content_hash(bytes).substr(0, kDigits);
}

/// A hash of the pixels' values. Hashes of files would differ, since versions of zlib pack pixels
/// differently.
std::string pixel_hash(const fs::path& image) {
    const ExrFile file(image);
    const ExrPart& part = file.parts().front();
    std::string text;
    const auto add = [&](const auto& values) {
        const auto bytes = std::as_bytes(values);
        text += content_hash({reinterpret_cast<const char*>(bytes.data()), bytes.size()}) + "\n";
    };
    for (const int side :
         {part.data_window.min_x, part.data_window.min_y, part.data_window.max_x, part.data_window.max_y})
        text += std::to_string(side) + " ";
    for (const ExrChannel& channel : part.channels) {
        text += channel.name + "\n";
        const std::vector<std::string> one{channel.name};
        if (channel.type == PixelType::uint32) add(file.read_uints(0, one).uints());
        else add(file.read_floats(0, one).floats());
    }
    return short_hash(text);
}

/// A table or a curve may be long.
std::string short_value(const std::string& text) {
    constexpr std::size_t kMostBytes = 100;
    return text.size() <= kMostBytes ? text : text.substr(0, 60) + "... (hash " + short_hash(text) + ")";
}

std::string text_of(const MaskSpec& mask) {
    std::string text = mask.invert ? "all but " : "";
    if (!mask.role.empty()) text += mask.role;
    else if (!mask.file.empty()) text += mask.file.filename().string();
    else text += format_object_keys(mask.objects);
    return text;
}

}  // namespace

std::string kind_of_file(const std::string& name) {
    const fs::path file(name);
    const std::string extension = file.extension().string();
    if (name.starts_with("glsl/") && std::ranges::count(name, '/') > 1) return "module";
    if (name.starts_with("profiles/")) return "profile";
    if (file.filename() == "effect.json") return "manifest";
    constexpr std::array<std::string_view, 5> kShaders = {".frag", ".vert", ".comp", ".glsl", ".fs"};
    if (std::ranges::find(kShaders, extension) != kShaders.end()) return "shader";
    constexpr std::array<std::string_view, 3> kNative = {".c", ".cpp", ".h"};
    return std::ranges::find(kNative, extension) != kNative.end() ? "native source" : "file";
}

CaseTracer::CaseTracer(const GoldenRenderOptions& options, const fs::path& suite_folder)
    : effects_(effect_folders(options.effect_paths), data_path() / "glsl"),
      data_(fs::absolute(data_path()).lexically_normal()),
      suite_folder_(fs::absolute(suite_folder).lexically_normal()) {}

CaseParts CaseTracer::parts(const GoldenCase& test, int frame) {
    const std::scoped_lock lock(mutex_);
    CaseParts parts;
    try {
        const BoundCase bound = bind_case(test, effects_);
        for (const PipelineStep& step : bound.pipeline.steps) add_step(step, test, parts);
        for (const LookStep& step : bound.look.steps)
            for (const WiringSpec& wiring : step.wiring) {
                const std::string name = step.name + ".in." + wiring.input;
                parts.origin.values[name] = wiring.source + "." + wiring.output;
                parts.values[name] = {wiring.place.file, "wiring", {step.name}};
            }
    } catch (const Error&) {
        // The worker that draws the case names the fault.
    }
    for (const fs::path& file : capture_files(test, frame))
        add_file(file, {file, name_of(file).starts_with("profiles/") ? "profile" : "capture", {}}, parts);
    return parts;
}

std::vector<std::string> CaseTracer::taps(const GoldenCase& test) {
    const std::scoped_lock lock(mutex_);
    std::vector<std::string> taps;
    try {
        for (const PipelineStep& step : bind_case(test, effects_).pipeline.steps)
            for (const OutputSpec& output : step.manifest->outputs)
                taps.push_back(step.name + "." + output.name);
    } catch (const Error&) {
        // As above.
    }
    return taps;
}

void CaseTracer::add_file(const fs::path& file, CasePart part, CaseParts& parts) {
    std::string& hash = hashes_[file];
    try {
        if (hash.empty()) hash = file_content(file).hash.substr(0, kDigits);
    } catch (const Error&) {
        return;  // a neighbour of the frame need not be there
    }
    const std::string name = name_of(file);
    parts.origin.files[name] = hash;
    const auto [kept, is_new] = parts.files.try_emplace(name, part);
    kept->second.steps.merge(part.steps);
}

void CaseTracer::add_step(const PipelineStep& step, const GoldenCase& test, CaseParts& parts) {
    parts.origin.steps.push_back({step.name, {}});
    parts.effects[step.name] = step.manifest->id;
    for (const fs::path& file : files_of_step(step, data_path() / "glsl"))
        add_file(file, {file, kind_of_file(name_of(file)), {step.name}}, parts);
    const auto add_value = [&](const std::string& param, const std::string& text) {
        const auto place = step.places.find(param);
        fs::path document = test.look.empty() ? test.file : test.look;
        // The case itself has the values of its `set`.
        if (place != step.places.end())
            document = place->second.option ? test.file : fs::path(place->second.file);
        const std::string name = step.name + "." + param;
        parts.origin.values[name] = short_value(text);
        parts.values[name] = {document, "parameter", {step.name}};
    };
    for (const auto& [param, value] : step.values) add_value(param, format_source(value));
    if (const std::string mix = format_source(step.mix); mix != format_source(ParamValue(1.0)))
        add_value("mix", mix);
    if (step.mask) add_value("mask", text_of(*step.mask));
    for (const ParamSpec& spec : step.manifest->params) {
        std::string content;
        for (const ParamValue& value : step.known_values(spec)) content += spec.type->content(value);
        if (content.empty()) continue;
        const std::string name = step.name + "." + spec.name + " (content)";
        parts.origin.values[name] = short_hash(content);
        parts.values[name] = {"", "profile", {step.name}};
    }
}

std::string CaseTracer::name_of(const fs::path& file) const {
    const fs::path whole = fs::absolute(file).lexically_normal();
    const fs::path shipped = whole.lexically_relative(data_);
    for (const char* folder : {"effects", "glsl", "profiles"})
        if (!shipped.empty() && *shipped.begin() == folder) return shipped.generic_string();
    return whole.lexically_proximate(suite_folder_).generic_string();
}

TracedCase render_traced(const GoldenCase& test, const std::vector<std::string>& taps,
                         const GoldenRenderOptions& options, const fs::path& work,
                         const std::atomic<bool>& interrupt) {
    GoldenCase tapped = test;
    const auto is_own = [&](const std::string& tap) {
        return std::ranges::find(test.taps, tap) != test.taps.end();
    };
    for (const std::string& tap : taps)
        if (!is_own(tap)) tapped.taps.push_back(tap);
    TracedCase traced{render_case(tapped, options, work, interrupt), {}};
    for (const std::string& tap : taps)
        for (const RenderedImage& image : traced.rendered.images) {
            if (image.output != tap) continue;
            const std::size_t dot = tap.find('.');
            std::vector<StepHashes>& steps = traced.steps[image.frame];
            if (steps.empty() || steps.back().step != tap.substr(0, dot))
                steps.push_back({tap.substr(0, dot), {}});
            steps.back().outputs[tap.substr(dot + 1)] = pixel_hash(image.file);
        }
    std::erase_if(traced.rendered.images, [&](const RenderedImage& image) {
        return std::ranges::find(taps, image.output) != taps.end() && !is_own(image.output);
    });
    return traced;
}

}  // namespace aftershade
