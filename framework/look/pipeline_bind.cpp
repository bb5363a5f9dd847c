#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "framework/base/option.h"
#include "framework/base/path_bounds.h"
#include "framework/document/units.h"
#include "framework/file/png_file.h"
#include "framework/image/role.h"
#include "framework/image/step_role.h"
#include "framework/look/look_content.h"
#include "framework/look/pipeline.h"
#include "framework/look/wiring.h"

namespace aftershade {

namespace {

std::vector<std::string> step_names(const Pipeline& pipeline) {
    std::vector<std::string> names;
    for (const PipelineStep& step : pipeline.steps) names.push_back(step.name);
    return names;
}

std::vector<std::string> output_names(const EffectManifest& manifest) {
    std::vector<std::string> names;
    for (const OutputSpec& output : manifest.outputs) names.push_back(output.name);
    return names;
}

/// Binds one step after the other; `pipeline_` holds those before.
class LookBinder {
public:
    LookBinder(EffectRegistry& effects, Diagnostics& diagnostics)
        : effects_(effects), diagnostics_(diagnostics) {}

    void add(const LookStep& look_step) {
        const auto step = bind(look_step);
        if (step && look_step.enabled) {
            warn_of_order(look_step, *step);
            pipeline_.steps.push_back(*step);
        } else absent_[look_step.name] = step ? Absence::disabled : Absence::faulty;
    }

    void apply_set(const std::string& text) {
        const Place place = option_place(Option::set, text);
        const std::size_t equals = text.find('=');
        const std::size_t dot = text.find('.');
        if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
            diagnostics_.error(
                place,
                "expected step.param=value: the name of a step, a parameter of its effect, and a value");
            return;
        }
        apply(text.substr(0, dot), text.substr(dot + 1, equals - dot - 1),
              parse_command_value(text.substr(equals + 1), place), spelled(Option::set));
    }

    void apply_override(const ValueOverride& value) {
        const std::size_t dot = value.name.find('.');
        if (dot == std::string::npos)
            diagnostics_.error(value.value.place,
                               "expected step.param: the name of a step and a parameter of its effect");
        else apply(value.name.substr(0, dot), value.name.substr(dot + 1), value.value, "set");
    }

    void add_tap(const std::string& text) {
        const Place place = option_place(Option::tap, text);
        const std::size_t dot = text.find('.');
        if (dot == std::string::npos) {
            diagnostics_.error(place,
                               "expected step.texture: the name of a step and a texture of its effect");
            return;
        }
        const PipelineStep* step = find_step(text.substr(0, dot), place);
        if (!step) return;
        const std::string texture = text.substr(dot + 1);
        std::vector<std::string> known = output_names(*step->manifest);
        if (const TextureSpec* spec = step->manifest->find_texture(texture); spec && spec->layers > 1) {
            diagnostics_.error(place, step->name + "." + texture + " has " + std::to_string(spec->layers) +
                                          " layers, and a tap shows a texture of one; tap what a pass makes "
                                          "of it");
            return;
        }
        for (const TextureSpec& spec : step->manifest->textures)
            if (spec.layers == 1) known.push_back(spec.name);
        if (std::find(known.begin(), known.end(), texture) == known.end()) {
            diagnostics_.error(place, step->name + " has no texture '" + texture + "'" +
                                          did_you_mean(texture, known) +
                                          " (known: " + list_of_names(known, "and") + ")");
            return;
        }
        pipeline_.taps.push_back({step->name, texture});
    }

    /// Relations between parameters that the user's words alone decide.
    void check_relations_of_literals() {
        for (const PipelineStep& step : pipeline_.steps) {
            ParamSet known;
            std::vector<ParamSpec> specs;
            for (const ParamSpec& spec : step.manifest->params) {
                const auto asked = step.values.find(spec.name);
                const auto* literal =
                    asked == step.values.end() ? nullptr : std::get_if<ParamValue>(&asked->second);
                if (asked != step.values.end() ? !literal : !spec.from.empty()) continue;
                known.set(spec.name, literal ? *literal : spec.default_value);
                specs.push_back(spec);
            }
            for (ParamSpec& spec : specs)
                std::erase_if(spec.relations, [&](const ParamRelation& r) { return !known.has(r.other); });
            for (const RelationFault& fault : check_relations(specs, known)) {
                const auto place = step.places.find(fault.spec->name);
                const auto other = step.places.find(fault.other->name);
                diagnostics_.error(place != step.places.end()   ? place->second
                                   : other != step.places.end() ? other->second
                                                                : fault.spec->place,
                                   relation_message(step.name, fault));
            }
        }
    }

