// A type of one class that reaches shaders by a texture: the type of this file is known to nobody else.
#include "framework/document/param_type.h"

#include <memory>

#include "framework/document/glsl_text.h"
#include "framework/effect/param_types.h"
#include "framework/effect/shader_source.h"
#include "tests/document/param_specs.h"
#include "tests/effect/assembly.h"
#include "tests/effect/effect_folder.h"
#include "tests/effect/param_resources_on.h"

namespace aftershade {
namespace {

using test::Vec4;

// [1, 4, 9]: numbers that shaders read by their place.
namespace steps {

struct Steps final : ValueContent {
    std::vector<double> numbers;
    bool equals(const ValueContent& other) const override {
        return numbers == static_cast<const Steps&>(other).numbers;
    }
    std::string text() const override { return format_numbers(numbers); }
};

const Steps& content_of(const ParamValue& value) {
    return dynamic_cast<const Steps&>(std::get<OpaqueValue>(value).content());
}

class StepsTexture final : public AbstractParamTexture {
public:
    TexelSize size(const ParamValue& value) const override {
        return {int(content_of(value).numbers.size()), 1, 1};
    }

    std::vector<float> texels(const ParamSpec&, const ParamValue& value) const override {
        const auto& numbers = content_of(value).numbers;
        return {numbers.begin(), numbers.end()};
    }

    std::string glsl(const ParamSpec& spec, int binding) const override {
        return filled(
            R"(layout(binding = $binding) uniform sampler2D $texture;
float $name(int i) { return texelFetch($texture, ivec2(i, 0), 0).r; }
)",
            {{"binding", std::to_string(binding)}, {"name", spec.name}, {"texture", spec.name + "_steps"}});
    }
};

constexpr StepsTexture kTexture;

class StepsType final : public AbstractParamType {
public:
    constexpr StepsType()
        : AbstractParamType(
              {.name = "steps", .home = ParamHome::resource, .texture = &kTexture, .has_defines = true}) {}

    std::optional<ParamValue> parse(const ValueReader& reader, const Node& node) const override {
        if (!node.is_array()) return reader.wrong_kind(node, "numbers");
        auto content = std::make_shared<Steps>();
        for (const Node& item : node.items) content->numbers.push_back(item.number);
        return OpaqueValue(std::move(content));
    }

    nlohmann::ordered_json literal_schema(const ParamSpec&, const schema::LiteralParts&) const override {
        return {{"type", "array"}};
    }

    std::string defines(const ParamSpec& spec, const ParamValue& value) const override {
        return "#define " + upper_case(spec.name) + "_COUNT " +
               std::to_string(content_of(value).numbers.size()) + "\n";
    }
};

constexpr StepsType kType;
const ParamType kTypes[] = {kType};

}  // namespace steps

ParamSpec steps_spec() {
    return test::spec_of(R"({"type": "steps", "default": [1, 4, 9], "doc": "."})", "levels", steps::kTypes);
}

TEST(ParamTypes, AreThoseOfCoreThenThoseAboveIt) {
    Diagnostics diagnostics;
    test::parse_param_spec("p", test::parsed(R"({"type": "flaot", "default": 1, "doc": "."})"), diagnostics,
                           param_types());
    EXPECT_EQ(test::lines_of(diagnostics),
              test::Lines{
                  "doc.json:1:10: error: 'type' is 'flaot' but must be 'float', 'int', 'bool', 'enum', "
                  "'angle', 'color', 'vec2', 'vec3', 'vec4', 'curve', 'file', 'table', 'objects', 'text' or "
                  "'scattering_profile'; did you mean 'float'?"});
}

TEST(ParamTypes, OfOneClassAreDeclaredToShaders) {
    const test::EffectFolder folder;
    test::Assembly assembly(folder);
    const ParamSpec spec = steps_spec();
    assembly.manifest.params.push_back(spec);
    assembly.params.set(spec.name, spec.default_value);
    const ShaderContext shader{
        &assembly.manifest, &assembly.manifest.passes[0], assembly.params, {}, assembly.glsl.path(), nullptr};
    const PassBindings bindings = pass_bindings(shader);
    ASSERT_EQ(bindings.param_samplers.size(), 1u);
    EXPECT_TRUE(bindings.param_buffers.empty());
    const std::string text = interface_glsl(shader);
    const std::string declared = steps::kTexture.glsl(spec, bindings.first_param_sampler);
    EXPECT_NE(text.find(declared), std::string::npos) << text;
    EXPECT_NE(text.find("#define LEVELS_COUNT 3\n"), std::string::npos) << text;
}

class ParamTypesOn : public test::ParamResourcesOn {};
ON_EACH_BACKEND(ParamTypesOn);

TEST_P(ParamTypesOn, OfOneClassAreReadByShaders) {
    const ParamSpec spec = steps_spec();
    const ParamValue value = test::value_of(spec, "[2, 3, 5, 7]");
    EXPECT_EQ(format_value(spec, value), "[2, 3, 5, 7]");
    EXPECT_EQ(value, test::value_of(spec, "[2, 3, 5, 7]"));
    EXPECT_NE(value, spec.default_value);
    const gpu::Texture texture = uploaded(param_texture(spec, value));
    const auto outputs = computed(param_sampler_glsl(spec, {}, 5), "vec4(levels(int(v.x)))",
                                  {{0, 0, 0, 0}, {3, 0, 0, 0}}, &texture);
    EXPECT_EQ(outputs[0][0], 2);
    EXPECT_EQ(outputs[1][0], 7);
}

}  // namespace
}  // namespace aftershade
