// An effect on disk that a test can break in one place.
#pragma once

#include <map>
#include <string>

#include "framework/effect/manifest/manifest.h"
#include "framework/effect/manifest/manifest_reader.h"
#include "tests/documents.h"
#include "tests/temporary_folder.h"

namespace aftershade::test {

/// The sections of a manifest, one a line in this order, so that the section is the line of a fault.
enum Section { kHead = 1, kInputs, kOutputs, kParams, kTextures, kPasses, kPresets, kMore };

using Sections = std::map<int, std::string>;

/// A manifest without faults, but for the sections that are replaced.
inline std::string demo_manifest(const Sections& replaced = {}) {
    Sections sections = {
        {kHead, R"("aftershade": 1, "id": "demo", "version": "1.0.0", "summary": "A demo.")"},
        {kInputs, R"("inputs": {"color": {"role": "color"}, "depth": {"role": "depth", "optional": true}})"},
        {kOutputs, R"("outputs": {"color": {"role": "color"}})"},
        {kParams, R"("params": {
            "gain": {"type": "float", "unit": "m", "default": 1, "min": 0, "max": 9, "doc": "."},
            "mode": {"type": "enum", "values": ["fast", "good"], "default": "fast", "bind": "define",
                     "doc": "."},
            "flag": {"type": "bool", "default": false, "doc": "."},
            "taps": {"type": "int", "default": 3, "doc": "."}})"},
        {kTextures, R"("textures": {"small": {"format": "rgba16f", "scale": 0.5, "doc": "."}})"},
        {kPasses, R"("passes": [
            {"name": "one", "shader": "a.frag", "reads": ["color", "depth"], "writes": ["small"]},
            {"name": "two", "shader": "b.frag", "reads": [{"color": "linear"}, "small"],
             "writes": ["color"]}])"},
        {kPresets, R"("presets": {"strong": {"gain": "2 m", "mode": "good"}})"},
    };
    for (const auto& [section, text] : replaced) sections[section] = text;
    std::string text;
    for (auto& [section, part] : sections) {
        std::erase(part, '\n');
        text += (section == kHead ? "{" : ",\n") + part;
    }
    return text + "}\n";
}

/// A folder "demo" with effect.json and shader files.
class EffectFolder {
public:
    explicit EffectFolder(const std::string& manifest = demo_manifest()) {
        std::filesystem::create_directories(path());
        write("effect.json", manifest);
        for (const char* shader : {"a.frag", "b.frag", "c.comp", "d.vert"})
            write(shader, "#version 450 core\n#include <pass>\nvoid main() {}\n");
    }
    std::filesystem::path path() const { return folder_ / "demo"; }
    void write(const std::string& name, const std::string& text) const { write_text(path() / name, text); }

    std::optional<EffectManifest> manifest(Diagnostics& diagnostics) const {
        const auto node = read_document(path() / "effect.json", diagnostics);
        return node ? parse_manifest(*node, path(), diagnostics) : std::nullopt;
    }
    /// The test fails where the manifest has faults.
    EffectManifest sound_manifest() const {
        Diagnostics diagnostics;
        const auto read = manifest(diagnostics);
        EXPECT_EQ(lines_of(diagnostics), Lines{});
        return read.value_or(EffectManifest{});
    }

private:
    TemporaryFolder folder_;
};

/// The faults of a manifest as "line: error: message", without file and column.
inline Lines faults_of_manifest(const std::string& text) {
    const EffectFolder effect(text);
    Diagnostics diagnostics;
    const bool sound = effect.manifest(diagnostics).has_value();
    EXPECT_EQ(sound, !diagnostics.has_errors());
    Lines lines;
    for (const Diagnostic& fault : diagnostics.all()) {
        EXPECT_EQ(fault.place.file, (effect.path() / "effect.json").string());
        EXPECT_GT(fault.place.column, 0);
        lines.push_back(std::to_string(fault.place.line) + ": " + fault.message);
    }
    return lines;
}

}  // namespace aftershade::test
