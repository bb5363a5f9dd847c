// When the frame graph of an effect is built again, for every effect there is: where something changes that
// its build looks at, and nowhere else.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "framework/render/renderer.h"
#include "framework/scattering/param_scattering.h"
#include "tests/every_effect.h"

namespace aftershade::test {
namespace {

/// Values in two frames with a gap between them, so that no history connects them.
using Changes = std::map<std::string, std::pair<ParamValue, ParamValue>>;
constexpr int kFirstFrame = 1, kSecondFrame = 9;

Pipeline pipeline_of(const EffectManifest& manifest, const Values& fixed, const Changes& changes) {
    PipelineStep step;
    step.name = manifest.id;
    step.manifest = &manifest;
    for (const InputSpec& input : manifest.inputs) step.inputs[input.name] = {-1, input.role};
    for (const auto& [name, value] : fixed) step.values[name] = value;
    for (const auto& [name, values] : changes)
        step.values[name] = KeyedValue{
            {{kFirstFrame, {values.first, {}}}, {kSecondFrame, {values.second, {}}}}, Ease{Ease::Kind::step}};
    for (const auto& [name, value] : step.values) step.origins[name] = "the test";
    Pipeline pipeline;
    pipeline.steps.push_back(std::move(step));
    return pipeline;
}

/// Parameters that choose passes, programs or sizes, as far as these are made.
std::vector<const ParamSpec*> form_params(const EffectManifest& manifest) {
    std::set<std::string> names;
    const auto add_grid = [&](const std::optional<GridSpec>& grid) {
        if (grid) names.insert(grid->tile.param);
    };
    for (const TextureSpec& texture : manifest.textures) add_grid(texture.grid);
    for (const BufferSpec& buffer : manifest.buffers) {
        add_grid(buffer.grid);
        names.insert(buffer.count.param);
    }
    const auto add_subjects = [&](const auto& uses) {
        for (const auto& use : uses)
            for (const WhenSpec& condition : use.when) names.insert(condition.subject);
    };
    add_subjects(manifest.passes);
    for (const PassSpec& pass : manifest.passes) {
        add_subjects(pass.reads);
        add_subjects(pass.writes);
        add_subjects(pass.images);
        if (pass.repeat) names.insert(pass.repeat->param);
        if (pass.compute()) names.insert(pass.compute()->dispatch.tile.param);
        if (!pass.draw() || !pass.draw()->instances) continue;
        names.insert(pass.draw()->instances->count.param);
        add_grid(pass.draw()->instances->grid);
    }
    std::vector<const ParamSpec*> specs;
    for (const ParamSpec& spec : manifest.params)
        if (spec.bind == ParamBind::define || names.contains(spec.name) || !spec.ocio.empty())
            specs.push_back(&spec);
    return specs;
}

/// A value near the default, so that no relation to another parameter breaks; of what objects look up, other
/// objects. Nothing for files.
std::optional<std::pair<ParamValue, ParamValue>> other_contents(const ParamSpec& spec) {
    const ParamValue& usual = spec.default_value;
    const auto nudged = [&](double value) {
        const bool up = !spec.max || value < *spec.max;
        return value + (up ? 1 : -1) * (spec.type == aftershade::ParamType::int_ ? 1 : 1e-3);
    };
    if (const auto* flag = std::get_if<bool>(&usual)) return std::pair<ParamValue, ParamValue>(*flag, !*flag);
    if (const auto* integer = std::get_if<std::int64_t>(&usual))
        return std::pair<ParamValue, ParamValue>(*integer, std::int64_t(nudged(double(*integer))));
    // From 0 or its identity to another number passes may come and go ("nonzero.", "changes.").
    if (const auto* number = std::get_if<double>(&usual)) {
        const double first = *number == 0 || spec.identity == usual ? nudged(*number) : *number;
        return std::pair<ParamValue, ParamValue>(first, nudged(first));
    }
    if (const auto* components = std::get_if<std::vector<double>>(&usual)) {
        std::vector<double> other;
        for (const double component : *components) other.push_back(nudged(component));
        return std::pair<ParamValue, ParamValue>(*components, other);
    }
    if (const auto* curve = std::get_if<CurveValue>(&usual)) {
        CurveValue other = *curve;
        other.interpolation = other.interpolation == CurveValue::Interpolation::linear
                                  ? CurveValue::Interpolation::smooth
                                  : CurveValue::Interpolation::linear;
        return std::pair<ParamValue, ParamValue>(*curve, other);
    }
    if (spec.type == aftershade::ParamType::enum_)
        return std::pair<ParamValue, ParamValue>(spec.values.front(), spec.values.back());
    const auto of_objects = [](auto first, const auto& row) {
        auto then = first;
        first.rows = {{TableKey{1, 1, ""}, row}};
        then.rows = {{TableKey{2, 5, ""}, row}};
        return std::pair(first, then);
    };
    if (const auto* table = std::get_if<TableValue>(&usual)) return of_objects(*table, table->default_row);
    const ScatteringValue* profiles = scattering_of(usual);
    if (!profiles) return std::nullopt;
    const auto [first, then] = of_objects(*profiles, profiles->usual);
    return std::pair<ParamValue, ParamValue>(OpaqueValue(std::make_shared<const ScatteringValue>(first)),
                                             OpaqueValue(std::make_shared<const ScatteringValue>(then)));
}

class EveryEffectsGraph : public EveryEffect {
protected:
    struct Rendered {
        int graphs = 0;
        FrameResult last;
    };
    Rendered render(const Pipeline& pipeline, const std::vector<int>& numbers) {
        PipelineRenderer renderer(context_, pipeline, kRoot);
        Rendered rendered;
        for (const int number : numbers) {
            Capture capture = with_aovs(small_capture()), before = with_aovs(capture_before());
            capture.header.frame = number;
            FrameInputs frame;
            frame.capture = &capture;
            frame.neighbours[-1] = &before;
            rendered.last = renderer.render(frame, {"color", "display", "irradiance", "velocity"}, false);
        }
        rendered.graphs = renderer.graphs_built();
        return rendered;
    }
    /// How many graphs two frames take. The second is what a graph of its own gives.
    int graphs_of(const Values& fixed, const Changes& changes) {
        const Pipeline pipeline = pipeline_of(manifest(), fixed, changes);
        const Rendered used = render(pipeline, {kFirstFrame, kSecondFrame});
        const Rendered fresh = render(pipeline, {kSecondFrame});
        EXPECT_EQ(used.last.images.size(), fresh.last.images.size());
        for (const auto& [role, image] : used.last.images)
            EXPECT_TRUE(same_bits(image, fresh.last.images.at(role))) << role;
        return used.graphs;
    }
    /// Whether some change of the parameter takes a second graph, at the defaults or with one other parameter
    /// at an extreme: conditions may keep a pass from running that would look at it.
    bool is_looked_at(const ParamSpec& spec) {
        std::vector<Values> settings{{}};
        for (const ParamSpec* other : form_params(manifest()))
            for (const ParamValue& value : extremes_of(*other))
                if (other != &spec && value != other->default_value)
                    settings.push_back({{other->name, value}});
        for (const Values& fixed : settings)
            for (const ParamValue& value : extremes_of(spec))
                if (value != spec.default_value &&
                    graphs_of(fixed, {{spec.name, {spec.default_value, value}}}) == 2)
                    return true;
        return false;
    }

