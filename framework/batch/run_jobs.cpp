#include "framework/batch/run_jobs.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>

namespace aftershade {

namespace {

constexpr int kMostIdleWorkers = 3;
constexpr const char* kErrorPrefix = "aftershade: error: ";

/// An error that every other frame would meet, too.
bool ends_the_run(ExitCode code) {
    return code == ExitCode::usage || code == ExitCode::gl || code == ExitCode::output;
}

/// What all workers share; calls of the listener follow one another.
class JobBoard {
public:
    JobBoard(const JobOptions& options, const JobListener& listener)
        : options_(options), listener_(listener) {
        for (const JobPiece& piece : options.pieces)
            for (std::size_t i = std::size_t(piece.warmup_frames); i < piece.frames.size(); ++i)
                frames_[piece.frames[i]] = {piece.frames[i], "not run", 0, ""};
    }

    void out(std::string_view line) {
        const std::lock_guard lock(mutex_);
        if (listener_.on_stdout) listener_.on_stdout(line);
    }
    void error(std::string_view line) {
        const std::lock_guard lock(mutex_);
        if (listener_.on_stderr) listener_.on_stderr(line);
    }
    void frame(const FrameEvent& event) {
        const std::lock_guard lock(mutex_);
        const auto found = frames_.find(event.frame);
        if (found == frames_.end()) return;
        found->second = event;
        if (event.outcome == "failed" && options_.stop_on_error) stop_ = true;
        if (listener_.on_frame) listener_.on_frame(event);
    }
    void object(const ObjectSighting& sighting) {
        const std::lock_guard lock(mutex_);
        if (listener_.on_object) listener_.on_object(sighting);
    }
    void drawn_by(const DrawnBy& gl) {
        const std::lock_guard lock(mutex_);
        if (gl_.renderer.empty() || !gl.hardware_fault.empty()) gl_ = gl;
    }
    void ended(ExitCode code, const std::string& error = "") {
        const std::lock_guard lock(mutex_);
        if (code == ExitCode::done || ends_the_run(worst_)) return;
        worst_ = code;
        if (!error.empty()) last_error_ = error;
        if (!ends_the_run(code)) return;
        stop_ = true;
        error_ = error;
    }
    /// Frames that nobody will render.
    void given_up(const std::vector<int>& frames, const std::string& why) {
        const std::lock_guard lock(mutex_);
        for (const int frame : frames)
            if (const auto found = frames_.find(frame);
                found != frames_.end() && found->second.outcome == "not run")
                found->second.message = why;
    }
    /// A process that cannot be started: what keeps one from it keeps the others, too.
    void failed(std::exception_ptr failure) {
        const std::lock_guard lock(mutex_);
        if (!failure_) failure_ = std::move(failure);
        stop_ = true;
    }
    void rethrow() const {
        if (failure_) std::rethrow_exception(failure_);
    }
    /// Set by an error that ends the whole run.
    const std::atomic<bool>& stop() const { return stop_; }

    JobsReport report(bool interrupted) const {
        JobsReport report;
        report.interrupted = interrupted;
        report.error = error_;
        report.gl = gl_;
        std::size_t done = 0, skipped = 0;
        for (const auto& [number, event] : frames_) {
            report.frames.push_back(event);
            done += event.outcome == "done" || event.outcome == "current";
            skipped += event.outcome == "skipped";
        }
        if (interrupted) report.exit_code = ExitCode::interrupted;
        else if (ends_the_run(worst_)) report.exit_code = worst_;
        else if (done + skipped < frames_.size())
            report.exit_code = done > 0                                                  ? ExitCode::partial
                               : worst_ == ExitCode::done || worst_ == ExitCode::partial ? ExitCode::capture
                                                                                         : worst_;
        else if (worst_ == ExitCode::effect || worst_ == ExitCode::memory) {
            // A worker that ends badly after its frames.
            report.exit_code = worst_;
            report.error = last_error_;
        }
        return report;
    }

private:
    const JobOptions& options_;
    const JobListener& listener_;
    std::mutex mutex_;
    std::map<int, FrameEvent> frames_;
    std::atomic<bool> stop_ = false;
    ExitCode worst_ = ExitCode::done;
    DrawnBy gl_;
    std::string error_;       // of what ended the run
    std::string last_error_;  // of a worker
    std::exception_ptr failure_;
};

/// One piece, by as many workers as it takes.
class PieceRun {
public:
    PieceRun(const JobOptions& options, int number, JobBoard& board, const std::atomic<bool>& interrupt)
        : options_(options),
          number_(number),
          piece_(options.pieces[std::size_t(number)]),
          board_(board),
          interrupt_(interrupt) {}

