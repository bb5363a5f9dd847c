#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "cli/verbs.h"
#include "framework/batch/approved_image.h"
#include "framework/core/confinement.h"
#include "framework/gpu/context.h"

namespace aftershade::cli {

namespace {

void print_table(const std::vector<gpu::BackendReport>& reports) {
    fmt::print("{:<13} {:<7} {:<45} {}\n", "backend", "usable", "renderer", "version");
    for (const gpu::BackendReport& report : reports) {
        const std::string_view name = gpu::backend_name(report.backend);
        if (report.usable)
            fmt::print("{:<13} {:<7} {:<45} {}\n", name, "yes", report.info.renderer, report.info.version);
        else fmt::print("{:<13} {:<7} {}\n", name, "no", report.reason);
    }
    fmt::print("cpu           {} ({} threads)\n", cpu_model(), std::thread::hardware_concurrency());
    const Confinement offered = offered_confinement();
    fmt::print(
        "plug-ins      confined by {} and {}\n",
        offered.landlock_abi > 0 ? fmt::format("Landlock (ABI {})", offered.landlock_abi) : "no Landlock",
        offered.seccomp ? "seccomp" : "no seccomp");
    for (const std::string& gap : confinement_gaps(offered))
        fmt::print("              this kernel lets them {}\n", gap);
}

void print_json(const std::vector<gpu::BackendReport>& reports) {
    nlohmann::ordered_json document;
    document["aftershade"] = 1;
    document["cpu"] = {{"model", cpu_model()}, {"threads", std::thread::hardware_concurrency()}};
    const Confinement offered = offered_confinement();
    document["plugins"] = {{"landlock_abi", offered.landlock_abi},
                           {"seccomp", offered.seccomp},
                           {"not_prevented", confinement_gaps(offered)}};
    document["backends"] = nlohmann::ordered_json::array();
    for (const gpu::BackendReport& report : reports) {
        nlohmann::ordered_json row{{"backend", gpu::backend_name(report.backend)}, {"usable", report.usable}};
        if (report.usable) {
            row["renderer"] = report.info.renderer;
            row["version"] = report.info.version;
            row["vendor"] = report.info.vendor;
            row["software"] = report.info.software;
        } else {
            row["reason"] = report.reason;
        }
        document["backends"].push_back(std::move(row));
    }
    fmt::print("{}\n", document.dump(2));
}

}  // namespace

Verb add_doctor(CLI::App& app) {
    auto json = std::make_shared<bool>(false);
    app.add_flag("--json", *json, "Print JSON");
    return [json] {
        const std::vector<gpu::BackendReport> reports = gpu::probe_backends();
        if (*json) print_json(reports);
        else print_table(reports);
        for (const gpu::BackendReport& report : reports)
            if (report.usable) return ExitCode::done;
        return ExitCode::gl;
    };
}

}  // namespace aftershade::cli
