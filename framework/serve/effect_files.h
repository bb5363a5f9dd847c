// The shaders in an effect's own folder, as the page reads and writes them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "framework/effect/registry.h"

namespace aftershade::serve {

/// Whether a page may write a file of this name in an effect's folder.
bool is_shader_name(const std::filesystem::path& name);

/// An effect's folder; nothing outside it can be reached through this.
struct EffectFiles {
    std::filesystem::path folder;
    std::string why_not;  ///< it cannot be written; "" where it can

    /// Names of its .vert, .frag, .comp and .glsl files, sorted; a link is none of them.
    std::vector<std::string> names() const;
    // Each throws Refusal: 404 for a name that is not of names(), 409 where it cannot be read.
    std::string read(const std::string& name) const;
    /// Replaces the file, whole or not at all, if it still holds `before`. Throws Refusal 403 where it cannot
    /// be written, 409 where it holds something else, and Error(ErrorKind::output).
    void write(const std::string& name, const std::string& before, const std::string& text) const;
};

/// Throws Refusal 404 where there is no such effect.
EffectFiles effect_files(const EffectRegistry& effects, const std::string& id, bool read_only);

/// Another text whenever a file of one of these folders, or of their own folders, has another time or size.
std::string stamp_of_folders(const std::vector<std::filesystem::path>& folders);

}  // namespace aftershade::serve
