#include <nlohmann/json.hpp>
#include <string>

#include "framework/base/atomic_file.h"
#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/document/object_keys.h"
#include "framework/document/param_type.h"
#include "framework/look/look_content.h"
#include "framework/run/fingerprint.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

/// The document without its layout and without these keys.
std::string document_content(const fs::path& file, std::initializer_list<const char*> left_out) {
    constexpr bool kThrows = true, kIgnoreComments = true;
    try {
        auto document =
            nlohmann::json::parse(read_text_file(file, ErrorKind::usage), nullptr, kThrows, kIgnoreComments);
        for (const char* key : left_out) document.erase(key);
        return document.dump();
    } catch (const nlohmann::json::exception& fault) {
        throw Error(ErrorKind::usage, file.string() + ": " + fault.what());
    }
}

/// What a step was asked for. Files are in content_of_values() by name and content, wherever they lie.
std::string values_text(const PipelineStep& step, const Pipeline& pipeline) {
    const auto source_text = [&](const InputSource& source) {
        return (source.step < 0 ? "capture" : pipeline.steps[std::size_t(source.step)].name) + "." +
               source.output;
    };
    std::string text = "effect " + step.manifest->id + "\n";
    for (const auto& [input, source] : step.inputs) text += input + " takes " + source_text(source) + "\n";
    for (const auto& [output, source] : step.before) text += output + " over " + source_text(source) + "\n";
    for (const auto& [name, value] : step.values) {
        const ParamSpec* spec = step.manifest->find_param(name);
        const bool is_file = spec && is_file_type(spec->type) && std::holds_alternative<ParamValue>(value);
        if (!is_file) text += name + " = " + format_source(value) + "\n";
    }
    text += "mix = " + format_source(step.mix) + "\n";
    if (!step.mask) return text;
    return text + "mask " + step.mask->role + " " + format_object_keys(step.mask->objects) +
           (step.mask->file.empty() ? "" : " file") + (step.mask->invert ? " inverted\n" : "\n");
}

std::string outputs_text(const OutputOptions& outputs, const RunOptions& run) {
    std::string text = "roles";
    for (const std::string& role : outputs.roles) text += " " + role;
    text += outputs.color_type == PixelType::half ? "\nhalf" : "\nfloat";
    if (outputs.keep_channels) text += "\nkeeps channels";
    if (outputs.crop_to_display) text += "\ncropped";
    if (outputs.png_bits != 0) text += "\nPNG of " + std::to_string(outputs.png_bits) + " bits";
    text += "\n" + outputs.compression + "\nscale 1/" + std::to_string(run.scale_divisor);
    if (run.on_nan == NanPolicy::mend) text += " mended";
    if (run.region)
        for (const int number : {run.region->min_x, run.region->min_y, run.region->max_x, run.region->max_y,
                                 run.region_margin_px.value_or(-1)})
            text += " " + std::to_string(number);
    return text;
}

/// How frames are read, by the capture's document and by the command line's words.
std::string capture_text(const FingerprintSource& source) {
    const Sequence& sequence = source.sequence;
    std::string text = sequence.profile + "\n" + sequence.color_space + "\n" + sequence.view + "\n" +
                       sequence.layer + "\n" + (sequence.alpha_is_opaque ? "opaque\n" : "kept\n");
    // Frames may be added and files may move; each frame's own files and cut are in its own part.
    if (source.capture_document)
        text +=
            document_content(*source.capture_document, {"aftershade", "frames", "files", "range", "cuts",
                                                        "profile", "color_space", "view", "layer", "alpha"});
    return text;
}

std::vector<RoleId> roles_read(const FingerprintSource& source) {
    std::vector<RoleId> roles = source.pipeline.capture_roles();
    const auto add = [&](const std::vector<RoleId>& more) {
        roles.insert(roles.end(), more.begin(), more.end());
    };
    add(role_ids(source.outputs.roles));
    for (const int offset : source.pipeline.neighbour_offsets()) add(source.pipeline.neighbour_roles(offset));
    return roles;
}

/// The plug-in that a step's code is from; nothing where it is linked into the program, or where there is
/// none, which rendering reports.
void add_plugin(const EffectManifest& manifest, NativeRegistry* natives, FingerprintParts& parts) {
    if (!manifest.native || !natives) return;
    try {
        const fs::path file = natives->find(manifest.id, manifest.version).library->place();
        if (std::error_code failure; fs::is_regular_file(file, failure) && file.extension() == ".so")
            parts["plug-in " + file.filename().string()] = file_content(file).hash;
    } catch (const Error&) {
    }
}

}  // namespace

FingerprintParts setup_parts(const FingerprintSource& source, const CaptureReader& reader) {
    FingerprintParts parts;
    parts["program"] = AFTERSHADE_VERSION;
    parts["renderer"] = content_hash(source.renderer);
    std::string documents;
    for (const fs::path& file : source.look.files) documents += read_text_file(file, ErrorKind::usage) + "\n";
    parts["look"] = content_hash(documents);
    for (const PipelineStep& step : source.pipeline.steps) {
        const std::string effect = "effect " + step.manifest->id;
        if (!parts.contains(effect))
            parts[effect] = content_hash(content_of_effect(*step.manifest, source.glsl_folder));
        add_plugin(*step.manifest, source.natives, parts);
        parts["values of " + step.name] = content_hash(values_text(step, source.pipeline));
        if (const std::string files = content_of_values(step); !files.empty())
            parts["files of " + step.name] = content_hash(files);
    }
    parts["output options"] = content_hash(outputs_text(source.outputs, source.run));
    parts["capture"] = content_hash(capture_text(source));
    if (const std::string decision = reader.decision(roles_read(source)); !decision.empty())
        parts["what the first frame decides"] = content_hash(decision);
    for (const fs::path& profile : source.profiles)
        parts["profile " + profile.stem().string()] =
            content_hash(document_content(profile, {"summary", "seen_on", "facts"}));
    return parts;
}

}  // namespace aftershade
