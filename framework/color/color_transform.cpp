#include "framework/color/color_transform.h"

#include <algorithm>
#include <optional>

#include "framework/color/color_glsl.h"
#include "framework/color/ocio_config.h"
#include "framework/color/ocio_encoding.h"
#include "framework/color/ocio_parts.h"
#include "framework/document/glsl_text.h"

namespace aftershade {

#ifndef AFTERSHADE_HAS_OPENCOLORIO

namespace {
const ColorFault kAbsent = {
    "",
    "this program was built without OpenColorIO; install its library (Debian: libopencolorio-dev) and "
    "build again"};
}

std::variant<ColorTransform, ColorFault> make_color_transform(const ColorRequest&) {
    return kAbsent;
}
std::variant<ColorNames, ColorFault> color_names(const std::string&) {
    return kAbsent;
}
bool has_opencolorio() {
    return false;
}

#else

namespace ocio = OCIO_NAMESPACE;
namespace fs = std::filesystem;

namespace {

/// The same with cubes whose text is short: OpenColorIO's own for tetrahedra has six branches, of which
/// software GL runs each.
ocio::ConstProcessorRcPtr with_plain_cubes(const ocio::ConstConfigRcPtr& config,
                                           const ocio::ConstProcessorRcPtr& processor) {
    const ocio::GroupTransformRcPtr group = processor->createGroupTransform();
    for (int i = 0; i < group->getNumTransforms(); ++i)
        if (const auto cube = std::dynamic_pointer_cast<ocio::Lut3DTransform>(group->getTransform(i)))
            cube->setInterpolation(ocio::INTERP_LINEAR);
    return config->getProcessor(group);
}

ocio::GpuShaderDescRcPtr shader_of(const ocio::ConstProcessorRcPtr& processor, const std::string& function) {
    ocio::GpuShaderDescRcPtr shader = ocio::GpuShaderDesc::CreateShaderDesc();
    shader->setLanguage(ocio::GPU_LANGUAGE_GLSL_4_0);
    shader->setFunctionName(function.c_str());
    shader->setResourcePrefix((function + "_").c_str());
    processor->getDefaultGPUProcessor()->extractGpuShaderInfo(shader);
    return shader;
}

/// Older versions of OpenColorIO take a LUT that says nothing.
void check_points(unsigned points) {
    if (points < 2) throw ocio::Exception("a LUT has 1 point a side; it needs 2 at least");
}

ShaderLut curve_of(const ocio::GpuShaderDesc& shader, unsigned index) {
    const char *texture = nullptr, *sampler = nullptr;
    unsigned width = 0, height = 0;
    auto channel = ocio::GpuShaderDesc::TEXTURE_RGB_CHANNEL;
    auto interpolation = ocio::INTERP_LINEAR;
#if OCIO_VERSION_HEX >= 0x02030000
    auto dimensions = ocio::GpuShaderDesc::TEXTURE_2D;
    shader.getTexture(index, texture, sampler, width, height, channel, dimensions, interpolation);
#else
    shader.getTexture(index, texture, sampler, width, height, channel, interpolation);
#endif
    check_points(width);
    ShaderLut lut{sampler, 2, int(width), int(std::max(height, 1u)), 3, false, {}};
    if (channel == ocio::GpuShaderDesc::TEXTURE_RED_CHANNEL) lut.channels = 1;
    const float* values = nullptr;
    shader.getTextureValues(index, values);
    lut.values.assign(values,
                      values + std::size_t(lut.width) * std::size_t(lut.height) * std::size_t(lut.channels));
    return lut;
}

ShaderLut cube_of(const ocio::GpuShaderDesc& shader, unsigned index, bool is_tetrahedral) {
    const char *texture = nullptr, *sampler = nullptr;
    unsigned edge = 0;
    auto interpolation = ocio::INTERP_LINEAR;
    shader.get3DTexture(index, texture, sampler, edge, interpolation);
    check_points(edge);
    ShaderLut lut{sampler, 3, int(edge), int(edge), 3, is_tetrahedral, {}};
    const float* values = nullptr;
    shader.get3DTextureValues(index, values);
    lut.values.assign(values, values + std::size_t(edge) * edge * edge * 3);
    return lut;
}

bool is_tetrahedral(const ocio::GpuShaderDesc& shader, unsigned index) {
    const char *texture = nullptr, *sampler = nullptr;
    unsigned edge = 0;
    auto interpolation = ocio::INTERP_LINEAR;
    shader.get3DTexture(index, texture, sampler, edge, interpolation);
    return interpolation == ocio::INTERP_TETRAHEDRAL;
}

/// The function that shaders call, around the parts' calls. A config's light is the capture's where no space
/// is said.
std::string wrapper_of(const ColorRequest& request, const std::string& calls) {
    const bool takes_light = !request.is_file && request.word("source").empty();
    const bool gives_light = !request.is_file && !request.is_view() && request.word("destination").empty();
    const bool has_light_before = request.inverse ? gives_light : takes_light;
    const bool has_light_after = request.inverse ? takes_light : gives_light;
    return "vec3 " + request.function + "(vec3 rgb) {\n" +
           (has_light_before ? "    rgb = frame.rec709_from_color * rgb;\n" : "") + calls + "    return " +
           (has_light_after ? "inverse(frame.rec709_from_color) * " : "") + "rgb;\n}\n";
}

/// OpenColorIO's text of a part, with its LUTs in the table; nullopt where it has a form that there is no
/// place for.
std::optional<std::string> text_of_part(const ocio::ConstConfigRcPtr& config,
                                        const ocio::ConstProcessorRcPtr& processor, const std::string& name,
                                        const std::string& table, std::vector<float>& texels) {
    const auto given = shader_of(processor, name);
    const auto shader = shader_of(with_plain_cubes(config, processor), name);
    if (shader->getNumUniforms() > 0 || given->getNum3DTextures() != shader->getNum3DTextures())
        return std::nullopt;
    std::vector<ShaderLut> luts;
    for (unsigned i = 0; i < shader->getNumTextures(); ++i) luts.push_back(curve_of(*shader, i));
    for (unsigned i = 0; i < shader->getNum3DTextures(); ++i)
        luts.push_back(cube_of(*shader, i, is_tetrahedral(*given, i)));
    return glsl_with_table(shader->getShaderText(), luts, table, texels);
}

/// The cache of processors of OpenColorIO 2.1 takes two LUTs of one size and one range for the same.
ocio::ConstConfigRcPtr without_cache(const ocio::ConstConfigRcPtr& config) {
    const ocio::ConfigRcPtr copy = config->createEditableCopy();
    copy->setProcessorCacheFlags(ocio::PROCESSOR_CACHE_OFF);
    return copy;
}

std::variant<ColorTransform, ColorFault> transform_of(const ocio::ConstConfigRcPtr& given,
                                                      const ocio::ConstProcessorRcPtr& processor,
                                                      const ColorRequest& request) {
    const ocio::ConstConfigRcPtr config = without_cache(given);
    ColorTransform transform;
    const std::string table = request.function + "_table";
    std::vector<float> texels;
    std::string calls;
    int parts = 0;
    transform.channels = 2;
    for (const TransformPart& part : parts_of(config, processor, request.is_view() && !request.inverse)) {
        const std::string name = request.function + "_" + std::to_string(parts++);
        const bool is_ours = part.curve || !part.text.empty();
        const auto text = part.curve ? glsl_of_curve(*part.curve, name, table, texels)
                          : is_ours  ? filled(part.text, {{"name", name}})
                                     : text_of_part(config, part.processor, name, table, texels);
        if (!text)
            return ColorFault{
                "", "OpenColorIO " + std::string(ocio::GetVersion()) +
                        " gives this transform a form that the program cannot take: bake it into a LUT"};
        if (text->find(table) != std::string::npos && !part.curve) transform.channels = 4;
        transform.glsl += *text;
        calls += is_ours ? "    rgb = " + name + "(rgb);\n" : "    rgb = " + name + "(vec4(rgb, 1.0)).rgb;\n";
    }
    transform.texels = table_of(texels, transform.channels);
    transform.glsl += wrapper_of(request, calls);
    const auto metadata = processor->getProcessorMetadata();
    for (int i = 0; i < metadata->getNumFiles(); ++i) transform.files.emplace_back(metadata->getFile(i));
    return transform;
}

std::variant<ColorTransform, ColorFault> of_config(const ColorRequest& request) {
    auto opened = open_config(request.path);
    if (auto* fault = std::get_if<ColorFault>(&opened)) return *fault;
    const OcioConfig& config = std::get<OcioConfig>(opened);
    try {
        const auto processor = processor_of(config, request);
        if (const auto* fault = std::get_if<ColorFault>(&processor)) return *fault;
        auto made = transform_of(config.config, std::get<ocio::ConstProcessorRcPtr>(processor), request);
        if (auto* transform = std::get_if<ColorTransform>(&made)) {
            if (const fs::path file = escaped_file(config, transform->files); !file.empty())
                return ColorFault{"", config.name + " names '" + file.string() +
                                          "', which lies outside of its folder and its search path"};
            if (const auto encoding = encoding_of_result(config, request)) transform->encoding = *encoding;
            if (!config.file.empty()) transform->files.insert(transform->files.begin(), config.file);
        }
        return made;
    } catch (const ocio::Exception& error) {
        return fault_of_config(config, error);
    }
}

std::variant<ColorTransform, ColorFault> of_file(const ColorRequest& request) {
    if (std::error_code failure; !fs::is_regular_file(request.path, failure))
        return ColorFault{"", "no file '" + request.path + "'"};
    try {
        const auto config = ocio::Config::CreateRaw();
        const auto transform = ocio::FileTransform::Create();
        transform->setSrc(request.path.c_str());
        transform->setCCCId(request.word("correction").c_str());
        transform->setInterpolation(ocio::INTERP_BEST);
        return transform_of(config,
                            config->getProcessor(transform, request.inverse ? ocio::TRANSFORM_DIR_INVERSE
                                                                            : ocio::TRANSFORM_DIR_FORWARD),
                            request);
    } catch (const ocio::Exception& error) {
        return ColorFault{request.word("correction").empty() ? "" : "correction",
                          "'" + request.path + "' is not a transform that OpenColorIO " + ocio::GetVersion() +
                              " can use: " + one_line(error.what())};
    }
}

}  // namespace

std::variant<ColorTransform, ColorFault> make_color_transform(const ColorRequest& request) {
    ocio::ClearAllCaches();  // OpenColorIO would not see that a LUT has changed
    return request.is_file ? of_file(request) : of_config(request);
}

std::variant<ColorNames, ColorFault> color_names(const std::string& path) {
    auto opened = open_config(path);
    if (auto* fault = std::get_if<ColorFault>(&opened)) return *fault;
    return names_of(std::get<OcioConfig>(opened));
}

bool has_opencolorio() {
    return true;
}

#endif

}  // namespace aftershade