    void run() {
        for (int idle_workers = 0; idle_workers < kMostIdleWorkers; ++idle_workers) {
            if (piece_.frames.empty() || interrupt_) return;
            ended_ = 0;
            if (!run_one()) return;
            if (ended_ > 0) idle_workers = -1;
        }
        board_.given_up(piece_.frames,
                        std::to_string(kMostIdleWorkers) + " workers in turn finished no frame");
    }

private:
    /// Whether another worker should go on with what is left of the piece.
    bool run_one() {
        WorkerCommand command;
        command.arguments = options_.command(piece_, number_);
        command.limits.memory_bytes = options_.memory_bytes;
        if (!std::getenv("LP_NUM_THREADS"))
            command.environment["LP_NUM_THREADS"] = std::to_string(options_.threads);
        command.limits.resident_bytes = options_.resident_bytes;
        Watchdog watchdog(options_.frame_timeout, options_.pass_limit, interrupt_);
        last_error_.clear();
        WorkerResult result = run_worker(command, listener(watchdog), &watchdog.flag());
        if (watchdog.barked()) {
            if (watchdog.barked_at_pass()) result.status = watchdog.status_at_bark();
            const std::string why = describe_timeout(result, watchdog.timeout());
            if (first_unfinished() == piece_.frames.size()) board_.error(kErrorPrefix + why);
            board_.ended(ExitCode::effect, why);
            return cost_a_frame(result.status, why);
        }
        if (result.end == WorkerEnd::interrupted) return false;
        const bool has_seen_all = first_unfinished() == piece_.frames.size();
        if (last_error_.empty() && has_seen_all && result.end != WorkerEnd::exited) {
            last_error_ = describe(result) + " after its frames";
            board_.error(kErrorPrefix + last_error_);
        }
        board_.ended(result.end == WorkerEnd::exited          ? ExitCode(result.exit_code)
                     : result.end == WorkerEnd::out_of_memory ? ExitCode::memory
                                                              : ExitCode::effect,
                     last_error_);
        if (result.end == WorkerEnd::exited && (has_seen_all || ends_the_run(ExitCode(result.exit_code))))
            return false;
        return cost_a_frame(result.status, last_error_.empty() ? describe(result) : last_error_);
    }

    WorkerListener listener(Watchdog& watchdog) {
        WorkerListener listener;
        listener.on_stdout = [&](std::string_view line) { board_.out(line); };
        listener.on_stderr = [&](std::string_view line) {
            if (line.starts_with(kErrorPrefix))
                last_error_ = line.substr(std::string_view(kErrorPrefix).size());
            board_.error(line);
        };
        listener.on_frame = [&](const FrameEvent& event) {
            watchdog.heard();
            finished_.insert(event.frame);
            ++ended_;
            board_.frame(event);
        };
        listener.on_object = [&](const ObjectSighting& sighting) { board_.object(sighting); };
        listener.on_gl = [&](const DrawnBy& gl) { board_.drawn_by(gl); };
        // A frame's beginning, or the end of its passes; one pass or plug-in after the other is no progress.
        listener.on_status = [&](const WorkStatus& status) {
            if (status.frame && status.plugin.empty() && status.pass.empty()) watchdog.heard();
            watchdog.is_at(status);
        };
        return listener;
    }

    std::optional<std::size_t> index_of(int frame) const {
        const auto found = std::find(piece_.frames.begin(), piece_.frames.end(), frame);
        if (found == piece_.frames.end()) return std::nullopt;
        return std::size_t(found - piece_.frames.begin());
    }

    std::size_t first_unfinished() const {
        std::size_t index = std::size_t(piece_.warmup_frames);
        while (index < piece_.frames.size() && finished_.contains(piece_.frames[index])) ++index;
        return index;
    }

    /// Fails the frame that the worker was at and leaves the others to another worker. Frames before it whose
    /// files were not yet in place are among them.
    bool cost_a_frame(const WorkStatus& status, const std::string& why) {
        const std::size_t next = first_unfinished();
        if (next == piece_.frames.size()) return false;
        const std::size_t at = status.frame ? index_of(*status.frame).value_or(next) : next;
        const std::size_t failed = at < next || finished_.contains(piece_.frames[at]) ? next : at;
        board_.frame({piece_.frames[failed], "failed", 0, why});
        piece_.frames.erase(piece_.frames.begin() + std::ptrdiff_t(failed));
        const std::size_t warmup = std::min(std::size_t(options_.warmup_frames), next);
        piece_.frames.erase(piece_.frames.begin(), piece_.frames.begin() + std::ptrdiff_t(next - warmup));
        piece_.warmup_frames = int(warmup);
        if (first_unfinished() == piece_.frames.size()) piece_.frames.clear();
        return true;
    }

    const JobOptions& options_;
    int number_;
    JobPiece piece_;
    JobBoard& board_;
    const std::atomic<bool>& interrupt_;
    std::string last_error_;
    std::set<int> finished_;  // frames that workers are done with
    std::size_t ended_ = 0;   // frames that the worker is done with
};

}  // namespace

JobsReport run_jobs(const JobOptions& options, const JobListener& listener, const std::atomic<bool>& stop) {
    JobBoard board(options, listener);
    std::atomic<bool> end = false;
    std::atomic<int> running = int(options.pieces.size());
    {
        std::vector<std::jthread> workers;
        for (int number = 0; number < int(options.pieces.size()); ++number)
            workers.emplace_back([&, number] {
                try {
                    PieceRun(options, number, board, end).run();
                } catch (...) {
                    board.failed(std::current_exception());
                }
                --running;
            });
        while (running > 0) {
            end = stop || board.stop();
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
    }
    board.rethrow();
    return board.report(stop);
}

}  // namespace aftershade
