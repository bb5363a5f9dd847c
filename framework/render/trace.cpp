#include "framework/render/trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <map>
#include <utility>

#include "framework/base/text.h"

namespace aftershade {

namespace {

std::string microseconds(double value) {
    std::array<char, 64> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed, 1);
    return {text.data(), end.ptr};
}

/// What every event of a thread begins with.
std::string event_begin(char phase, const std::string& name, int thread) {
    return std::string("{\"ph\": \"") + phase + "\", \"name\": " + json_string(name) +
           ", \"pid\": 1, \"tid\": " + std::to_string(thread);
}

}  // namespace

void Trace::add(std::string row, std::string name, Clock::time_point start, Clock::time_point end) {
    const auto since_begin = [&](Clock::time_point time) {
        return std::chrono::duration<double, std::micro>(time - begin_).count();
    };
    const std::lock_guard lock(mutex_);
    events_.push_back({std::move(row), std::move(name), since_begin(start), since_begin(end)});
}

std::string Trace::json() const {
    std::vector<Event> events;
    {
        const std::lock_guard lock(mutex_);
        events = events_;
    }
    std::ranges::stable_sort(events, {}, &Event::start_us);
    // A viewer nests what overlaps in one thread, so overlapping work gets further threads of that name.
    struct Lane {
        int thread = 0;
        double end_us = 0;
    };
    std::map<std::string, std::vector<Lane>> rows;
    std::string text = "{\"displayTimeUnit\": \"ms\", \"traceEvents\": [\n";
    std::string names;
    int threads = 0;
    for (const Event& event : events) {
        std::vector<Lane>& lanes = rows[event.row];
        auto lane =
            std::ranges::find_if(lanes, [&](const Lane& one) { return one.end_us <= event.start_us; });
        if (lane == lanes.end()) {
            lane = lanes.insert(lanes.end(), Lane{++threads, 0});
            names += ",\n" + event_begin('M', "thread_name", lane->thread) +
                     ", \"args\": {\"name\": " + json_string(event.row) + "}}";
        }
        lane->end_us = event.end_us;
        text += event_begin('X', event.name, lane->thread) + ", \"cat\": " + json_string(event.row) +
                ", \"ts\": " + microseconds(event.start_us) +
                ", \"dur\": " + microseconds(event.end_us - event.start_us) + "},\n";
    }
    return text +
           "{\"ph\": \"M\", \"name\": \"process_name\", \"pid\": 1, \"args\": {\"name\": \"aftershade\"}}" +
           names + "\n]}\n";
}

}  // namespace aftershade
