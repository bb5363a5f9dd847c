// How a worker ended, in words.
#include <csignal>
#include <nlohmann/json.hpp>

#include "framework/batch/worker.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

std::string signalled(const WorkerResult& result) {
    const int number = result.signal_number;
    const std::string text = signal_text(number);
    if (number == SIGXCPU && result.limits.cpu_seconds)
        return " used up its " + std::to_string(*result.limits.cpu_seconds) + " s of processor time " + text;
    if (number == SIGKILL) return " was killed " + text + ", perhaps because memory ran out,";
    if (number == SIGTERM || number == SIGINT) return " was ended " + text;
    return " crashed " + text;
}

}  // namespace

std::string describe(const WorkerResult& result) {
    const bool in_plugin = !result.status.plugin.empty();
    const std::string who = in_plugin                    ? "plug-in " + result.status.plugin
                            : result.status.pass.empty() ? "the worker"
                                                         : "the GL driver";
    switch (result.end) {
        case WorkerEnd::exited:
            return who + (in_plugin ? " ended the process with code " : " ended with code ") +
                   std::to_string(result.exit_code) + place_text(result.status);
        case WorkerEnd::signalled: return who + signalled(result) + place_text(result.status);
        case WorkerEnd::timed_out: {
            const double limit =
                result.limits.wall_time ? double(result.limits.wall_time->count()) / 1000 : 0;
            return who + " did not finish within " + format_number(limit) + " s and was killed" +
                   place_text(result.status);
        }
        case WorkerEnd::out_of_memory:
            return who + " took more memory than its limit of " +
                   std::to_string(*result.limits.resident_bytes / (1024 * 1024)) + " MiB and was killed" +
                   place_text(result.status);
        case WorkerEnd::interrupted: return who + " was interrupted" + place_text(result.status);
    }
    return who;
}

std::string describe_timeout(WorkerResult result, std::chrono::duration<double> timeout) {
    result.end = WorkerEnd::timed_out;
    result.limits.wall_time = std::chrono::duration_cast<std::chrono::milliseconds>(timeout);
    return describe(result);
}

std::optional<FrameEvent> parse_event(std::string_view line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("event", nlohmann::json()) != "frame") return std::nullopt;
    const auto frame = json.find("frame"), outcome = json.find("outcome"), seconds = json.find("seconds"),
               message = json.find("message");
    if (frame == json.end() || !frame->is_number_integer() || outcome == json.end() ||
        !outcome->is_string() || seconds == json.end() || !seconds->is_number())
        return std::nullopt;
    FrameEvent event{frame->get<int>(), outcome->get<std::string>(), seconds->get<double>(), ""};
    if (message != json.end() && message->is_string()) event.message = message->get<std::string>();
    return event;
}

std::optional<ObjectSighting> parse_sighting(std::string_view line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("event", nlohmann::json()) != "object") return std::nullopt;
    const auto index = json.find("index"), found = json.find("found");
    if (index == json.end() || !index->is_number_integer() || found == json.end() || !found->is_boolean())
        return std::nullopt;
    const auto px = json.find("px");
    return ObjectSighting{index->get<int>(), found->get<bool>(),
                          px != json.end() && px->is_number() ? px->get<double>() : 0};
}

std::optional<DrawnBy> parse_drawn_by(std::string_view line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("event", nlohmann::json()) != "gl") return std::nullopt;
    const auto text = [&](const char* key) {
        const auto found = json.find(key);
        return found != json.end() && found->is_string() ? found->get<std::string>() : "";
    };
    return DrawnBy{text("renderer"), text("device"), text("hardware_fault")};
}

std::optional<int> parse_last_word(std::string_view line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object() || json.value("event", nlohmann::json()) != "end") return std::nullopt;
    const auto code = json.find("code");
    if (code == json.end() || !code->is_number_integer()) return std::nullopt;
    return code->get<int>();
}

std::optional<WorkStatus> parse_status(std::string_view line) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    if (!json.is_object()) return std::nullopt;
    WorkStatus status;
    const auto text = [&](const char* key, std::string& value) {
        const auto found = json.find(key);
        if (found == json.end()) return true;
        if (found->is_string()) value = found->get<std::string>();
        return found->is_string();
    };
    if (!text("step", status.step) || !text("plugin", status.plugin) || !text("phase", status.phase) ||
        !text("effect", status.effect) || !text("pass", status.pass))
        return std::nullopt;
    status.is_foreign = json.value("foreign", nlohmann::json()) == true;
    if (const auto frame = json.find("frame"); frame != json.end()) {
        if (!frame->is_number_integer()) return std::nullopt;
        status.frame = frame->get<int>();
    }
    return status;
}

}  // namespace aftershade
