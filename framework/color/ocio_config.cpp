#include "framework/color/ocio_config.h"

#ifdef AFTERSHADE_HAS_OPENCOLORIO
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <sstream>
#include <string_view>

#include "framework/base/diagnostics.h"
#include "framework/color/color_request.h"
#include "framework/image/color_space.h"

namespace aftershade {

namespace fs = std::filesystem;

std::string_view builtin_ocio_config();

namespace {

/// `owner` has nothing of that name among `known`.
ColorFault unknown(const std::string& part, const std::string& owner, const std::string& what,
                   const std::string& word, const std::vector<std::string>& known) {
    const std::string all = known.empty() ? "" : "; it has " + list_of_names(known, "and");
    return {part, owner + " has no " + what + " '" + word + "'" + did_you_mean(word, known, all)};
}

/// The version that the config needs where OpenColorIO is older: that of its first line, or the first with
/// addresses.
std::string version_for(const OcioConfig& config) {
    const auto is_newer = [](int major, int minor) {
        return major * 0x1000000 + minor * 0x10000 > OCIO_VERSION_HEX;
    };
    if (config.name.find("ocio://") != std::string::npos) return is_newer(2, 2) ? "2.2" : "";
    std::ifstream file(config.file);
    for (std::string line; std::getline(file, line);) {
        int major = 0, minor = 0;
        if (std::sscanf(line.c_str(), " ocio_profile_version: %d.%d", &major, &minor) > 0)
            return is_newer(major, minor) ? std::to_string(major) + "." + std::to_string(minor) : "";
    }
    return "";
}

/// "+grade, -warm | neutral": the names.
std::vector<std::string> names_of_looks(const std::string& looks) {
    std::vector<std::string> names;
    std::istringstream list(looks);
    for (std::string name; std::getline(list, name, ',');)
        for (std::istringstream options(name); std::getline(options, name, '|');) {
            const std::size_t first = name.find_first_not_of(" +-"), last = name.find_last_not_of(' ');
            if (first != std::string::npos) names.push_back(name.substr(first, last + 1 - first));
        }
    return names;
}

/// Makes the transform of one request of a config, or collects the fault.
class ConfigTransform {
public:
    ConfigTransform(const OcioConfig& config, const ColorRequest& request)
        : config_(config), names_(names_of(config)), request_(request) {}

    /// Null after a fault.
    ocio::ConstProcessorRcPtr processor() {
        const ocio::GroupTransformRcPtr group = ocio::GroupTransform::Create();
        const std::string source = space("source");
        if (source.empty()) return nullptr;
        if (request_.word("source").empty()) group->appendTransform(between_rec709(kAp0FromRec709));
        if (request_.is_view()) {
            if (!append_view(*group, source)) return nullptr;
        } else {
            const std::string destination = space("destination");
            if (destination.empty()) return nullptr;
            const auto convert = ocio::ColorSpaceTransform::Create();
            convert->setSrc(source.c_str());
            convert->setDst(destination.c_str());
            group->appendTransform(convert);
            if (request_.word("destination").empty()) group->appendTransform(between_rec709(kRec709FromAp0));
        }
        return config_.config->getProcessor(
            group, request_.inverse ? ocio::TRANSFORM_DIR_INVERSE : ocio::TRANSFORM_DIR_FORWARD);
    }

    const ColorFault& fault() const { return fault_; }

private:
    enum Direction { kAp0FromRec709, kRec709FromAp0 };

    static ocio::MatrixTransformRcPtr between_rec709(Direction direction) {
        const Chromaticities ap0 = *color_space_primaries("ap0");
        const ColorMatrix rows =
            direction == kAp0FromRec709 ? conversion_matrix(kRec709, ap0) : conversion_matrix(ap0, kRec709);
        double matrix[16] = {};
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column)
                matrix[row * 4 + column] = rows[std::size_t(row * 3 + column)];
        matrix[15] = 1;
        const auto transform = ocio::MatrixTransform::Create();
        transform->setMatrix(matrix);
        return transform;
    }

    /// The space that a part names, or the one of AP0 for light; "" after a fault.
    std::string space(const std::string& part) {
        const std::string name = request_.word(part);
        if (!name.empty()) {
            if (config_.config->getColorSpace(name.c_str())) return name;
            std::vector<std::string> known = names_.spaces;
            for (const auto& [role, target] : names_.roles) known.push_back(role);
            fault_ = unknown(part, config_.name, "color space or role", name, known);
            return "";
        }
        if (std::string ap0 = ap0_space(*config_.config); !ap0.empty()) return ap0;
        fault_ = {part,
                  config_.name +
                      " has neither a role aces_interchange nor a space ACES2065-1, so it does not say where "
                      "the capture's light belongs: name its space as '" +
                      part + "'"};
        return "";
    }

    bool append_view(ocio::GroupTransform& group, const std::string& source) {
        std::string display = request_.word("display");
        if (display.empty() && !names_.views.empty()) display = names_.views.front().first;
        std::vector<std::string> displays;
        const std::vector<std::string>* views = nullptr;
        for (const auto& [name, its_views] : names_.views) {
            displays.push_back(name);
            if (name == display) views = &its_views;
        }
        if (!views || views->empty()) {
            fault_ = unknown("display", config_.name, "display", display, displays);
            return false;
        }
        std::string view = request_.word("view");
        if (view.empty()) view = config_.config->getDefaultView(display.c_str());
        if (std::ranges::find(*views, view) == views->end()) {
            fault_ =
                unknown("view", "the display '" + display + "' of " + config_.name, "view", view, *views);
            return false;
        }
        const auto transform = ocio::DisplayViewTransform::Create();
        transform->setSrc(source.c_str());
        transform->setDisplay(display.c_str());
        transform->setView(view.c_str());
        if (request_.word("looks").empty()) group.appendTransform(transform);
        else return append_with_looks(group, transform);
        return true;
    }

