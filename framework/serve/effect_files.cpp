#include "framework/serve/effect_files.h"

#include <algorithm>
#include <map>
#include <system_error>

#include <fmt/format.h>

#include "framework/base/atomic_file.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/document/document.h"
#include "framework/serve/http_message.h"

namespace aftershade::serve {

namespace fs = std::filesystem;

bool is_shader_name(const fs::path& name) {
    static const std::vector<std::string> kEndings = {".vert", ".frag", ".comp", ".glsl"};
    return std::ranges::find(kEndings, name.extension().string()) != kEndings.end();
}

std::vector<std::string> EffectFiles::names() const {
    std::vector<std::string> names;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (entry.symlink_status(failure).type() == fs::file_type::regular && is_shader_name(entry.path()))
            names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

std::string EffectFiles::read(const std::string& name) const {
    const auto all = names();
    if (std::ranges::find(all, name) == all.end())
        throw Refusal{404, "the effect's folder has no shader '" + name + "'"};
    std::string fault;
    std::string text = read_file_below(folder, name, kMaxDocumentBytes, fault);
    if (!fault.empty()) throw Refusal{409, (folder / name).string() + ": " + fault};
    return text;
}

void EffectFiles::write(const std::string& name, const std::string& before, const std::string& text) const {
    if (!why_not.empty()) throw Refusal{403, why_not};
    if (read(name) != before || !replace_text_file(path_below(folder, name), before, text))
        throw Refusal{409, (folder / name).string() + " was changed by another program; nothing was written"};
}

EffectFiles effect_files(const EffectRegistry& effects, const std::string& id, bool read_only) {
    const fs::path* folder = effects.folder(id);
    if (!folder) throw Refusal{404, "there is no effect '" + id + "'"};
    EffectFiles files{*folder, ""};
    std::error_code failure;
    if (read_only)
        files.why_not = "shaders are not written: the program runs with " + spelled(Option::read_only);
    else if (is_shipped(*folder))
        files.why_not = "'" + id +
                        "' comes with Aftershade and is not written; copy its folder, rename the effect "
                        "and serve with " +
                        spelled(Option::effect_path);
    else if (fs::is_symlink(*folder, failure))
        files.why_not = folder->string() + " is a link, and the folder behind a link is not written";
    return files;
}

std::string stamp_of_folders(const std::vector<fs::path>& folders) {
    std::map<std::string, std::string> states;
    std::error_code failure;
    const auto add_files = [&](const fs::path& folder) {
        for (const auto& file : fs::directory_iterator(folder, failure))
            if (file.is_regular_file(failure))
                states[file.path().string()] =
                    fmt::format("{} {}", file.last_write_time(failure).time_since_epoch().count(),
                                file.file_size(failure));
    };
    for (const fs::path& folder : folders)
        for (const auto& effect : fs::directory_iterator(folder, failure))
            if (effect.is_directory(failure)) add_files(effect.path());
            else if (is_isf_path(effect.path())) {
                add_files(folder);  // with their vertex shaders
                break;
            }
    std::string stamp;
    for (const auto& [path, state] : states) stamp += path + "\n" + state + "\n";
    return stamp;
}

}  // namespace aftershade::serve
