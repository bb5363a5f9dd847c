#include "framework/base/status.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdlib>
#include <cstring>
#include <nlohmann/json.hpp>

namespace aftershade {

namespace {

// Escaping makes a byte six at most ("\u0001"), and PIPE_BUF is 4096 on Linux.
constexpr std::size_t kMaxField = 128;
constexpr std::size_t kMaxMessage = 640;

std::string shortened(const std::string& text) {
    return text.size() <= kMaxField ? text : "..." + text.substr(text.size() - kMaxField + 3);
}

}  // namespace

std::string status_line(const WorkStatus& status) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    if (!status.step.empty()) json["step"] = shortened(status.step);
    if (!status.plugin.empty()) json["plugin"] = shortened(status.plugin);
    if (!status.phase.empty()) json["phase"] = shortened(status.phase);
    if (status.frame) json["frame"] = *status.frame;
    if (!status.effect.empty()) json["effect"] = shortened(status.effect);
    if (!status.pass.empty()) json["pass"] = shortened(status.pass);
    if (status.is_foreign) json["foreign"] = true;
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string event_line(const FrameEvent& event) {
    nlohmann::ordered_json json = {
        {"event", "frame"}, {"frame", event.frame}, {"outcome", event.outcome}, {"seconds", event.seconds}};
    if (!event.message.empty()) json["message"] = event.message.substr(0, kMaxMessage);
    return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::string sighting_line(const ObjectSighting& sighting) {
    return nlohmann::ordered_json{{"event", "object"},
                                  {"index", sighting.index},
                                  {"found", sighting.is_found},
                                  {"px", sighting.px}}
               .dump() +
           "\n";
}

std::string drawn_by_line(const DrawnBy& gl) {
    for (std::string fault = gl.hardware_fault;; fault.resize(fault.size() * 3 / 4)) {
        const nlohmann::ordered_json json = {{"event", "gl"},
                                             {"renderer", shortened(gl.renderer)},
                                             {"device", shortened(gl.device)},
                                             {"hardware_fault", fault}};
        const std::string line = json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        if (line.size() <= PIPE_BUF || fault.empty()) return line;
    }
}

std::string last_word_line(int exit_code) {
    return nlohmann::ordered_json{{"event", "end"}, {"code", exit_code}}.dump() + "\n";
}

std::string place_text(const WorkStatus& status) {
    const std::string step = status.step.empty() ? "" : "step '" + status.step + "'";
    std::string text;
    if (!status.pass.empty()) {
        text = std::string(" while ") + (status.phase == "compile" ? "compiling" : "drawing") + " pass '" +
               status.pass + "'" + (step.empty() ? "" : " of " + step) + " (effect '" + status.effect + "')";
    } else {
        if (!status.phase.empty()) text += " in " + status.phase;
        if (!step.empty()) text += (status.phase.empty() ? " in " : " of ") + step;
    }
    if (status.frame) text += (text.empty() ? " in frame " : ", frame ") + std::to_string(*status.frame);
    return text;
}

StatusWriter::StatusWriter() {
    const char* text = std::getenv(kStatusFdVariable);
    if (!text) return;
    int descriptor = -1;
    const char* end = text + std::strlen(text);
    const auto parsed = std::from_chars(text, end, descriptor);
    struct stat status;
    if (parsed.ec != std::errc() || parsed.ptr != end || descriptor < 0) return;
    if (fstat(descriptor, &status) != 0 || !S_ISFIFO(status.st_mode)) return;
    // What this process starts must not hold the pipe open, nor speak in its name.
    fcntl(descriptor, F_SETFD, FD_CLOEXEC);
    descriptor_ = descriptor;
}

StatusWriter::StatusWriter(std::function<void(const WorkStatus&)> listener)
    : listener_(std::move(listener)) {}

void StatusWriter::write(const WorkStatus& status) {
    const std::lock_guard lock(mutex_);
    if (status == current_) return;
    current_ = status;
    if (listener_) listener_(status);
    send(status_line(status));
}

void StatusWriter::write(const FrameEvent& event) {
    const std::lock_guard lock(mutex_);
    send(event_line(event));
}

void StatusWriter::write(const ObjectSighting& sighting) {
    const std::lock_guard lock(mutex_);
    send(sighting_line(sighting));
}

void StatusWriter::write(const DrawnBy& gl) {
    const std::lock_guard lock(mutex_);
    send(drawn_by_line(gl));
}

void StatusWriter::end(int exit_code) {
    const std::lock_guard lock(mutex_);
    send(last_word_line(exit_code));
}

void StatusWriter::send(const std::string& line) {
    if (descriptor_ < 0) return;
    ssize_t written = -1;
    do written = ::write(descriptor_, line.data(), line.size());
    while (written < 0 && errno == EINTR);
    if (written < 0) descriptor_ = -1;  // nobody listens any more; the work itself goes on
}

WorkStatus StatusWriter::current() const {
    const std::lock_guard lock(mutex_);
    return current_;
}

StatusScope::StatusScope(StatusWriter* writer, const WorkStatus& status) : writer_(writer) {
    if (!writer_) return;
    before_ = writer_->current();
    writer_->write(status);
}

StatusScope::~StatusScope() {
    if (writer_) writer_->write(before_);
}

}  // namespace aftershade
