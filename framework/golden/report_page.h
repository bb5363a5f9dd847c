// The report of a golden suite: as one HTML page, and as other programs hand it back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace aftershade {

struct ReportPageOptions {
    /// Bytes of the pictures inside the page. Worst verdicts come first. The page shows other pictures from
    /// the PNG files next to it, without exposure and values.
    std::uint64_t limit_bytes = 128ull * 1024 * 1024;
};

/// Writes `page` from the report.json and images/ that `golden run --report` left in `report`: a page that
/// needs no server, no network and, within the limit, no other file. Images whose bits are those approved are
/// one small picture; of all others every layer's values are in it. The page names a picture that is gone.
/// Throws Error(ErrorKind::capture) where report.json cannot be read, Error(ErrorKind::output) where the page
/// cannot be written.
void write_report_page(const std::filesystem::path& report, const std::filesystem::path& page,
                       const ReportPageOptions& options = {});

/// The same page for a server, which sends its parts by themselves.
struct ServedReportPage {
    std::string html, style, script;  ///< the HTML requests /page.css, /page.js and /icon.svg
};
ServedReportPage served_report_page();
/// {"report", "texts"}: what the page holds of a report. Throws Error(ErrorKind::capture).
nlohmann::ordered_json report_page_data(const std::filesystem::path& report,
                                        const ReportPageOptions& options = {});
/// The bytes of a PNG below the report, by its relative path. Throws Error(ErrorKind::capture) where it is
/// none.
std::string read_report_png(const std::filesystem::path& report, const std::string& name);

/// Reads `folder`/report.json and calls `use` with it. Throws Error(ErrorKind::capture) where it cannot be
/// read, or `use` misses a key or finds another type.
void with_report(const std::filesystem::path& folder,
                 const std::function<void(nlohmann::ordered_json&)>& use);

}  // namespace aftershade
