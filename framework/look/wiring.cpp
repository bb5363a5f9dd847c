#include "framework/look/wiring.h"

#include <string>
#include <vector>

#include "framework/image/role.h"

namespace aftershade {

namespace {

bool takes_any_role(const InputSpec& input) {
    return kind_of_role(input.role) == RoleKind::other;
}

std::string input_text(const InputSpec& input, const EffectManifest& effect) {
    return "input '" + input.name + "' of " + effect.id;
}

std::string role_text(const InputSpec& input) {
    return "the role '" + input.role + "' (" + to_string(input.place) + ")";
}

/// "" where an image of `role` may go to the input.
std::string role_fault(const std::string& role, const InputSpec& input, const EffectManifest& effect) {
    if (role == input.role) return "";
    const std::string text = input_text(input, effect) + " takes " + role_text(input);
    if (!takes_any_role(input)) return text + ", not '" + role + "'";
    if (find_role(role)->type == ComponentType::float32) return "";
    return text + ", for which any image of floats will do, but '" + role + "' has whole numbers";
}

std::string grid_text(const GridSpec& grid) {
    switch (grid.kind) {
        case GridSpec::Kind::size: return "a size of its own";
        case GridSpec::Kind::tile: return "a texel per tile";
        case GridSpec::Kind::scale: break;
    }
    if (grid.has_room()) return "room beside the frame";
    return "another scale";
}

/// "" where the texture may go to the input; else what is wrong, after "texture 'x' of y (place)".
std::string texture_fault(const TextureSpec& texture, const InputSpec& input, const EffectManifest& effect) {
    const ChannelRole role = *find_role(input.role);
    const std::string format{gpu::texture_format_name(texture.format)};
    const std::string user = input_text(input, effect);
    if (texture.layers > 1)
        return "has " + std::to_string(texture.layers) + " layers; " + user + " takes a texture of one";
    if (role.type == ComponentType::float32 && gpu::is_integer(texture.format))
        return "is " + format + ", whole numbers; " + user + " reads floats (" + role_text(input) + ")";
    if (role.type == ComponentType::uint32 &&
        (!gpu::is_integer(texture.format) || texture.format == gpu::TextureFormat::r32i))
        return "is " + format + "; " + user + " reads unsigned whole numbers (" + role_text(input) + ")";
    if (takes_any_role(input)) return "";
    if (!(texture.grid == GridSpec{}))
        return "has " + grid_text(texture.grid) + "; " + user + " takes " + role_text(input) +
               ", which has the working grid's size";
    if (gpu::channel_count(texture.format) < role.channels)
        return "is " + format + "; " + user + " takes " + role_text(input) + ", which has " +
               std::to_string(role.channels) + " channels";
    return "";
}

std::string known_names(const EffectManifest& maker, std::vector<std::string>& all) {
    std::vector<std::string> outputs, textures;
    for (const OutputSpec& output : maker.outputs) outputs.push_back(output.name);
    for (const TextureSpec& texture : maker.textures)
        if (texture.layers == 1) textures.push_back(texture.name);
    all = outputs;
    all.insert(all.end(), textures.begin(), textures.end());
    return " (outputs: " + list_of_names(outputs, "and") +
           (textures.empty() ? "; no textures)" : "; textures: " + list_of_names(textures, "and") + ")");
}

/// "" where it fits; else the whole message.
std::string fault_of_step(const WiringSpec& wiring, const InputSpec& input, const EffectManifest& effect,
                          const EffectManifest& maker) {
    if (const OutputSpec* output = maker.find_output(wiring.output)) {
        const std::string fault = role_fault(output->role, input, effect);
        return fault.empty() ? ""
                             : fault + ", which " + maker.id + " declares at " + to_string(output->place);
    }
    if (const TextureSpec* texture = maker.find_texture(wiring.output)) {
        const std::string fault = texture_fault(*texture, input, effect);
        return fault.empty() ? ""
                             : "texture '" + texture->name + "' of " + maker.id + " (" +
                                   to_string(texture->place) + ") " + fault;
    }
    std::vector<std::string> all;
    const std::string known = known_names(maker, all);
    return maker.id + " has no output or texture '" + wiring.output + "'" + did_you_mean(wiring.output, all) +
           known;
}

}  // namespace

std::optional<InputSource> wired_source(const WiringSpec& wiring, const InputSpec& input,
                                        const EffectManifest& effect, const EffectManifest* maker, int index,
                                        Diagnostics& diagnostics) {
    std::string fault;
    if (maker && input.frame != 0)
        fault = input_text(input, effect) + " is of another frame, which only the capture has";
    else if (maker) fault = fault_of_step(wiring, input, effect, *maker);
    else if (!find_role(wiring.output))
        fault = "'" + wiring.output + "' is not a role" + did_you_mean(wiring.output, role_names());
    else fault = role_fault(wiring.output, input, effect);
    if (fault.empty()) return InputSource{index, wiring.output};
    diagnostics.error(wiring.place, fault);
    return std::nullopt;
}

}  // namespace aftershade
