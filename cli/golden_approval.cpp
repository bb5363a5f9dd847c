#include "cli/golden_approval.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace fs = std::filesystem;

std::string approve_command(const GoldenSetup& setup) {
    return printed_command({"aftershade", "golden", "approve", setup.suite.argument}) +
           setup.context.with_options;
}

void print_approval(const GoldenApproval& approval) {
    for (const GoldenCaseResult& test : approval.cases)
        if (test.verdict != Verdict::same) {
            const bool is_approved = test.verdict == Verdict::warning;
            std::cerr << fmt::format("\n{} {}: {}\n", is_approved ? "WARNING" : "FAILED", test.test->name,
                                     is_approved ? "approved" : "not approved, its goldens are as they were");
            for (const std::string& message : test.messages)
                std::cerr << "    " << printable_lines(message) << "\n";
        }
    std::cerr << "\n";
    for (const fs::path& path : approval.written) std::cout << path.string() << "\n";
    for (const fs::path& path : approval.renewed) std::cout << path.string() << "\n";
    std::cout << std::flush;
    for (const fs::path& path : approval.outdated)
        std::cerr << fmt::format(
            "{}: warning: approved too, by another renderer for another look or other effects; "
            "approve it again there, or remove it\n",
            path.string());
    std::cerr << fmt::format("{} written, {} renewed, {} unchanged\n",
                             counted(approval.written.size(), "image"),
                             counted(approval.renewed.size(), "sidecar"), approval.unchanged);
}

void add_approver_option(CLI::App& app, GoldenOptions& options) {
    app.add_option("--approver", options.approver,
                   "Name for the sidecars of new images (default: git's user.name, else $USER)")
        ->type_name("NAME");
}

void add_any_renderer_option(CLI::App& app, GoldenOptions& options) {
    app.add_flag(
        "--any-renderer", options.any_renderer,
        "Approve even if the goldens are from hardware and this renderer is software, or vice versa");
}

CLI::Option* add_page_limit(CLI::App& app, GoldenOptions& options) {
    return app
        .add_option("--page-limit", options.page_limit_mb,
                    "MiB of pictures to embed in index.html; it links to the rest")
        ->check(CLI::Range(0.0, 400.0))
        ->capture_default_str();
}

}  // namespace aftershade::cli