    gpu::Context& context() { return context_; }

private:
    gpu::Context context_{backends().front()};
};

INSTANTIATE_TEST_SUITE_P(Effects, EveryEffectsGraph, testing::ValuesIn(registry().ids()),
                         [](const auto& effect) { return effect.param; });

TEST_P(EveryEffectsGraph, StaysWhereOnlyContentsChange) {
    const auto form = form_params(manifest());
    Changes changes;
    for (const ParamSpec& spec : manifest().params)
        if (std::find(form.begin(), form.end(), &spec) == form.end())
            if (const auto values = other_contents(spec)) changes[spec.name] = *values;
    EXPECT_EQ(graphs_of({}, changes), 1);
}

/// But for what OpenColorIO makes a transform of: its tests change the words and the files.
TEST_P(EveryEffectsGraph, IsBuiltAgainForEachDefineConditionAndCount) {
    for (const ParamSpec* spec : form_params(manifest())) {
        if (spec->ocio.empty()) {
            EXPECT_TRUE(is_looked_at(*spec)) << spec->name;
        }
    }
}

TEST_P(EveryEffectsGraph, IsBuiltAgainForEachOptionalInputThatComesOrGoes) {
    const Pipeline pipeline = pipeline_of(manifest(), {}, {});
    for (const InputSpec& input : manifest().inputs) {
        const auto is_required = [&](const InputSpec& other) {
            return !other.optional && other.role == input.role;
        };
        if (!input.optional || input.frame != 0 || !pipeline.steps.front().may_take(input) ||
            std::ranges::any_of(manifest().inputs, is_required))
            continue;
        PipelineRenderer renderer(context(), pipeline, kRoot);
        Capture with = with_aovs(small_capture());
        if (!with.images.contains(input.role)) continue;
        Capture without = with;
        remove_role(without, input.role);
        for (const Capture* capture : {&with, &without}) {
            FrameInputs frame;
            frame.capture = capture;
            renderer.render(frame, {"color"}, false);
        }
        EXPECT_EQ(renderer.graphs_built(), 2) << input.name;
    }
}

}  // namespace
}  // namespace aftershade::test
