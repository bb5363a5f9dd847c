#include "cli/inspect_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "framework/base/text.h"
#include "framework/image/role.h"
#include "framework/image/square_pixels.h"

namespace aftershade::cli {

namespace {

using Json = nlohmann::ordered_json;

std::string window_text(const Window& window) {
    return fmt::format("({}, {})-({}, {}), {} x {} px", window.min_x, window.min_y, window.max_x,
                       window.max_y, window.width(), window.height());
}

std::string part_title(const InspectedPart& part, std::size_t index) {
    const ExrPart& header = part.header;
    std::string title = fmt::format("part {}", index);
    if (!header.name.empty()) title += fmt::format(" '{}'", printable(header.name));
    if (!header.view.empty()) title += fmt::format(", view '{}'", printable(header.view));
    title += fmt::format(": {}, {}\n", header.type, header.compression);
    title += fmt::format("  data window     {}\n", window_text(header.data_window));
    title += fmt::format("  display window  {}\n", window_text(header.display_window));
    return title + fmt::format("  pixel aspect    {}\n", header.pixel_aspect);
}

/// "scanlineimage, zip, 480 x 270 px", with what is out of the ordinary.
std::string layout_text(const ExrPart& part) {
    std::string text = fmt::format("{}, {}, ", part.type, part.compression);
    if (part.data_window == part.display_window && part.data_window.min_x == 0 && part.data_window.min_y == 0)
        text += fmt::format("{} x {} px", part.data_window.width(), part.data_window.height());
    else
        text += fmt::format("data window {}, display window {}", window_text(part.data_window),
                            window_text(part.display_window));
    if (part.pixel_aspect == 1) return text;
    const Window square =
        stretched(part.display_window, part.display_window, square_pixels(part.pixel_aspect));
    return text + fmt::format(", pixel aspect {} ({} x {} square px)", part.pixel_aspect, square.width(),
                              square.height());
}

/// One line for parts of one layout; what cannot be read by name.
std::string part_lines(const std::vector<InspectedPart>& parts) {
    struct Like {
        std::string layout;
        std::size_t parts = 0, channels = 0;
    };
    std::vector<Like> likes;
    std::string faults;
    for (const InspectedPart& part : parts) {
        const std::string layout = layout_text(part.header);
        auto like = std::ranges::find(likes, layout, &Like::layout);
        if (like == likes.end()) like = likes.insert(like, {layout});
        ++like->parts, like->channels += part.channels.size();
        for (const InspectedChannel& channel : part.channels)
            if (!channel.statistics)
                faults +=
                    fmt::format("  {}: {}\n", printable(channel.channel.name), printable(channel.reason));
    }
    std::string text;
    for (const Like& like : likes)
        text += fmt::format("{} part{}: {}; {} channels (--channels lists them)\n", like.parts,
                            like.parts == 1 ? "" : "s", like.layout, like.channels);
    return text + faults;
}

std::string number_text(const std::optional<double>& value) {
    return value ? fmt::format("{:.6g}", *value) : "-";
}

std::string channel_table(const std::vector<InspectedChannel>& channels) {
    std::size_t width = 7;
    for (const InspectedChannel& channel : channels) width = std::max(width, channel.channel.name.size());
    std::string table =
        fmt::format("  {:<{}}  {:<5}  {:<8}  {:>12}  {:>12}  {:>9}  {:>9}  {:>9}\n", "channel", width, "type",
                    "sampling", "min", "max", "NaN", "Inf", "negative");
    for (const InspectedChannel& row : channels) {
        const ExrChannel& channel = row.channel;
        table += fmt::format("  {:<{}}  {:<5}  {:<8}", printable(channel.name), width,
                             pixel_type_name(channel.type),
                             fmt::format("{} x {}", channel.x_sampling, channel.y_sampling));
        if (row.statistics)
            table += fmt::format("  {:>12}  {:>12}  {:>9}  {:>9}  {:>9}\n", number_text(row.statistics->min),
                                 number_text(row.statistics->max), row.statistics->nan,
                                 row.statistics->infinite, row.statistics->negative);
        else table += fmt::format("  {}\n", printable(row.reason));
    }
    return table;
}

std::string sample_lines(const InspectedPart& part) {
    std::string text;
    for (const SampleCount& count : part.sample_counts) {
        const std::string samples = count.least == count.most
                                        ? std::to_string(count.least)
                                        : fmt::format("{} to {}", count.least, count.most);
        const Window& window = part.header.data_window;
        text += fmt::format("  {:>14}  {:>12} px  {:>6.2f} %\n", samples, count.pixels,
                            100 * double(count.pixels) / (double(window.width()) * window.height()));
    }
    return text.empty() ? "" : "  samples in a pixel\n" + text;
}

std::string pixel_lines(const Inspection& inspection, const InspectedPart& part) {
    if (!inspection.pixel) return "";
    const auto [x, y] = *inspection.pixel;
    std::string text = fmt::format("  pixel ({}, {})\n", x, y);
    if (part.at_pixel.channels.empty()) return text + "    outside of the data window\n";
    if (part.at_pixel.samples.empty()) return text + "    no samples\n";
    for (std::size_t c = 0; c < part.at_pixel.channels.size(); ++c) {
        text += fmt::format("    {:<12}", printable(part.at_pixel.channels[c]));
        for (const std::vector<double>& sample : part.at_pixel.samples)
            text += fmt::format("  {:>10.6g}", sample[c]);
        text += "\n";
    }
    return text;
}

std::vector<std::string> channels_of(const CaptureHeader& capture, const std::string& role) {
    const auto found = capture.role_channels.find(role);
    return found == capture.role_channels.end() ? std::vector<std::string>{} : found->second;
}

std::string role_lines(const Inspection& inspection) {
    std::string text = "roles:\n";
    if (inspection.capture)
        for (const std::string& role : inspection.capture->roles)
            text += fmt::format(
                "  {:<14}  {}\n", role,
                printable(fmt::format("{}", fmt::join(channels_of(*inspection.capture, role), " "))));
    if (!inspection.depth_kind.empty())
        text += fmt::format("  {:<14}  {}\n", "(depth)", inspection.depth_kind);
    text += fmt::format("  {:<14}  {}\n", "(missing)", fmt::join(inspection.missing_roles(), ", "));
    for (const auto& [role, remedy] : inspection.remedies())
        text += fmt::format("    {}: {}\n", role, printable(remedy));
    return text;
}

std::string layer_lines(const CaptureHeader& capture) {
    std::string text = fmt::format("color space: {}\n", printable(capture.stored_colors.text()));
    if (!capture.layer.empty()) text += fmt::format("layer: {}\n", printable(capture.layer));
    if (capture.layer_count > 1) text += fmt::format("layers, front to back: {}\n", capture.layer_count);
    for (const std::string& warning : capture.warnings)
        text += fmt::format("warning: {}\n", printable(warning));
    for (const std::string& note : capture.notes) text += fmt::format("note: {}\n", printable(note));
    return text;
}

double percent_of(const ObjectCoverage& object, const Window& grid) {
    return 100 * object.coverage_px / (double(grid.width()) * grid.height());
}

std::string cryptomatte_lines(const Inspection& inspection) {
    std::string text = inspection.cryptomattes.empty() ? "" : "cryptomattes:\n";
    for (const CryptomatteLayer& matte : inspection.cryptomattes) {
        const std::size_t count = matte.object_names.size();
        text += fmt::format("  {:<14}  {} ranks, {}\n", printable(matte.name), 2 * matte.ranks.size(),
                            count == 0 ? std::string("no manifest") : fmt::format("{} names", count));
    }
    if (inspection.coverage_of.empty()) return text;
    text += fmt::format("objects of {}, with the share of the image that they cover:\n",
                        printable(inspection.coverage_of));
    for (const ObjectCoverage& object : inspection.coverage)
        text += fmt::format("  {:>8.4f} %  {}\n", percent_of(object, inspection.capture->data_window),
                            printable(object.name));
    return text;
}

Json color_space_json(const Inspection& inspection) {
    if (!inspection.capture) return nullptr;
    const StoredColors& colors = inspection.capture->stored_colors;
    return {{"name", colors.name}, {"known_by", colors.is_known() ? Json(colors.source) : Json(nullptr)}};
}

Json cryptomattes_json(const Inspection& inspection) {
    Json json = Json::array();
    for (const CryptomatteLayer& matte : inspection.cryptomattes) {
        Json one{
            {"name", matte.name}, {"ranks", 2 * matte.ranks.size()}, {"names", matte.object_names.size()}};
        if (matte.name == inspection.coverage_of)
            for (const ObjectCoverage& object : inspection.coverage)
                one["objects"][object.name] = object.coverage_px;
        json.push_back(std::move(one));
    }
    return json;
}

std::string light_lines(const std::vector<CaptureLight>& lights) {
    std::string text = lights.empty() ? "" : "lights:\n";
    for (const CaptureLight& light : lights)
        text += fmt::format("  {:<14}  {}, intensity {:.4g} {:.4g} {:.4g}\n", light.name,
                            light_kind_names()[std::size_t(light.kind)], light.intensity[0],
                            light.intensity[1], light.intensity[2]);
    return text;
}

std::string camera_lines(const Camera& camera) {
    std::string text;
    for (const auto& [name, value] : camera.values()) {
        const CameraField* field = find_camera_field(name);
        text += fmt::format("  {:<14}  {:g} {}\n", name, value, field ? field->unit : "");
    }
    if (!camera.lens_model.empty()) text += fmt::format("  {:<14}  {}\n", "lens_model", camera.lens_model);
    if (!camera.matrices_found.empty())
        text += fmt::format("  {:<14}  {}\n", "matrices", camera.matrices_found);
    if (!camera.matrices_fault.empty())
        text += fmt::format("  {:<14}  {}\n", "not taken", camera.matrices_fault);
    if (camera.jitter_px)
        text += fmt::format("  {:<14}  {} {} px\n", "jitter", (*camera.jitter_px)[0], (*camera.jitter_px)[1]);
    return text.empty() ? "camera: nothing is known\n" : "camera:\n" + text;
}

/// A float as the shortest number that reads back as it, not as the double nearest to it.
Json number_json(const std::optional<double>& value, PixelType type) {
    if (!value) return nullptr;
    if (type == PixelType::uint32) return std::uint64_t(*value);
    char digits[32];
    const auto written = std::to_chars(digits, digits + sizeof digits, float(*value));
    double shortest = 0;
    std::from_chars(digits, written.ptr, shortest);
    return shortest;
}

Json window_json(const Window& window) {
    return {{"min", {window.min_x, window.min_y}}, {"max", {window.max_x, window.max_y}}};
}

Json channel_json(const InspectedChannel& row) {
    Json channel{{"name", row.channel.name}, {"type", pixel_type_name(row.channel.type)}};
    if (row.statistics) {
        channel["min"] = number_json(row.statistics->min, row.channel.type);
        channel["max"] = number_json(row.statistics->max, row.channel.type);
        channel["nan"] = row.statistics->nan;
        channel["inf"] = row.statistics->infinite;
        channel["negative"] = row.statistics->negative;
    } else {
        for (const char* figure : {"min", "max", "nan", "inf", "negative"}) channel[figure] = nullptr;
        channel["reason"] = row.reason;
    }
    return channel;
}

Json part_json(const InspectedPart& part) {
    Json json{{"name", part.header.name},
              {"view", part.header.view},
              {"data_window", window_json(part.header.data_window)},
              {"display_window", window_json(part.header.display_window)},
              {"compression", part.header.compression},
              {"channels", Json::array()}};
    for (const InspectedChannel& channel : part.channels) json["channels"].push_back(channel_json(channel));
    for (const SampleCount& count : part.sample_counts)
        json["samples"].push_back({{"least", count.least}, {"most", count.most}, {"pixels", count.pixels}});
    return json;
}

/// null where none was asked for.
Json pixel_json(const Inspection& inspection) {
    if (!inspection.pixel) return nullptr;
    Json json{{"x", (*inspection.pixel)[0]}, {"y", (*inspection.pixel)[1]}, {"parts", Json::array()}};
    for (const InspectedPart& part : inspection.parts)
        json["parts"].push_back({{"channels", part.at_pixel.channels}, {"samples", part.at_pixel.samples}});
    return json;
}

Json lights_json(const std::vector<CaptureLight>& lights) {
    return Json::parse(format_lights(lights));
}

Json camera_json(const Camera& camera) {
    Json json = Json::object();
    for (const auto& [name, value] : camera.values()) json[name] = value;
    if (!camera.lens_model.empty()) json["lens_model"] = camera.lens_model;
    if (camera.camera_from_world) json["camera_from_world"] = *camera.camera_from_world;
    if (camera.ndc_from_world) json["ndc_from_world"] = *camera.ndc_from_world;
    if (!camera.matrices_found.empty()) json["matrices"] = camera.matrices_found;
    if (!camera.matrices_fault.empty()) json["matrices_fault"] = camera.matrices_fault;
    if (camera.jitter_px) json["jitter_px"] = *camera.jitter_px;
    return json;
}

}  // namespace

std::vector<std::string> Inspection::missing_roles() const {
    std::vector<std::string> missing;
    for (const ChannelRole& role : channel_roles()) {
        if (role.kind == RoleKind::display) continue;
        const bool found = capture && std::find(capture->roles.begin(), capture->roles.end(), role.name) !=
                                          capture->roles.end();
        if (!found) missing.push_back(role.name);
    }
    return missing;
}

std::map<std::string, std::string> Inspection::remedies() const {
    std::map<std::string, std::string> remedies;
    for (const std::string& role : missing_roles())
        if (capture && capture->remedies.contains(role)) remedies[role] = capture->remedies.at(role);
    return remedies;
}

const InspectedChannel* Inspection::first_unreadable() const {
    for (const InspectedPart& part : parts)
        for (const InspectedChannel& channel : part.channels)
            if (!channel.readable) return &channel;
    return nullptr;
}

std::string text_of(const Inspection& inspection) {
    std::string text = inspection.file.string() + "\n";
    for (const std::string& warning : inspection.warnings)
        text += fmt::format("warning: {}\n", printable(warning));
    const bool lists_channels = inspection.lists_channels || inspection.pixel || !inspection.capture;
    if (!lists_channels) text += part_lines(inspection.parts);
    for (std::size_t i = 0; lists_channels && i < inspection.parts.size(); ++i)
        text += part_title(inspection.parts[i], i) + channel_table(inspection.parts[i].channels) +
                sample_lines(inspection.parts[i]) + pixel_lines(inspection, inspection.parts[i]);
    if (inspection.capture)
        text += fmt::format("profile: {} ({})\n", inspection.capture->profile,
                            printable(inspection.capture->profile_reason));
    else text += fmt::format("profile: none ({})\n", printable(inspection.no_profile_reason));
    if (inspection.capture && !inspection.capture->view.empty())
        text += fmt::format("view: {}\n", printable(inspection.capture->view));
    if (inspection.capture) text += layer_lines(*inspection.capture);
    return text + role_lines(inspection) +
           camera_lines(inspection.capture ? inspection.capture->camera : Camera{}) +
           light_lines(inspection.capture ? inspection.capture->lights : std::vector<CaptureLight>()) +
           cryptomatte_lines(inspection);
}

std::string json_of(const Inspection& inspection) {
    Json json{{"file", inspection.file.string()}, {"parts", Json::array()}};
    for (const InspectedPart& part : inspection.parts) json["parts"].push_back(part_json(part));
    json["pixel"] = pixel_json(inspection);
    if (inspection.capture)
        json["profile"] = {{"id", inspection.capture->profile},
                           {"reason", inspection.capture->profile_reason}};
    else json["profile"] = {{"id", nullptr}, {"reason", inspection.no_profile_reason}};
    json["layer"] = inspection.capture ? inspection.capture->layer : "";
    json["layers"] = inspection.capture ? inspection.capture->layers : std::vector<std::string>();
    json["layer_count"] = inspection.capture ? inspection.capture->layer_count : 0;
    json["color_space"] = color_space_json(inspection);
    json["notes"] = inspection.capture ? inspection.capture->notes : std::vector<std::string>();
    json["warnings"] = inspection.warnings;
    if (inspection.capture)
        for (const std::string& warning : inspection.capture->warnings) json["warnings"].push_back(warning);
    json["roles"] = Json::object();
    if (inspection.capture)
        for (const std::string& role : inspection.capture->roles)
            json["roles"][role] = channels_of(*inspection.capture, role);
    json["depth_kind"] = inspection.depth_kind;
    json["missing"] = inspection.missing_roles();
    json["remedies"] = inspection.remedies();
    json["camera"] = camera_json(inspection.capture ? inspection.capture->camera : Camera{});
    json["lights"] =
        lights_json(inspection.capture ? inspection.capture->lights : std::vector<CaptureLight>());
    json["cryptomattes"] = cryptomattes_json(inspection);
    // Names in files need not be UTF-8.
    return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace aftershade::cli
