#include "cli/early_report.h"

#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <system_error>

#include "cli/batch_report.h"
#include "framework/base/atomic_file.h"
#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

bool begins_frames(const RunArguments& options) {
    return !options.jobs.report.empty() && !options.explain && !options.stream.print_ffmpeg &&
           !options.resume.dry_run;
}

bool is_report(const std::filesystem::path& path) {
    constexpr std::size_t kHead_bytes = 64;
    std::string head(kHead_bytes, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), std::streamsize(head.size()));
    return head.starts_with('{') && head.find("\"aftershade_report\"") != std::string::npos;
}

}  // namespace

void remove_old_report(const RunArguments& options) {
    std::error_code failure;
    if (begins_frames(options) && std::filesystem::is_regular_file(options.jobs.report, failure) &&
        is_report(options.jobs.report))
        std::filesystem::remove(options.jobs.report, failure);
}

void write_early_report(const RunArguments& options, ExitCode code, const std::string& message) {
    std::error_code failure;
    if (!begins_frames(options) || std::filesystem::exists(options.jobs.report, failure)) return;
    try {
        write_text_file(options.jobs.report,
                        report_json({options.look, options.capture.capture, {}, 0, code, {}, message}));
    } catch (const Error& error) {
        if (code == ExitCode::done) throw;
        std::cerr << printable_lines(error.what()) << "\n";
    }
}

}  // namespace aftershade::cli
