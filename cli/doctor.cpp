#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <utility>

#include "cli/plugin_options.h"
#include "cli/verbs.h"
#include "framework/base/cores.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/effect/native/confinement.h"
#include "framework/effect/native/native_process.h"
#include "framework/effect/native/thread_limit.h"
#include "framework/gpu/context.h"
#include "framework/gpu/device.h"
#include "framework/gpu/driver_cache.h"
#include "framework/render/draw_with.h"

namespace aftershade::cli {

namespace {

/// What a process of plug-ins is held to here, which only such a process can say.
Confinement confinement_of_plugins() {
    NativeProcessOptions options = native_process_options(PluginOptions{});
    options.warns = false;
    return NativeProcess(std::move(options)).held();
}

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

std::string limit_text(double limit, const std::string& unit, const std::string& what) {
    return std::isfinite(limit) ? fmt::format("{:.15g} {}{}", limit, unit, what) : "no limit of " + what;
}

void print_confinement(const Confinement& held) {
    fmt::print("plug-ins      confined by {} and {}\n",
               held.landlock_abi > 0 ? fmt::format("Landlock (ABI {})", held.landlock_abi) : "no Landlock",
               held.seccomp ? "seccomp" : "no seccomp");
    fmt::print(
        "              rlimits: {}, {} open files, 0 bytes written to files\n",
        limit_text(held.memory_bytes ? double(held.memory_bytes) : kNoLimit, "bytes of ", "address space"),
        kMostPluginFiles);
    if (held.counts_threads) fmt::print("              seccomp: {} threads\n", most_plugin_threads());
    const GroupLimits group = group_limits();
    fmt::print("              control group: {}, {}\n", limit_text(group.memory_bytes, "bytes of ", "memory"),
               limit_text(group.threads, "", "threads"));
    for (const std::string& gap : confinement_gaps(held))
        fmt::print("              this kernel lets them {}\n", gap);
}

nlohmann::ordered_json number_or_null(double number) {
    return std::isfinite(number) ? nlohmann::ordered_json(std::uint64_t(number)) : nullptr;
}

nlohmann::ordered_json confinement_json(const Confinement& held) {
    const GroupLimits group = group_limits();
    return {
        {"landlock_abi", held.landlock_abi},
        {"seccomp", held.seccomp},
        {"rlimits",
         {{"address_space_bytes", number_or_null(held.memory_bytes ? double(held.memory_bytes) : kNoLimit)},
          {"open_files", kMostPluginFiles},
          {"file_bytes", 0}}},
        {"threads", number_or_null(held.counts_threads ? double(most_plugin_threads()) : kNoLimit)},
        {"control_group",
         {{"memory_bytes", number_or_null(group.memory_bytes)}, {"threads", number_or_null(group.threads)}}},
        {"not_prevented", confinement_gaps(held)}};
}

/// What --draw-with auto takes on a backend that works.
std::string draws_with(const gpu::BackendReport& report) {
    if (report.info.software) return std::string(draw_with_name(DrawWith::fragment));
    try {
        gpu::Context context(report.backend);
        ProgramCache programs(context, data_path() / "glsl");
        return std::string(draw_with_name(faster_draw_with(context, programs)));
    } catch (const Error& error) {
        return std::string("not known: ") + error.what();
    }
}

std::string_view transfers_of(const gpu::BackendReport& report) {
    return report.info.maps_transfers ? "mapped" : "direct";
}

void print_table(const std::vector<gpu::BackendReport>& reports) {
    fmt::print("{:<13} {:<7} {:<45} {}\n", "backend", "usable", "renderer", "version");
    for (const gpu::BackendReport& report : reports) {
        const std::string_view name = gpu::backend_name(report.backend);
        if (report.usable)
            fmt::print("{:<13} {:<7} {:<45} {}\n", name, "yes", report.info.renderer, report.info.version);
        else fmt::print("{:<13} {:<7} {}\n", name, "no", report.reason);
    }
    if (const std::string& fault = gpu::prepare_driver_cache(); !fault.empty())
        fmt::print("shader cache  off: {}\n", printable(fault));
    fmt::print("cpu           {} ({} threads)\n", cpu_model(), std::thread::hardware_concurrency());
    for (const gpu::BackendReport& report : reports)
        if (report.usable)
            fmt::print("draws with    {} on {}{}\n", draws_with(report), gpu::backend_name(report.backend),
                       report.info.software ? " (a software renderer gains nothing by compute)" : "");
    for (const gpu::BackendReport& report : reports)
        if (report.usable)
            fmt::print("transfers     {} on {}\n", transfers_of(report), gpu::backend_name(report.backend));
    for (const gpu::Device& device : gpu::list_devices())
        fmt::print("device        {}{}{}\n", device.text(),
                   device.renderer.empty() ? "" : ": " + device.renderer,
                   device.is_hidden ? ", hidden by CUDA_VISIBLE_DEVICES" : "");
    try {
        print_confinement(confinement_of_plugins());
    } catch (const Error& error) {
        fmt::print("plug-ins      none can run: {}\n", error.what());
    }
}

void print_json(const std::vector<gpu::BackendReport>& reports) {
    nlohmann::ordered_json document;
    document["aftershade"] = 1;
    document["cpu"] = {{"model", cpu_model()}, {"threads", std::thread::hardware_concurrency()}};
    try {
        document["plugins"] = confinement_json(confinement_of_plugins());
    } catch (const Error& error) {
        document["plugins"] = {{"reason", error.what()}};
    }
    if (const std::string& fault = gpu::prepare_driver_cache(); !fault.empty())
        document["shader_cache"] = {{"reason", fault}};
    document["backends"] = nlohmann::ordered_json::array();
    for (const gpu::BackendReport& report : reports) {
        nlohmann::ordered_json row{{"backend", gpu::backend_name(report.backend)}, {"usable", report.usable}};
        if (report.usable) {
            row["renderer"] = report.info.renderer;
            row["version"] = report.info.version;
            row["vendor"] = report.info.vendor;
            row["software"] = report.info.software;
            row["draws_with"] = draws_with(report);
            row["transfers"] = transfers_of(report);
        } else {
            row["reason"] = report.reason;
        }
        document["backends"].push_back(std::move(row));
    }
    document["devices"] = nlohmann::ordered_json::array();
    for (const gpu::Device& device : gpu::list_devices()) {
        nlohmann::ordered_json row{{"index", device.index}, {"names", device.names()}};
        if (!device.renderer.empty()) row["renderer"] = device.renderer;
        row["software"] = device.is_software;
        row["hidden"] = device.is_hidden;
        document["devices"].push_back(std::move(row));
    }
    fmt::print("{}\n", document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
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