    void check_colors() {
        for (const PipelineStep& step : pipeline_.steps)
            check_color_requests(step, step_places_[step.name], diagnostics_);
    }

    Pipeline take() { return std::move(pipeline_); }

private:
    enum class Absence { faulty, disabled };

    void apply(const std::string& step_name, const std::string& name, const Node& value,
               const std::string& origin) {
        PipelineStep* step = find_step(step_name, value.place);
        if (!step) return;
        if (name == "mix" && !step->manifest->find_param(name)) {
            set_mix(*step, value);
            find_before(*step, std::size_t(step - pipeline_.steps.data()), value.place);
        } else {
            set_value(*step, name, value, value.place, origin, {});
        }
    }

    /// nullopt where the step has no manifest to be held against.
    std::optional<PipelineStep> bind(const LookStep& look_step) {
        if (look_step.effect.empty()) return std::nullopt;
        const std::string effect = effect_of(look_step);
        if (effect.empty()) return std::nullopt;
        if (!effects_.contains(effect)) {
            const auto ids = effects_.ids();
            diagnostics_.error(
                look_step.effect_place,
                "no effect '" + look_step.effect + "'" +
                    did_you_mean(look_step.effect, ids,
                                 "; " + spelled(Option::effect_path) + " names a folder of further effects"));
            return std::nullopt;
        }
        PipelineStep step;
        step.name = look_step.name;
        step_places_[step.name] = look_step.effect_place;
        step.manifest = effects_.find(effect, diagnostics_, look_step.space.value_or(IsfSpace::display));
        if (!step.manifest) return std::nullopt;
        if (look_step.space && !effects_.is_isf(effect))
            diagnostics_.error(look_step.space_place,
                               "'" + look_step.effect + "' is not an ISF file, which alone has a 'space'");
        step.is_foreign = !is_shipped(*step.manifest);
        apply_preset(look_step, step);
        for (const Member& member : look_step.params)
            set_value(step, member.key, member.value, member.key_place, "the look", look_step.folder);
        wire(look_step, step);
        if (look_step.mix) set_mix(step, *look_step.mix);
        if (look_step.mask) set_mask(step, *look_step.mask);
        if (look_step.mix || look_step.mask)
            find_before(step, pipeline_.steps.size(),
                        look_step.mix ? look_step.mix->place : look_step.mask->place);
        return step;
    }

    /// An id, or the path of an ISF file from here; "" after a fault.
    std::string effect_of(const LookStep& look_step) {
        if (!is_isf_path(look_step.effect)) return look_step.effect;
        const std::filesystem::path path = look_step.folder / look_step.effect;
        std::error_code failure;
        if (const std::string reason = FileRule::why_not(path); !reason.empty()) {
            diagnostics_.error(look_step.effect_place, "'" + look_step.effect + "' " + reason);
            return "";
        }
        if (std::filesystem::is_regular_file(path, failure)) return path.string();
        if (std::filesystem::exists(path, failure)) {
            const bool is_folder = std::filesystem::is_directory(path, failure);
            diagnostics_.error(look_step.effect_place, "'" + path.string() + "' is " +
                                                           (is_folder ? "a folder" : "a pipe or a device") +
                                                           ", but an ISF file is needed");
            return "";
        }
        std::vector<std::string> files;
        for (const auto& entry : std::filesystem::directory_iterator(path.parent_path(), failure))
            if (is_isf_path(entry.path()))
                files.push_back(
                    (std::filesystem::path(look_step.effect).parent_path() / entry.path().filename())
                        .string());
        diagnostics_.error(look_step.effect_place,
                           "no file '" + path.string() + "'" + did_you_mean(look_step.effect, files));
        return "";
    }

    void set_mix(PipelineStep& step, const Node& value) {
        if (auto parsed = parse_value_source(mix_spec(), value, step.name + ".mix", diagnostics_))
            step.mix = std::move(*parsed);
    }

    void set_mask(PipelineStep& step, const MaskSpec& mask) {
        const auto role = mask.role.empty() ? std::nullopt : find_role(mask.role);
        if (role &&
            (role->type != ComponentType::float32 || (role->channels != 1 && role->kind != RoleKind::other)))
            diagnostics_.error(mask.place, "a mask takes a role of one channel, such as mask or aov:hair; '" +
                                               mask.role + "' is none");
        if (!mask.file.empty()) check_file(mask.file, "", mask.place, true);
        step.mask = mask;
    }

