// The timeline of a run, as a file that chrome://tracing and ui.perfetto.dev show.
#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

/// Times are counted from the making of the object. [thread-safe]
class Trace {
public:
    using Clock = std::chrono::steady_clock;

    Trace() : begin_(Clock::now()) {}

    /// `row` is what the work belongs to, such as "decode"; work that overlaps there is shown in several
    /// rows.
    void add(std::string row, std::string name, Clock::time_point start, Clock::time_point end);
    /// The JSON Object Format of Google's "Trace Event Format": complete events, in microseconds.
    std::string json() const;

private:
    struct Event {
        std::string row;
        std::string name;
        double start_us = 0;
        double end_us = 0;
    };

    const Clock::time_point begin_;
    mutable std::mutex mutex_;
    std::vector<Event> events_;
};

/// Work from here to the end of the scope. A null trace is allowed.
class TraceScope {
public:
    TraceScope(Trace* trace, std::string row, std::string name)
        : trace_(trace), row_(std::move(row)), name_(std::move(name)), start_(Trace::Clock::now()) {}
    ~TraceScope() {
        if (trace_) trace_->add(std::move(row_), std::move(name_), start_, Trace::Clock::now());
    }
    TraceScope(const TraceScope&) = delete;
    TraceScope& operator=(const TraceScope&) = delete;

private:
    Trace* trace_;
    std::string row_;
    std::string name_;
    Trace::Clock::time_point start_;
};

}  // namespace aftershade
