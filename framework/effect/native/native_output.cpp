// What a plug-in may tell the host in prepare, held against effect.json.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "framework/base/diagnostics.h"
#include "framework/effect/native/native_call.h"

namespace aftershade {

namespace {

constexpr int kMaxNativeRepeat = 1000;
constexpr int kMaxWarmUpFrames = 1000;
constexpr int kMaxOverscan_px = 4096;

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
    std::vector<std::string> keys;
    for (const auto& [key, value] : map) keys.push_back(key);
    return keys;
}

/// "uniform 'gian' is not declared in effect.json; did you mean 'gain'?"
std::string unknown(const std::string& kind, const char* name, const std::vector<std::string>& known) {
    if (!name) return kind + " NULL: a name is missing";
    return kind + " '" + name + "' is not declared in effect.json" + did_you_mean(name, known) +
           (known.empty() ? " (it declares none)" : "");
}

template <class Scalar>
constexpr NativeScalar kScalarOf = std::is_same_v<Scalar, float>          ? NativeScalar::float_
                                   : std::is_same_v<Scalar, std::int32_t> ? NativeScalar::int_
                                                                          : NativeScalar::uint_;

std::string type_text(NativeScalar scalar, std::uint32_t count) {
    if (count >= 1 && count <= 4) return native_uniform_type_name({scalar, int(count)});
    return std::to_string(count) + " components (1 to 4 are possible)";
}

template <class Scalar>
bool has_nan(const Scalar* values, std::size_t count) {
    if constexpr (std::is_floating_point_v<Scalar>)
        return std::any_of(values, values + count, [](Scalar value) { return std::isnan(value); });
    return false;
}

bool is_float(NativeElement element) {
    return element <= NativeElement::vec4;
}

/// By memcpy, for a plug-in's bytes may lie anywhere.
bool has_nan(const std::vector<std::byte>& bytes) {
    for (std::size_t at = 0; at + 4 <= bytes.size(); at += 4) {
        float value;
        std::memcpy(&value, &bytes[at], 4);
        if (std::isnan(value)) return true;
    }
    return false;
}

/// "" where the table fits its declaration.
std::string table_fault(const NativeTableType& type, aftershade_element element, std::uint32_t width,
                        std::uint32_t height, std::size_t byte_count) {
    if (element < AFTERSHADE_FLOAT || element > AFTERSHADE_UVEC4)
        return "has the element " + std::to_string(element) + ", which is not an aftershade_element";
    if (NativeElement(element) != type.element)
        return "is filled with " + std::string(native_element_name(NativeElement(element))) +
               ", effect.json declares " + std::string(native_element_name(type.element));
    if (width < 1 || height < 1 || width > std::uint32_t(type.max_width) ||
        height > std::uint32_t(type.max_height))
        return "is " + std::to_string(width) + " x " + std::to_string(height) +
               ", the limit of effect.json is " + std::to_string(type.max_width) + " x " +
               std::to_string(type.max_height) + " (and at least 1 x 1)";
    const std::size_t wanted = std::size_t(width) * height * native_element_bytes(type.element);
    if (byte_count != wanted)
        return "comes with " + std::to_string(byte_count) + " bytes; " + std::to_string(width) + " x " +
               std::to_string(height) + " elements of " + std::string(native_element_name(type.element)) +
               " take " + std::to_string(wanted);
    return "";
}

}  // namespace

/// The callbacks of aftershade_output. None may throw into C.
struct OutputSetters {
    static NativeOutput& self(const aftershade_output* output) {
        return *static_cast<NativeOutput*>(output->host_data);
    }