    void check_file(const std::filesystem::path& file, const std::string& label, const Place& place,
                    bool is_data) {
        std::error_code failure;
        if (const std::string reason = FileRule::why_not(file); !reason.empty())
            diagnostics_.error(place, label + "'" + file.string() + "' " + reason);
        else if (!std::filesystem::is_regular_file(file, failure))
            diagnostics_.error(place, label + "no file '" + file.string() + "'");
        else if (const auto color = is_data ? read_png_color(file) : std::nullopt)
            if (const std::string note = color->note_of_data(); !note.empty())
                diagnostics_.warning(place, label + "'" + file.string() + "': " + note);
    }

    /// What each output of a step is mixed with: the input of its role, else the image of that role before
    /// the step, the `index`-th.
    void find_before(PipelineStep& step, std::size_t index, const Place& place) {
        for (const OutputSpec& output : step.manifest->outputs) {
            if (find_role(output.role)->type != ComponentType::float32) {
                diagnostics_.error(place, "step '" + step.name + "' makes " + output.role +
                                              ", whose values cannot be mixed");
                continue;
            }
            InputSource source = nearest_source(output.role, index);
            for (const InputSpec& input : step.manifest->inputs)
                if (input.role == output.role && input.frame == 0 && input.layer < 0 && !input.from_capture)
                    source = step.inputs.at(input.name);
            if (source.step < 0 && is_step_role(output.role)) source.output.clear();
            if (source.step < 0 && kind_of_role(output.role) == RoleKind::display)
                diagnostics_.error(
                    place,
                    "step '" + step.name + "' makes display, but no earlier step has made one to mix with");
            step.before[output.name] = source;
        }
    }

    PipelineStep* find_step(const std::string& name, const Place& place) {
        for (PipelineStep& step : pipeline_.steps)
            if (step.name == name) return &step;
        if (tell_of_absence(name, place)) return nullptr;
        const auto names = step_names(pipeline_);
        diagnostics_.error(place, "the look has no step '" + name + "'" + did_you_mean(name, names));
        return nullptr;
    }

    /// Whether the look has a step of that name which does not run; a faulty one has had its message.
    bool tell_of_absence(const std::string& name, const Place& place) {
        const auto absent = absent_.find(name);
        if (absent == absent_.end()) return false;
        if (absent->second == Absence::disabled)
            diagnostics_.error(place, "the step '" + name + "' is disabled; remove its \"enabled\": false");
        return true;
    }

    void warn_of_order(const LookStep& look_step, const PipelineStep& step) {
        for (const ModuleSpec& module : step.manifest->modules)
            for (int i = 0; i <= step.step_of_color(); ++i) {
                const PipelineStep& earlier = pipeline_.steps[std::size_t(i)];
                for (const ModuleSpec& other : earlier.manifest->modules)
                    if (std::ranges::find(module.before, other.name) != module.before.end())
                        diagnostics_.warning(look_step.place,
                                             "step '" + step.name + "' comes after '" + earlier.name +
                                                 "', but effects of the " + module.name +
                                                 " belong before those of the " + other.name +
                                                 ": move it before '" + earlier.name + "'");
            }
    }

    void apply_preset(const LookStep& look_step, PipelineStep& step) {
        if (!look_step.preset) return;
        const PresetSpec* preset = step.manifest->find_preset(*look_step.preset);
        if (preset) {
            for (const auto& [name, value] : preset->values) {
                step.values[name] = with_file(*step.manifest->find_param(name), value, step.manifest->folder);
                step.origins[name] = "preset " + preset->name;
                step.places[name] = look_step.preset_place;
            }
            return;
        }
        std::vector<std::string> names;
        for (const PresetSpec& known : step.manifest->presets) names.push_back(known.name);
        diagnostics_.error(look_step.preset_place, step.manifest->id + " has no preset '" +
                                                       *look_step.preset + "'" +
                                                       did_you_mean(*look_step.preset, names));
    }

    void set_value(PipelineStep& step, const std::string& name, const Node& value, const Place& key_place,
                   const std::string& origin, const std::filesystem::path& folder) {
        const ParamSpec* spec = step.manifest->find_param(name);
        if (!spec) {
            const auto names = step.manifest->param_names();
            diagnostics_.error(key_place, step.manifest->id + " has no parameter '" + name + "'" +
                                              did_you_mean(name, names));
            return;
        }
        auto parsed = parse_value_source(*spec, value, step.name + "." + name, diagnostics_);
        if (!parsed) return;
        const auto complete = [&](ParamValue& file) {
            file = with_file(*spec, std::move(file), folder);
            const auto& path = std::get<std::string>(file);
            if (!path.empty() && !is_config_address(path))
                check_file(path, step.name + "." + name + ": ", value.place, spec->file_is_data);
        };
        auto* literal = std::get_if<ParamValue>(&*parsed);
        if (is_file_type(spec->type) && literal) complete(*literal);
        if (auto* keyed = std::get_if<KeyedValue>(&*parsed); keyed && is_file_type(spec->type))
            for (auto& [frame, key] : keyed->keys) complete(std::get<ParamValue>(key.value));
        step.values[name] = std::move(*parsed);
        step.origins[name] = origin;
        step.places[name] = value.place;
    }

