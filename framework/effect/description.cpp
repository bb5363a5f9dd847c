#include "framework/effect/description.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "framework/base/option.h"
#include "framework/document/param_type.h"
#include "framework/document/units.h"
#include "framework/effect/manifest/manifest_when.h"

namespace aftershade {

namespace {

/// A table whose columns are as wide as their widest cell.
class TextTable {
public:
    explicit TextTable(std::string indent) : indent_(std::move(indent)) {}
    void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
    void print(std::ostream& out) const {
        std::vector<std::size_t> widths;
        for (const auto& row : rows_) {
            widths.resize(std::max(widths.size(), row.size()));
            for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
        }
        for (const auto& row : rows_) {
            std::string line = indent_;
            for (std::size_t i = 0; i < row.size(); ++i) {
                line += row[i];
                if (i + 1 < row.size()) line += std::string(widths[i] - row[i].size() + 2, ' ');
            }
            line.erase(line.find_last_not_of(' ') + 1);
            out << line << "\n";
        }
    }

private:
    std::string indent_;
    std::vector<std::vector<std::string>> rows_;
};

std::string input_flags(const InputSpec& input) {
    std::string flags = input.optional ? ", optional" : "";
    if (input.history) flags += ", with the frame before";
    if (input.layer >= 0) flags += ", of layer " + std::to_string(input.layer);
    if (input.from_capture) flags += ", the capture's own";
    if (!input.instead.empty()) flags += " if there is " + input.instead;
    if (input.frame == -1) flags += ", of the frame before";
    if (input.frame == 1) flags += ", of the next frame";
    if (std::abs(input.frame) > 1)
        flags += ", of " + std::to_string(std::abs(input.frame)) +
                 (input.frame < 0 ? " frames before" : " frames after");
    return flags;
}

/// "estimate.a where history.a, 8 bins from 0 to 64".
std::string telemetry_text(const TelemetrySpec& spec) {
    std::string text = spec.of.text() + (spec.squared ? " squared" : "");
    if (spec.where) text += " where " + spec.where->text();
    if (spec.bins > 0)
        text += ", " + std::to_string(spec.bins) + " bins from " + format_number(spec.from) + " to " +
                format_number(spec.to);
    return text;
}

/// "hybrid auto or separable, the input velocity": what must hold.
std::string conditions_text(const std::vector<WhenSpec>& conditions) {
    std::string text;
    for (const WhenSpec& condition : conditions) {
        std::string values;
        for (const ParamValue& value : condition.values) {
            const auto* name = std::get_if<std::string>(&value);
            values += (values.empty() ? "" : " or ") + (name ? *name : format_value(value));
        }
        std::string what = condition.subject + " " + values;
        if (condition.subject.starts_with(kHasInput) && condition.values.size() == 1)
            what = (values == "true" ? "the input " : "no input ") + name_in_condition(condition.subject);
        if (condition.subject.starts_with(kNonzero) && condition.values.size() == 1)
            what = name_in_condition(condition.subject) + (values == "true" ? " not 0" : " 0");
        if (condition.subject.starts_with(kChanges) && condition.values.size() == 1)
            what = name_in_condition(condition.subject) + (values == "true" ? " not " : " ") +
                   format_value(*condition.identity);
        text += (text.empty() ? "" : ", ") + what;
    }
    return text;
}

std::string texture_text(const TextureSpec& texture) {
    std::string text{gpu::texture_format_name(texture.format)};
    const GridSpec& grid = texture.grid;
    const std::string tile = grid.tile.param.empty() ? std::to_string(grid.tile.number) : grid.tile.param;
    if (grid.kind == GridSpec::Kind::tile) text += ", one texel per " + tile + " px";
    if (grid.kind == GridSpec::Kind::size)
        for (const int axis : {0, 1})
            text += (axis == 0 ? ", " : " x ") +
                    (grid.formula[axis].empty() ? std::to_string(grid.size[axis]) : grid.formula[axis]);
    if (grid.kind == GridSpec::Kind::scale && grid.scale != 1) text += ", scale " + format_number(grid.scale);
    if (grid.room[0] > 0) text += ", room of " + format_number(grid.room[0]) + " to its right";
    if (grid.room[1] > 0) text += ", room of " + format_number(grid.room[1]) + " below";
    if (texture.layers > 1) text += ", " + std::to_string(texture.layers) + " layers, no tap";
    if (texture.auto_mips) text += ", mips";
    else if (texture.mips > 1) text += ", " + std::to_string(texture.mips) + " levels";
    if (texture.history) text += ", history";
    if (!texture.when.empty()) text += ", with " + conditions_text(texture.when);
    return text;
}

/// "color, [kept.prev] -> near, list over near_tiles": what a pass takes and makes, in brackets what is not
/// always there, and the tiles to which it is confined.
std::string flow_text(const EffectManifest& manifest, const PassSpec& pass) {
    std::string reads, writes;
    const auto add = [](std::string& list, std::string name, bool has_conditions) {
        list += (list.empty() ? "" : ", ") + (has_conditions ? "[" + name + "]" : name);
    };
    const auto label = [](const auto& use) { return use.name + (use.previous ? ".prev" : ""); };
    for (const ReadSpec& read : pass.reads) add(reads, label(read), !read.when.empty());
    for (const WriteSpec& write : pass.writes) add(writes, write.name, !write.when.empty());
    if (pass.lists()) return reads + " ->";
    const TileListSpec* over = manifest.tile_list_of(pass);
    for (const auto* list : {&pass.images, &pass.buffers})
        for (const AccessSpec& access : *list) {
            if (over && access.name == over->runs()) continue;
            if (access.kind != AccessSpec::Kind::write) add(reads, label(access), !access.when.empty());
            if (access.kind != AccessSpec::Kind::read) add(writes, access.name, !access.when.empty());
        }
    return (reads.empty() ? "" : reads + " ") + "-> " + writes + (over ? " over " + over->name : "");
}

/// "blur.frag", "lens/coc.frag" of a module, "tiles where near.r > 0" of the host.
std::string shader_text(const EffectManifest& manifest, const PassSpec& pass) {
    const TileListSpec* listed = pass.lists() ? manifest.tile_list_of(pass) : nullptr;
    if (listed && listed->of) return "tiles where " + listed->of->text() + " > 0";
    if (listed) return "tiles by " + (pass.module.empty() ? "" : pass.module + "/") + pass.shader;
    if (pass.copies()) return "copy";
    if (pass.clear()) return "clear";
    return (pass.module.empty() ? "" : pass.module + "/") + pass.shader;
}

/// A cell of a Markdown table.
std::string cell(std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string preset_text(const EffectManifest& manifest, const PresetSpec& preset) {
    std::string text;
    for (const auto& [name, value] : preset.values) {
        const ParamSpec& spec = *manifest.find_param(name);
        text += (text.empty() ? "" : ", ") + name + " " + format_value(spec, value) +
                (spec.unit.empty() ? "" : " " + spec.unit);
    }
    return text.empty() ? "the defaults" : text;
}

struct ParamSection {
    std::string title;  ///< "" of the first
    std::vector<const ParamSpec*> params;
};

/// As the page shows them: without a section first, then by section, and the advanced ones last.
std::vector<ParamSection> sections_of(const EffectManifest& manifest) {
    std::vector<ParamSection> sections(1);
    ParamSection advanced{"Advanced", {}};
    for (const ParamSpec& spec : manifest.params) {
        auto found = std::ranges::find(sections, spec.section, &ParamSection::title);
        if (!spec.is_advanced && found == sections.end()) found = sections.insert(found, {spec.section, {}});
        (spec.is_advanced ? advanced : *found).params.push_back(&spec);
    }
    sections.push_back(std::move(advanced));
    std::erase_if(sections, [](const ParamSection& section) { return section.params.empty(); });
    return sections;
}

void markdown_params(const EffectManifest& manifest, std::ostream& out) {
    if (manifest.params.empty()) return;
    out << "\n## Parameters\n";
    for (const ParamSection& section : sections_of(manifest)) {
        out << (section.title.empty() ? "" : "\n**" + section.title + "**\n")
            << "\n| name | type | default | range | |\n|---|---|---|---|---|\n";
        for (const ParamSpec* spec : section.params) {
            out << "| `" << spec->name << "` | " << cell(type_text(*spec)) << " | "
                << cell(default_text(*spec)) << " | " << range_text(*spec) << " | " << cell(spec->doc)
                << " |\n";
            for (const ParamSpec& column : spec->columns)
                out << "| `" << spec->name << "` &rarr; `" << column.name << "` | " << cell(type_text(column))
                    << " | " << cell(default_text(column)) << " | " << range_text(column) << " | "
                    << cell(column.doc) << " |\n";
        }
    }
}

/// How it is made.
void describe_inside(const EffectManifest& manifest, std::ostream& out) {
    if (!manifest.sources.empty() || !manifest.modules.empty()) out << "\nsources\n";
    for (const std::string& source : manifest.sources) out << "  " << source << "\n";
    for (const ModuleSpec& module : manifest.modules)
        out << "  module " << module.name << ": " << module.summary << "\n";
    if (!manifest.textures.empty())
        out << "\ntextures (" << spelled(Option::tap) << " " << manifest.id << ".<name>)\n";
    TextTable textures("  ");
    for (const TextureSpec& texture : manifest.textures)
        textures.add({texture.name, texture_text(texture), texture.doc});
    textures.print(out);
    if (!manifest.telemetry.empty())
        out << "\ntelemetry (" << spelled(Option::telemetry, "FILE.json") << ")\n";
    TextTable telemetry("  ");
    for (const TelemetrySpec& spec : manifest.telemetry)
        telemetry.add({spec.name, telemetry_text(spec), spec.doc});
    telemetry.print(out);
    out << "\npasses\n";
    TextTable passes("  ");
    for (const PassSpec& pass : manifest.passes)
        passes.add({pass.name, shader_text(manifest, pass), flow_text(manifest, pass)});
    passes.print(out);
}

}  // namespace

std::string type_text(const ParamSpec& spec) {
    return spec.type->type_text(spec) + (spec.unit.empty() ? "" : ", " + spec.unit);
}

std::string default_text(const ParamSpec& spec) {
    return (spec.from.empty() ? "" : spec.from + ", else ") + spec.type->default_text(spec) +
           (spec.unit.empty() ? "" : " " + spec.unit);
}

std::string describe_text(const EffectManifest& manifest, bool verbose) {
    std::ostringstream out;
    out << manifest.id << " " << manifest.version << "\n" << manifest.summary << "\n";
    if (!manifest.group.empty())
        out << "group: " << manifest.group << (manifest.is_recommended ? ", recommended" : "") << "\n";
    for (const ParamSection& section : sections_of(manifest)) {
        out << "\nparameters" << (section.title.empty() ? "" : ": " + section.title) << "\n";
        TextTable params("  ");
        for (const ParamSpec* spec : section.params) {
            params.add({spec->name, type_text(*spec), default_text(*spec), range_text(*spec), spec->doc});
            for (const ParamSpec& column : spec->columns)
                params.add({"  " + column.name, type_text(column), default_text(column), range_text(column),
                            column.doc});
        }
        params.print(out);
    }
    if (!manifest.presets.empty()) out << "\npresets\n";
    TextTable presets("  ");
    for (const PresetSpec& preset : manifest.presets)
        presets.add({preset.name, preset_text(manifest, preset)});
    presets.print(out);
    out << "\ninputs\n";
    TextTable inputs("  ");
    for (const InputSpec& input : manifest.inputs)
        inputs.add({input.name, input.role + input_flags(input), input.doc});
    inputs.print(out);
    if (manifest.uses_lights) out << "  the capture's lights\n";
    out << "\noutputs\n";
    TextTable outputs("  ");
    for (const OutputSpec& output : manifest.outputs) outputs.add({output.name, output.role, output.doc});
    outputs.print(out);
    if (verbose) describe_inside(manifest, out);
    else out << "\n" << spelled(Option::verbose) << " adds its sources, textures, telemetry and passes.\n";
    return out.str();
}

std::string describe_markdown(const EffectManifest& manifest) {
    std::ostringstream out;
    out << "<!-- Made by `aftershade docs` from effects/" << manifest.id << "/effect.json; do not edit. -->\n"
        << "# " << manifest.id << "\n\n"
        << manifest.summary << " Version " << manifest.version << ".\n";
    for (const ModuleSpec& module : manifest.modules)
        out << "\nTakes the module `" << module.name << "` (glsl/" << module.name << "): " << module.summary
            << "\n";
    if (manifest.uses_lights) out << "\nTakes the capture's [lights](../captures.md).\n";
    out << "\n## Images\n\n| | name | role | |\n|---|---|---|---|\n";
    for (const InputSpec& input : manifest.inputs)
        out << "| in | `" << input.name << "` | " << input.role << input_flags(input) << " | "
            << cell(input.doc) << " |\n";
    for (const OutputSpec& output : manifest.outputs)
        out << "| out | `" << output.name << "` | " << output.role << " | " << cell(output.doc) << " |\n";
    markdown_params(manifest, out);
    if (!manifest.presets.empty()) out << "\n## Presets\n\n| name | values |\n|---|---|\n";
    for (const PresetSpec& preset : manifest.presets)
        out << "| `" << preset.name << "` | " << cell(preset_text(manifest, preset)) << " |\n";
    if (!manifest.textures.empty())
        out << "\n## Textures\n\nWritten out by `" << spelled(Option::tap) << " " << manifest.id
            << ".<name>`.\n\n| name | format | |\n|---|---|---|\n";
    for (const TextureSpec& texture : manifest.textures)
        out << "| `" << texture.name << "` | " << texture_text(texture) << " | " << cell(texture.doc)
            << " |\n";
    if (!manifest.telemetry.empty())
        out << "\n## Telemetry\n\nNumbers of each frame, written by `"
            << spelled(Option::telemetry, "FILE.json") << "`.\n\n| name | of | |\n|---|---|---|\n";
    for (const TelemetrySpec& spec : manifest.telemetry)
        out << "| `" << spec.name << "` | " << telemetry_text(spec) << " | " << cell(spec.doc) << " |\n";
    if (!manifest.sources.empty()) out << "\n## Sources\n\n";
    for (const std::string& source : manifest.sources) out << "- " << source << "\n";
    return out.str();
}

std::vector<const EffectManifest*> in_groups(std::vector<const EffectManifest*> manifests) {
    const std::vector<std::string>& groups = effect_groups();
    std::ranges::stable_sort(manifests, {}, [&](const EffectManifest* manifest) {
        return std::pair(std::ranges::find(groups, manifest->group) - groups.begin(),
                         !manifest->is_recommended);
    });
    return manifests;
}

namespace {

/// "color" as a heading of a page, which is British.
std::string title(const std::string& group) {
    static const std::map<std::string, std::string> british = {{"color", "Colour"}};
    const auto found = british.find(group);
    return found != british.end() ? found->second
                                  : std::string(1, char(std::toupper(group.front()))) + group.substr(1);
}

}  // namespace

std::string index_markdown(const std::vector<const EffectManifest*>& manifests) {
    std::ostringstream out;
    out << "<!-- Made by `aftershade docs`; do not edit. -->\n# Effects\n\nIn groups, the effect that most "
           "looks need first.\n";
    const auto roles = [](const auto& list) {
        std::string text;
        std::set<std::string> named;  // a neighbouring frame's role is its own again
        for (const auto& item : list)
            if (named.insert(item.role).second) text += (text.empty() ? "" : ", ") + item.role;
        return text;
    };
    const std::string* group = nullptr;
    for (const EffectManifest* manifest : in_groups(manifests)) {
        if (!group || *group != manifest->group)
            out << "\n## " << (manifest->group.empty() ? "Others" : title(manifest->group))
                << "\n\n| effect | from | to | |\n|---|---|---|---|\n";
        group = &manifest->group;
        out << "| [`" << manifest->id << "`](" << manifest->id << ".md)"
            << (manifest->is_recommended ? ", recommended" : "") << " | " << roles(manifest->inputs) << " | "
            << roles(manifest->outputs) << " | " << cell(manifest->summary) << " |\n";
    }
    return out.str();
}

}  // namespace aftershade