    bool append_with_looks(ocio::GroupTransform& group, const ocio::DisplayViewTransformRcPtr& view) {
        for (const std::string& name : names_of_looks(request_.word("looks")))
            if (std::ranges::find(names_.looks, name) == names_.looks.end()) {
                fault_ = unknown("looks", config_.name, "look", name, names_.looks);
                return false;
            }
        const auto pipeline = ocio::LegacyViewingPipeline::Create();
        pipeline->setDisplayViewTransform(view);
        pipeline->setLooksOverrideEnabled(true);
        pipeline->setLooksOverride(request_.word("looks").c_str());
        group.appendTransform(pipeline->getProcessor(config_.config)->createGroupTransform());
        return true;
    }

    const OcioConfig& config_;
    ColorNames names_;
    const ColorRequest& request_;
    ColorFault fault_;
};

}  // namespace

std::string ap0_space(const ocio::Config& config) {
    for (const char* ap0 : {"aces_interchange", "ACES2065-1", "ACES - ACES2065-1", "lin_ap0"})
        if (config.getColorSpace(ap0)) return ap0;
    return "";
}

std::string one_line(const std::string& text) {
    std::istringstream words(text);
    std::string line, word;
    while (words >> word) line += (line.empty() ? "" : " ") + word;
    return line;
}

ColorFault fault_of_config(const OcioConfig& config, const ocio::Exception& error) {
    const std::string version = version_for(config);
    return {"", config.name + " cannot be used: " + one_line(error.what()) + " (OpenColorIO " +
                    ocio::GetVersion() +
                    (version.empty() ? ")"
                                     : " is too old for this config, which needs " + version +
                                           "; bake its views with `scripts/make ocio-bake CONFIG FOLDER`)")};
}

std::variant<OcioConfig, ColorFault> open_config(std::string path) {
    static std::once_flag quiet;
    std::call_once(quiet, [] { ocio::SetLoggingLevel(ocio::LOGGING_LEVEL_NONE); });
    const char* const variable = std::getenv(kConfigVariable);
    const bool is_of_variable = path.empty() && variable && *variable;
    if (is_of_variable) path = variable;
    OcioConfig config{nullptr, path.empty() ? "the built-in config" : "the config '" + path + "'", {}};
    if (is_of_variable && !std::getenv(kConfigIsOfOption)) config.name += " of $OCIO";
    const bool is_file = !path.empty() && !is_config_address(path);
    if (std::error_code failure; is_file && !fs::is_regular_file(path, failure))
        return ColorFault{"", config.name + " does not exist, or is not a file"};
    if (is_file) config.file = path;
    try {
        if (path.empty()) {
            std::istringstream text{std::string(builtin_ocio_config())};
            config.config = ocio::Config::CreateFromStream(text);
        } else {
            config.config = ocio::Config::CreateFromFile(path.c_str());
        }
        config.config->validate();
    } catch (const ocio::Exception& error) {
        return fault_of_config(config, error);
    }
    return config;
}

ColorNames names_of(const OcioConfig& open) {
    const ocio::Config& config = *open.config;
    ColorNames names{open.name, {}, {}, {}, {}};
    const auto add_display = [&](const std::string& display) {
        std::vector<std::string> views;
        for (int i = 0; i < config.getNumViews(display.c_str()); ++i)
            views.emplace_back(config.getView(display.c_str(), i));
        names.views.emplace_back(display, std::move(views));
    };
    const std::string usual = config.getDefaultDisplay();
    if (!usual.empty()) add_display(usual);
    for (int i = 0; i < config.getNumDisplays(); ++i)
        if (config.getDisplay(i) != usual) add_display(config.getDisplay(i));
    for (int i = 0; i < config.getNumLooks(); ++i) names.looks.emplace_back(config.getLookNameByIndex(i));
    for (int i = 0; i < config.getNumColorSpaces(); ++i)
        names.spaces.emplace_back(config.getColorSpaceNameByIndex(i));
    for (int i = 0; i < config.getNumRoles(); ++i) {
        const std::string role = config.getRoleName(i);
        names.roles.emplace_back(role, config.getColorSpace(role.c_str())->getName());
    }
    return names;
}

std::variant<ocio::ConstProcessorRcPtr, ColorFault> processor_of(const OcioConfig& config,
                                                                 const ColorRequest& request) {
    ConfigTransform maker(config, request);
    if (auto processor = maker.processor()) return processor;
    return maker.fault();
}

fs::path escaped_file(const OcioConfig& config, const std::vector<fs::path>& files) {
    const fs::path home = fs::absolute(config.file.empty() ? "." : config.file).parent_path();
    std::vector<fs::path> folders{home};
    for (int i = 0; i < config.config->getNumSearchPaths(); ++i)
        folders.push_back(
            home / config.config->getCurrentContext()->resolveStringVar(config.config->getSearchPath(i)));
    for (const fs::path& file : files) {
        const auto holds = [&](const fs::path& folder) {
            const fs::path inside = fs::absolute(file).lexically_normal().lexically_relative(
                fs::absolute(folder).lexically_normal());
            return !inside.empty() && *inside.begin() != "..";
        };
        if (std::ranges::none_of(folders, holds)) return file;
    }
    return {};
}

}  // namespace aftershade
#endif
