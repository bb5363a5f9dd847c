#include "framework/effect/color_param.h"

namespace aftershade {

ColorRequest empty_request(const ParamSpec& file) {
    ColorRequest request;
    request.function = file.name;
    request.is_file = file.file_kind == FileKind::ocio_transform;
    return request;
}

bool is_color_part(const ParamSpec& spec) {
    return is_ocio_file(spec) || !spec.ocio.empty();
}

void set_color_part(ColorRequest& request, const ParamSpec& spec, const ParamValue& value) {
    if (is_ocio_file(spec)) request.path = std::get<std::string>(value);
    else if (spec.type == ParamType::bool_) request.inverse = std::get<bool>(value);
    else request.words[spec.ocio] = std::get<std::string>(value);
}

std::optional<ColorRequest> color_request(const EffectManifest& manifest, const ParamSpec& file,
                                          const std::function<ParamValue(const ParamSpec&)>& value) {
    ColorRequest request = empty_request(file);
    for (const ParamSpec& spec : manifest.params)
        if (!spec.ocio.empty() || spec.name == file.name) set_color_part(request, spec, value(spec));
    if (request.is_file && request.path.empty()) return std::nullopt;
    return request;
}

const ParamSpec& param_at_fault(const EffectManifest& manifest, const ParamSpec& file,
                                const ColorFault& fault) {
    for (const ParamSpec& spec : manifest.params)
        if (!fault.part.empty() && spec.ocio == fault.part) return spec;
    return file;
}

}  // namespace aftershade