    template <class Scalar>
    static aftershade_status set_uniform(const aftershade_output* output, const char* name,
                                         const Scalar* values, uint32_t count) noexcept try {
        NativeOutput& out = self(output);
        const auto& declared = out.declaration_.uniforms;
        const auto found = name ? declared.find(name) : declared.end();
        if (found == declared.end())
            return out.faults_.add(AFTERSHADE_UNKNOWN_NAME, unknown("uniform", name, keys_of(declared)));
        const NativeUniformType type = found->second;
        const std::string label = "uniform '" + found->first + "'";
        if (type.scalar != kScalarOf<Scalar> || std::uint32_t(type.components) != count)
            return out.faults_.add(AFTERSHADE_WRONG_TYPE,
                                   label + " is set as " + type_text(kScalarOf<Scalar>, count) +
                                       ", effect.json declares " + native_uniform_type_name(type));
        if (!values) return out.faults_.add(AFTERSHADE_OUT_OF_RANGE, label + " is set from a NULL pointer");
        if (has_nan(values, count)) return out.faults_.add(AFTERSHADE_OUT_OF_RANGE, label + " is NaN");
        out.result_.uniforms[found->first] = std::vector<Scalar>(values, values + count);
        return AFTERSHADE_OK;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    static aftershade_status set_table(const aftershade_output* output, const char* name,
                                       aftershade_element element, uint32_t width, uint32_t height,
                                       const void* data, size_t byte_count) noexcept try {
        NativeOutput& out = self(output);
        const auto& declared = out.declaration_.tables;
        const auto found = name ? declared.find(name) : declared.end();
        if (found == declared.end())
            return out.faults_.add(AFTERSHADE_UNKNOWN_NAME, unknown("table", name, keys_of(declared)));
        const std::string label = "table '" + found->first + "' ";
        const std::string fault = table_fault(found->second, element, width, height, byte_count);
        if (!fault.empty())
            return out.faults_.add(
                fault.starts_with("is filled") ? AFTERSHADE_WRONG_TYPE : AFTERSHADE_OUT_OF_RANGE,
                label + fault);
        if (!data) return out.faults_.add(AFTERSHADE_OUT_OF_RANGE, label + "is filled from a NULL pointer");
        const auto* bytes = static_cast<const std::byte*>(data);
        NativeTable table{NativeElement(element), int(width), int(height), {bytes, bytes + byte_count}};
        if (is_float(table.element) && has_nan(table.bytes))
            return out.faults_.add(AFTERSHADE_OUT_OF_RANGE, label + "holds NaN");
        out.result_.tables[found->first] = std::move(table);
        return AFTERSHADE_OK;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    /// AFTERSHADE_OK, or after a fault its status.
    static aftershade_status check_pass(NativeOutput& out, const char* pass) {
        const auto& passes = out.declaration_.passes;
        if (pass && std::find(passes.begin(), passes.end(), pass) != passes.end()) return AFTERSHADE_OK;
        return out.faults_.add(AFTERSHADE_UNKNOWN_NAME, unknown("pass", pass, passes));
    }

    static aftershade_status check_range(NativeOutput& out, const std::string& label, int32_t value, int low,
                                         int high) {
        if (value >= low && value <= high) return AFTERSHADE_OK;
        return out.faults_.add(AFTERSHADE_OUT_OF_RANGE, label + " is " + std::to_string(value) +
                                                            ", outside " + std::to_string(low) + " to " +
                                                            std::to_string(high));
    }

    static aftershade_status set_repeat(const aftershade_output* output, const char* pass,
                                        int32_t count) noexcept try {
        NativeOutput& out = self(output);
        aftershade_status status = check_pass(out, pass);
        if (status == AFTERSHADE_OK)
            status =
                check_range(out, "repeat of pass '" + std::string(pass) + "'", count, 1, kMaxNativeRepeat);
        if (status == AFTERSHADE_OK) out.result_.repeats[pass] = count;
        return status;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    static aftershade_status set_enabled(const aftershade_output* output, const char* pass,
                                         bool enabled) noexcept try {
        NativeOutput& out = self(output);
        const aftershade_status status = check_pass(out, pass);
        if (status == AFTERSHADE_OK) out.result_.enabled[pass] = enabled;
        return status;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    static aftershade_status set_warm_up_frames(const aftershade_output* output, int32_t count) noexcept try {
        NativeOutput& out = self(output);
        const aftershade_status status =
            check_range(out, "the number of warm-up frames", count, 0, kMaxWarmUpFrames);
        if (status == AFTERSHADE_OK) out.result_.warm_up_frames = count;
        return status;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }

    static aftershade_status set_overscan(const aftershade_output* output, int32_t px) noexcept try {
        NativeOutput& out = self(output);
        const aftershade_status status = check_range(out, "the overscan in px", px, 0, kMaxOverscan_px);
        if (status == AFTERSHADE_OK) out.result_.overscan_px = px;
        return status;
    } catch (...) {
        return AFTERSHADE_OUT_OF_MEMORY;
    }
};

NativeOutput::NativeOutput(const NativeDeclaration& declaration, NativeFaults& faults)
    : declaration_(declaration), faults_(faults) {
    output_ = {sizeof output_,
               this,
               OutputSetters::set_uniform<float>,
               OutputSetters::set_uniform<std::int32_t>,
               OutputSetters::set_uniform<std::uint32_t>,
               OutputSetters::set_table,
               OutputSetters::set_repeat,
               OutputSetters::set_enabled,
               OutputSetters::set_warm_up_frames,
               OutputSetters::set_overscan};
}

void NativeOutput::require_everything() {
    const auto require = [&](const std::string& kind, const auto& declared, const auto& set) {
        for (const auto& [name, type] : declared)
            if (!set.contains(name))
                faults_.add(AFTERSHADE_FAILED,
                            kind + " '" + name + "' is declared in effect.json and was not set");
    };
    require("uniform", declaration_.uniforms, result_.uniforms);
    require("table", declaration_.tables, result_.tables);
}

}  // namespace aftershade
