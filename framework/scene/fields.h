// The values of a scene document, declared once: reading, checking, the JSON Schema and the docs come from
// here.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "framework/core/diagnostics.h"
#include "framework/core/document.h"
#include "framework/core/param.h"
#include "framework/scene/animated.h"

namespace aftershade::scene {

/// Limits that keep a mistyped scene from taking the machine's memory.
inline constexpr std::size_t kMaxObjects = 8192;
inline constexpr std::size_t kMaxLights = 64;
/// A cut is a frame of this number at most, either side of 0.
inline constexpr int kMaxCut = 1000000;

struct Field {
    ParamSpec spec;
    bool animated = false;  ///< may be {"keys": {"1": ..., "24": ...}, "interpolation": "linear"}
    bool required = false;
    bool uniform = false;       ///< a vector that may be written as one number
    bool whole = false;         ///< a vector of whole numbers
    bool has_length = false;    ///< a vector that is not 0
    std::vector<double> never;  ///< within the range, but without a meaning that `doc` gives
    std::string block;          ///< an object with the keys of this block may stand for it
};

/// A key whose value is no number, flag or word: a name, a list, an object with keys of its own.
struct Part {
    enum class Form {
        text,
        file,         ///< path from the document's folder
        name,         ///< of an `of` of this document
        object,       ///< with the keys of the block `of`
        list,         ///< of such objects
        by_name,      ///< such objects by name
        values,       ///< a list of values of the material's field `of`
        scattering,   ///< a scattering profile: a name, a path, an object
        frame_range,  ///< "1-24", or one number
        frames,       ///< a list of numbers of frames
    };
    std::string name;
    Form form = Form::text;
    std::string of;
    std::string doc;
    bool required = false;
    int min_items = 0;
    int max_items = -1;  ///< -1: any number
};

/// The fields of one kind of object in the document.
struct Block {
    std::string name;  ///< "camera", "material", "plane", "point", ...
    std::string doc;
    std::vector<Field> fields;
    std::vector<Part> parts = {};
    const Field& field(const std::string& name) const;  ///< must exist
};

const Block& camera_block();
const Block& shutter_block();
const Block& material_block();
const Block& checker_block();
const Block& mesh_block();  ///< has one of its parts
const Block& height_field_block();
const Block& wave_block();
const Block& repeat_block();
const Block& pattern_block();
/// What every object has, and what each shape (the key "shape") has beside it.
const Block& object_block();
const std::vector<Block>& shape_blocks();
/// What every light has, and what each type (the key "type") has beside it.
const Block& light_block();
const std::vector<Block>& light_blocks();
/// Of the document itself.
const Block& scene_block();

const Block* find_block(std::span<const Block> blocks, const std::string& name);

/// Takes values of fields out of an object; `label` begins messages: "camera.f_number: 0 is below ...".
class FieldReader {
public:
    FieldReader(ObjectReader& reader, std::string label, Diagnostics& diagnostics)
        : reader_(reader), label_(std::move(label)), diagnostics_(diagnostics) {}

    // Each is the field's default where the document has no such key, or one that is wrong.
    double number(const Block& block, const std::string& name) { return animated_number(block, name).at(0); }
    int integer(const Block& block, const std::string& name) { return int(number(block, name)); }
    bool flag(const Block& block, const std::string& name);
    std::string choice(const Block& block, const std::string& name);
    glm::dvec2 vec2(const Block& block, const std::string& name);
    glm::dvec3 vec3(const Block& block, const std::string& name) { return animated_vec3(block, name).at(0); }
    Animated<double> animated_number(const Block& block, const std::string& name);
    Animated<glm::dvec3> animated_vec3(const Block& block, const std::string& name);
    /// A value of a field of three numbers that stands elsewhere than by the field's key.
    std::optional<glm::dvec3> vec3(const Field& field, const Node& node);

private:
    struct Keys {
        std::vector<double> frames;
        std::vector<std::vector<double>> values;
        Interpolation interpolation = Interpolation::linear;
    };
    Keys read(const Block& block, const std::string& name);
    std::optional<std::vector<double>> read_value(const Field& field, const Node& node);
    std::optional<std::vector<double>> read_numbers(const Field& field, const Node& node);
    Keys read_keys(const Field& field, const Node& node);

    ObjectReader& reader_;
    std::string label_;
    Diagnostics& diagnostics_;
};

/// "linear", "step", "smooth".
const std::vector<std::string>& interpolation_names();

}  // namespace aftershade::scene
