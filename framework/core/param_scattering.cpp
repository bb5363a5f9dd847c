// Values of the type scattering_profile: one profile for all, or rows by object.
#include <algorithm>
#include <filesystem>
#include <utility>

#include "framework/core/param_internal.h"

namespace aftershade {

namespace {

constexpr std::string_view kRowKey = "profile";

ParamSpec column(const std::string& name, ParamType type) {
    ParamSpec spec;
    spec.name = name;
    spec.type = type;
    spec.default_value = type == ParamType::int_ ? ParamValue(std::int64_t(0)) : ParamValue(0.0);
    if (type == ParamType::vec3) spec.default_value = std::vector<double>(3, 0.0);
    return spec;
}

TableValue::Row row_of(const ScatteringProfile& profile, std::size_t index) {
    const auto list = [](const Rgb& rgb) { return std::vector<double>(rgb.begin(), rgb.end()); };
    return {{double(index)},
            list(profile.fitted_d_mm()),
            list(profile.direct),
            list(profile.fitted_falloff_mm()),
            {profile.reach_mm()}};
}

}  // namespace

std::vector<ParamSpec> scattering_columns() {
    return {column("index", ParamType::int_), column("d", ParamType::vec3), column("direct", ParamType::vec3),
            column("falloff", ParamType::vec3), column("reach", ParamType::float_)};
}

std::vector<ScatteringProfile> scattering_profiles_of(const ScatteringValue& value) {
    std::vector<ScatteringProfile> profiles = {value.usual};
    for (const auto& [key, profile] : value.rows)
        if (std::find(profiles.begin(), profiles.end(), profile) == profiles.end())
            profiles.push_back(profile);
    return profiles;
}

bool is_burley(const ScatteringValue& value) {
    const auto burley = [](const ScatteringProfile& profile) {
        return profile.type == ScatteringProfile::Type::burley;
    };
    const auto profiles = scattering_profiles_of(value);
    return std::all_of(profiles.begin(), profiles.end(), burley);
}

TableValue scattering_table(const ScatteringValue& value) {
    const std::vector<ScatteringProfile> profiles = scattering_profiles_of(value);
    const auto row = [&](const ScatteringProfile& profile) {
        return row_of(profile,
                      std::size_t(std::find(profiles.begin(), profiles.end(), profile) - profiles.begin()));
    };
    TableValue table;
    table.default_row = row(value.usual);
    for (const auto& [key, profile] : value.rows) table.rows.emplace_back(key, row(profile));
    return table;
}

std::optional<ParamValue> ValueReader::scattering(const Node& node) const {
    // Of a value of the command line, which has no line, from where the program runs.
    const std::filesystem::path folder =
        node.place.line > 0 ? std::filesystem::path(node.place.file).parent_path() : std::filesystem::path();
    const bool has_rows = node.is_object() && (node.find("rows") || node.find("default"));
    const int errors_before = diagnostics.error_count();
    ScatteringValue value;
    const auto profile_at = [&](const Node* at, const std::string& where) {
        std::optional<ScatteringProfile> profile;
        if (at) profile = parse_scattering_profile(*at, where, folder, diagnostics);
        return profile.value_or(ScatteringProfile{});
    };
    if (!has_rows) {
        value.usual = profile_at(&node, label);
    } else {
        ObjectReader reader(node, label, diagnostics);
        value.usual = profile_at(reader.any("default", ObjectReader::Presence::required), label + ".default");
        TableKeyReader keys(diagnostics);
        if (const Node* rows = reader.array("rows"))
            for (std::size_t i = 0; i < rows->items.size(); ++i) {
                const Node& row = rows->items[i];
                const std::string where = label + ".rows[" + std::to_string(i) + "]";
                ObjectReader row_reader(row, where, diagnostics);
                if (!row_reader.is_object()) continue;
                const Node* at = row_reader.any(std::string(kRowKey), ObjectReader::Presence::required);
                const ScatteringProfile profile = profile_at(at, where);
                for (const TableKey& key : keys.read_row(row_reader, row, where))
                    value.rows.emplace_back(key, profile);
                row_reader.finish();
            }
        reader.finish();
        keys.check_overlaps();
        if (value.rows.size() > kMaxScatteringRows)
            diagnostics.error(node.place, label + ": " + std::to_string(value.rows.size()) +
                                              " rows are more than " + std::to_string(kMaxScatteringRows));
    }
    if (diagnostics.error_count() > errors_before) return std::nullopt;
    return value;
}

}  // namespace aftershade
