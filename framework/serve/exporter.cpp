#include "framework/serve/exporter.h"

#include <array>
#include <exception>
#include <memory>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/serve/file_name.h"

namespace aftershade::serve {

namespace fs = std::filesystem;

namespace {

// Of the hidden folder: the job's own files lie beside it, since results may have any name.
constexpr const char* kResults = "results";

/// The ending of the one file; "" for images, which lie in a folder.
std::string ending_of(const std::string& format) {
    if (format == "png" || format == "exr") return "";
    if (format == "mp4" || format == "mov") return "." + format;
    throw Refusal{400, "'format' is png, exr, mp4 or mov"};
}

}  // namespace

Exporter::~Exporter() {
    cancel_ = true;
    if (thread_.joinable()) thread_.join();
}

void Exporter::start(const ExportRequest& request) {
    const std::lock_guard lock(mutex_);
    if (runs_) throw Refusal{409, "'" + name_ + "' is being exported; wait for it or cancel it"};
    const std::string ending = ending_of(request.format);
    if (request.name.find('#') != std::string::npos)
        throw Refusal{400, "'" + request.name +
                               "' is not a name for the export: '#' stands for the digits of frame numbers"};
    const fs::path target = new_path(request.look_folder, request.name, ending, "the export");
    if (!ending.empty() && program_on_path("ffmpeg").empty())
        throw Refusal{
            409, "a video needs ffmpeg on PATH (Debian package ffmpeg); export PNG or EXR images instead"};
    if (thread_.joinable()) thread_.join();  // it has ended, since none runs
    auto hidden = std::make_unique<AtomicFolder>(target);
    const fs::path folder = hidden->temporary_path();
    const fs::path result = folder / kResults / target.filename();
    ExportJob job{
        folder / "look.json", request.look_folder,
        request.capture,      ending.empty() ? result / (request.name + "_####." + request.format) : result,
        request.files,        request.frames};
    runs_ = true;
    cancel_ = false;
    name_ = target.filename().string();
    written_ = fault_ = "";
    done_ = 0;
    frames_ = request.frames.size();
    thread_ = std::thread([this, job = std::move(job), text = request.text, hidden = std::move(hidden),
                           target] { work(job, text, hidden->temporary_path(), target); });
}

void Exporter::work(const ExportJob& job, const std::string& text, const fs::path& folder,
                    const fs::path& target) {
    std::string fault;
    try {
        write_text_file(job.look, text);
        fault = run_(
            job,
            [&] {
                const std::lock_guard lock(mutex_);
                ++done_;
            },
            cancel_);
        if (cancel_) fault = "cancelled; nothing was written";
        if (fault.empty()) {
            new_path(target.parent_path(), target.filename().string(), "", "the export");
            fs::rename(folder / kResults / target.filename(), target);
        }
    } catch (const Refusal& refusal) {
        fault = refusal.message;
    } catch (const std::exception& error) {
        fault = error.what();
    }
    std::error_code ignored;  // what stays is hidden, and no file of the user's
    fs::remove_all(folder, ignored);
    // Messages name files as they would have been called.
    const std::array<std::pair<fs::path, fs::path>, 2> hidden_and_shown = {
        {{folder / kResults, target.parent_path()}, {job.look, job.look_folder / "the look"}}};
    for (const auto& [hidden, shown] : hidden_and_shown)
        for (std::size_t at = 0; (at = fault.find(hidden.string(), at)) != std::string::npos;
             at += shown.string().size())
            fault.replace(at, hidden.string().size(), shown.string());
    const std::lock_guard lock(mutex_);
    runs_ = false;
    fault_ = fault;
    if (fault.empty()) written_ = target.string();
}

nlohmann::ordered_json Exporter::state() const {
    const std::lock_guard lock(mutex_);
    return {{"runs", runs_},     {"name", name_},       {"done", done_},
            {"frames", frames_}, {"written", written_}, {"fault", fault_}};
}

}  // namespace aftershade::serve
