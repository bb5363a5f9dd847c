#include "framework/batch/report_file.h"

#include <fmt/format.h>

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "framework/base/error.h"
#include "framework/base/side_file.h"

namespace aftershade {

using Json = nlohmann::ordered_json;

void with_report(const std::filesystem::path& folder, const std::function<void(Json&)>& use) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 30;
    const std::string file = (folder / "report.json").string();
    std::string fault;
    const std::string text = read_file_below(folder, "report.json", kMostBytes, fault);
    if (!fault.empty()) throw Error(ErrorKind::capture, file + ": " + fault);
    try {
        Json report = Json::parse(text);
        use(report);
    } catch (const Json::exception& error) {
        throw Error(ErrorKind::capture,
                    fmt::format("{}: is not a report of a golden suite: {}", file, error.what()));
    }
}

}  // namespace aftershade
