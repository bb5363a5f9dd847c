#include "cli/ocio_names.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>

#include "framework/base/text.h"

namespace aftershade::cli {

std::optional<ColorNames> ocio_names(const EffectManifest& manifest, Diagnostics& diagnostics) {
    const auto takes_config = [](const ParamSpec& spec) {
        return is_ocio_file(spec) && spec.file_kind == FileKind::ocio_config;
    };
    if (std::ranges::none_of(manifest.params, takes_config)) return std::nullopt;
    auto read = color_names("");
    if (auto* names = std::get_if<ColorNames>(&read)) return std::move(*names);
    diagnostics.warning({"OpenColorIO"}, std::get<ColorFault>(read).text);
    return std::nullopt;
}

std::string ocio_names_text(const std::optional<ColorNames>& names) {
    if (!names) return "";
    std::string text = "\nNames in " + names->config + " (--ocio names another config):\n";
    for (const auto& [display, views] : names->views)
        text += "  display '" + display + "' has the views " + list_of_names(views, "and") + "\n";
    if (!names->looks.empty()) text += "  looks: " + list_of_names(names->looks, "and") + "\n";
    text += "  spaces: " + list_of_names(names->spaces, "and") + "\n";
    for (const auto& [role, space] : names->roles) text += "  role " + role + " is '" + space + "'\n";
    return printable_lines(text);
}

std::string with_ocio_names(const std::string& description, const std::optional<ColorNames>& names) {
    if (!names) return description;
    auto json = nlohmann::ordered_json::parse(description);
    auto& member = json["ocio"];
    member["config"] = names->config;
    for (const auto& [display, views] : names->views) member["displays"][display] = views;
    member["looks"] = names->looks;
    member["spaces"] = names->spaces;
    for (const auto& [role, space] : names->roles) member["roles"][role] = space;
    return json.dump(2);
}

}  // namespace aftershade::cli
