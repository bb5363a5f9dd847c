// The text of a pass of an effect on disk.
#pragma once

#include "framework/effect/shader_source.h"
#include "tests/effect/effect_folder.h"

namespace aftershade::test {

inline Lines lines_of_text(const std::string& text) {
    std::istringstream in(text);
    Lines lines;
    for (std::string line; std::getline(in, line);) lines.push_back(line);
    return lines;
}

inline bool has_line(const ShaderSource& source, const std::string& line) {
    return source.text.find("\n" + line + "\n") != std::string::npos;
}

/// A pass of an effect with the values that a look might give.
struct Assembly {
    explicit Assembly(const EffectFolder& effect, std::size_t pass = 0)
        : folder(effect), manifest(effect.sound_manifest()), pass_index(pass) {
        for (const ParamSpec& spec : manifest.params) params.set(spec.name, spec.default_value);
    }
    ShaderSource operator()(Diagnostics& diagnostics) const {
        return assemble_shader({&manifest, &manifest.passes.at(pass_index), params, present, glsl.path()},
                               diagnostics);
    }
    ShaderSource sound() const {
        Diagnostics diagnostics;
        ShaderSource source = (*this)(diagnostics);
        EXPECT_EQ(lines_of(diagnostics), Lines{});
        return source;
    }
    /// As "file:line:column: error: message", without the effect's folder.
    Lines faults() const {
        Diagnostics diagnostics;
        (*this)(diagnostics);
        Lines lines = lines_of(diagnostics);
        for (std::string& line : lines)
            if (line.starts_with(folder.path().string()))
                line = line.substr(folder.path().string().size() + 1);
        return lines;
    }

    const EffectFolder& folder;
    EffectManifest manifest;
    std::size_t pass_index;
    ParamSet params;
    std::vector<std::string> present;
    TemporaryFolder glsl;
};

}  // namespace aftershade::test
