// What a plug-in may ask of the host in prepare.
#include <algorithm>

#include "framework/base/diagnostics.h"
#include "framework/effect/native/native_call.h"

namespace aftershade {

namespace {

constexpr std::size_t kMaxFaults = 8;

std::string quoted(const char* name) {
    return name ? "'" + std::string(name) + "'" : "NULL";
}

}  // namespace

aftershade_status NativeFaults::add(aftershade_status status, std::string text) {
    if (texts_.size() < kMaxFaults) texts_.push_back(std::move(text));
    else ++dropped_;
    return status;
}

std::string NativeFaults::text() const {
    std::string all;
    for (const std::string& text : texts_) all += (all.empty() ? "" : "; ") + text;
    if (dropped_ > 0) all += "; and " + std::to_string(dropped_) + " more";
    return all;
}

/// The callbacks of aftershade_params. None may throw into C.
struct ParamGetters {
    static NativeInput& self(const aftershade_params* params) {
        return *const_cast<NativeInput*>(static_cast<const NativeInput*>(params->host_data));
    }

    static const ParamSpec* spec_of(NativeInput& input, const char* name) {
        const auto& specs = *input.frame_.specs;
        const auto found = std::find_if(specs.begin(), specs.end(),
                                        [&](const ParamSpec& s) { return name && s.name == name; });
        if (found != specs.end()) return &*found;
        std::vector<std::string> names;
        for (const ParamSpec& spec : specs) names.push_back(spec.name);
        input.faults_.add(AFTERSHADE_UNKNOWN_NAME, "asked for the parameter " + quoted(name) +
                                                       ", which effect.json does not declare" +
                                                       did_you_mean(name ? name : "", names));
        return nullptr;
    }