    void wire(const LookStep& look_step, PipelineStep& step) {
        for (const WiringSpec& wiring : look_step.wiring) wire_input(wiring, step);
        for (const InputSpec& input : step.manifest->inputs) {
            const bool of_capture = input.frame != 0 || input.from_capture || input.layer >= 0;
            const std::size_t end = is_step_role(input.role) ? end_of_color(step) : pipeline_.steps.size();
            // Light in front is a part of the color that its step makes, and of no later one.
            const bool is_part = input.role == kForegroundRole || input.role == kForegroundPlaceRole;
            const InputSource source =
                of_capture ? InputSource{-1, input.image_role()}
                           : nearest_source(input.role, end, is_part && end > 0 ? end - 1 : 0);
            step.inputs.try_emplace(input.name, source);
            // Who can do without colour does not build on it: it may look at it to the side of the display.
            if (input.role == kColorRole && !input.optional && pipeline_.writes_role(kDisplayRole))
                diagnostics_.error(
                    look_step.place,
                    "step '" + step.name + "' reads color after a step has made display; put it before");
        }
    }

    /// One past the step whose color it takes: what a later one says of its own light is not in that color.
    std::size_t end_of_color(const PipelineStep& step) const {
        for (const InputSpec& input : step.manifest->inputs) {
            if (input.role != kColorRole || input.layer >= 0 || input.frame != 0) continue;
            const auto wired = step.inputs.find(input.name);
            const int last = wired != step.inputs.end()
                                 ? wired->second.step
                                 : nearest_source(kColorRole, pipeline_.steps.size()).step;
            return std::size_t(last + 1);
        }
        return pipeline_.steps.size();
    }

    /// For the `index`-th step, from the steps from `first` on.
    InputSource nearest_source(const std::string& role, std::size_t index, std::size_t first = 0) const {
        for (int i = int(index) - 1; i >= int(first); --i)
            for (const OutputSpec& output : pipeline_.steps[std::size_t(i)].manifest->outputs)
                if (output.role == role) return {i, output.name};
        return {-1, role};
    }

    void wire_input(const WiringSpec& wiring, PipelineStep& step) {
        const InputSpec* input = step.manifest->find_input(wiring.input);
        if (!input) {
            std::vector<std::string> names;
            for (const InputSpec& known : step.manifest->inputs) names.push_back(known.name);
            diagnostics_.error(wiring.place, step.manifest->id + " has no input '" + wiring.input + "'" +
                                                 did_you_mean(wiring.input, names));
            return;
        }
        const EffectManifest* maker = nullptr;
        int index = -1;
        if (wiring.source != "capture") {
            const auto names = step_names(pipeline_);
            const auto found = std::find(names.begin(), names.end(), wiring.source);
            if (found == names.end()) {
                if (tell_of_absence(wiring.source, wiring.place)) return;
                diagnostics_.error(
                    wiring.place,
                    "no step '" + wiring.source + "' before '" + step.name + "'" +
                        did_you_mean(wiring.source, names, "; a step reads outputs of earlier steps only"));
                return;
            }
            index = int(found - names.begin());
            maker = pipeline_.steps[std::size_t(index)].manifest;
        }
        if (auto source = wired_source(wiring, *input, *step.manifest, maker, index, diagnostics_))
            step.inputs[input->name] = std::move(*source);
    }

    EffectRegistry& effects_;
    Diagnostics& diagnostics_;
    Pipeline pipeline_;
    std::map<std::string, Place> step_places_;
    std::map<std::string, Absence> absent_;  // steps of the look that are not in the pipeline
};

}  // namespace

Pipeline bind_pipeline(const Look& look, EffectRegistry& effects, const PipelineOptions& options,
                       Diagnostics& diagnostics) {
    LookBinder binder(effects, diagnostics);
    for (const LookStep& step : look.steps) binder.add(step);
    for (const std::string& text : options.sets) binder.apply_set(text);
    for (const ValueOverride& value : options.overrides) binder.apply_override(value);
    for (const std::string& text : options.taps) binder.add_tap(text);
    binder.check_relations_of_literals();
    if (!diagnostics.has_errors()) binder.check_colors();
    return binder.take();
}

}  // namespace aftershade