    /// Calls `read(value)`, which is false where the value is of another type.
    template <class Read>
    static aftershade_status get(const aftershade_params* params, const char* name, const void* target,
                                 const char* asked, Read&& read) noexcept try {
        NativeInput& input = self(params);
        const ParamSpec* spec = spec_of(input, name);
        if (!spec) return AFTERSHADE_UNKNOWN_NAME;
        if (!target)
            return input.faults_.add(AFTERSHADE_OUT_OF_RANGE,
                                     "asked for the parameter '" + spec->name + "' with a NULL pointer");
        if (read(input, *spec)) return AFTERSHADE_OK;
        return input.faults_.add(AFTERSHADE_WRONG_TYPE, "asked for the parameter '" + spec->name + "' as " +
                                                            asked + ", it is declared as " +
                                                            std::string(param_type_name(spec->type)));
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    template <class Value, class Target>
    static bool copy(NativeInput& input, const ParamSpec& spec, Target* target) {
        const Value* value = std::get_if<Value>(&input.frame_.params->get(spec.name));
        if (value) *target = *value;
        return value != nullptr;
    }

    static aftershade_status get_float(const aftershade_params* params, const char* name,
                                       double* value) noexcept {
        return get(params, name, value, "float",
                   [&](auto& input, const auto& spec) { return copy<double>(input, spec, value); });
    }
    static aftershade_status get_int(const aftershade_params* params, const char* name,
                                     int64_t* value) noexcept {
        return get(params, name, value, "int",
                   [&](auto& input, const auto& spec) { return copy<std::int64_t>(input, spec, value); });
    }
    static aftershade_status get_bool(const aftershade_params* params, const char* name,
                                      bool* value) noexcept {
        return get(params, name, value, "bool",
                   [&](auto& input, const auto& spec) { return copy<bool>(input, spec, value); });
    }
    static aftershade_status get_enum(const aftershade_params* params, const char* name,
                                      const char** value) noexcept {
        return get(params, name, value, "enum", [&](NativeInput& input, const ParamSpec& spec) {
            const auto* text = std::get_if<std::string>(&input.frame_.params->get(spec.name));
            if (text) *value = text->c_str();
            return text != nullptr;
        });
    }
    static aftershade_status get_vector(const aftershade_params* params, const char* name, double* values,
                                        uint32_t count) noexcept {
        const char* const asked = count == 2   ? "vec2"
                                  : count == 3 ? "vec3 or color"
                                  : count == 4 ? "vec4"
                                               : "?";
        return get(params, name, values, asked, [&](NativeInput& input, const ParamSpec& spec) {
            const auto* vector = std::get_if<std::vector<double>>(&input.frame_.params->get(spec.name));
            if (!vector || vector->size() != count) return false;
            std::copy(vector->begin(), vector->end(), values);
            return true;
        });
    }
    static aftershade_status get_unit(const aftershade_params* params, const char* name,
                                      const char** unit) noexcept {
        return get(params, name, unit, "a unit", [&](NativeInput&, const ParamSpec& spec) {
            *unit = spec.unit.c_str();
            return true;
        });
    }
    static const char* get_text(const aftershade_metadata* metadata, const char* name) noexcept try {
        const auto& texts = static_cast<const NativeInput*>(metadata->host_data)->frame_.metadata;
        const auto found = name ? texts.find(name) : texts.end();
        return found == texts.end() ? nullptr : found->second.c_str();
    } catch (...) {
        return nullptr;
    }
};

NativeInput::NativeInput(const NativeFrame& frame, NativeFaults& faults) : frame_(frame), faults_(faults) {
    params_ = {sizeof params_,           this,
               ParamGetters::get_float,  ParamGetters::get_int,
               ParamGetters::get_bool,   ParamGetters::get_enum,
               ParamGetters::get_vector, ParamGetters::get_unit};
    metadata_ = {sizeof metadata_, this, ParamGetters::get_text};
    fill_camera();
    fill_images();
    fill_frame();
}

void NativeInput::fill_camera() {
    camera_.struct_size = sizeof camera_;
    if (!frame_.camera) return;
    const Camera& camera = *frame_.camera;
    const auto number = [&](const char* name, bool& has, double& value) {
        const auto known = camera.get(name);
        has = known.has_value();
        value = known.value_or(0);
    };
    number("focal_length", camera_.has_focal_length, camera_.focal_length_mm);
    number("sensor_width", camera_.has_sensor_width, camera_.sensor_width_mm);
    number("focus_distance", camera_.has_focus_distance, camera_.focus_distance_m);
    number("f_number", camera_.has_f_number, camera_.f_number);
    number("blades", camera_.has_blades, camera_.blades);
    number("rotation", camera_.has_rotation, camera_.rotation_deg);
    const auto matrix = [](const std::optional<CameraMatrix>& known, bool& has, double* values) {
        has = known.has_value();
        if (known) std::copy(known->begin(), known->end(), values);
    };
    matrix(camera.camera_from_world, camera_.has_view_from_world, camera_.view_from_world);
    matrix(camera.ndc_from_world, camera_.has_clip_from_world, camera_.clip_from_world);
}

void NativeInput::fill_images() {
    for (const NativeImage& image : frame_.images) {
        aftershade_image c_image{};
        c_image.struct_size = sizeof c_image;
        c_image.present = image.present;
        c_image.name = image.name.c_str();
        c_image.role = image.role.c_str();
        if (image.present) {
            c_image.width_px = uint32_t(image.width_px);
            c_image.height_px = uint32_t(image.height_px);
            c_image.channels = uint32_t(image.channels);
        }
        images_.push_back(c_image);
    }
    for (const aftershade_image& image : images_) image_pointers_.push_back(&image);
}

void NativeInput::fill_frame() {
    c_frame_.struct_size = sizeof c_frame_;
    c_frame_.number = frame_.number;
    c_frame_.fps = frame_.fps;
    c_frame_.width_px = uint32_t(frame_.width_px);
    c_frame_.height_px = uint32_t(frame_.height_px);
    c_frame_.display_width_px = uint32_t(frame_.display_width_px);
    c_frame_.display_height_px = uint32_t(frame_.display_height_px);
    c_frame_.history_valid = frame_.history_valid;
    c_frame_.params = &params_;
    c_frame_.camera = &camera_;
    c_frame_.metadata = &metadata_;
    c_frame_.image_count = uint32_t(image_pointers_.size());
    c_frame_.images = image_pointers_.data();
    c_frame_.step_seed = frame_.step_seed;
}

}  // namespace aftershade
