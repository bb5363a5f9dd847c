#include "framework/run/run_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <system_error>
#include <thread>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/run/run_state.h"

namespace aftershade {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

/// A frame's lock is one byte far behind the text, of which no file has so many. Byte 0 guards the text.
constexpr off_t kFirstFrame = off_t(1) << 40;

/// Locks of the open file, not of the process (Linux 3.15): threads and libraries that open it too do not
/// lose them.
bool lock_bytes(int file, int command, short type, off_t first, off_t count) {
    struct flock range {};
    range.l_type = type;
    range.l_whence = SEEK_SET;
    range.l_start = first;
    range.l_len = count;
    int result = 0;
    do result = fcntl(file, command, &range);
    while (result != 0 && errno == EINTR);
    return result == 0;
}

struct Range {
    int first = 0;
    int last = 0;
};

/// Frames that follow one another as one range each. Very many of them, which would be slow to lock, as one
/// with what lies between.
std::vector<Range> ranges_of(std::vector<int> frames) {
    std::sort(frames.begin(), frames.end());
    std::vector<Range> ranges;
    for (const int frame : frames) {
        if (!ranges.empty() && frame <= ranges.back().last + 1) ranges.back().last = frame;
        else ranges.push_back({frame, frame});
    }
    constexpr std::size_t kMost = 4096;
    if (ranges.size() > kMost) ranges = {{frames.front(), frames.back()}};
    return ranges;
}

std::string text_of(const std::vector<Range>& ranges) {
    std::string text;
    for (const Range& range : ranges)
        text += (text.empty() ? "" : ",") + std::to_string(range.first) +
                (range.last > range.first ? "-" + std::to_string(range.last) : "");
    return text;
}

std::string now_text() {
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 64> text{};
    std::strftime(text.data(), text.size(), "%F %T %z", &local);
    return text.data();
}

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

std::string read_all(int file) {
    std::string text;
    std::array<char, 4096> buffer;
    ssize_t count = 0;
    constexpr std::size_t kMostBytes = std::size_t(1) << 24;  // of a planted one
    while (text.size() < kMostBytes &&
           (count = pread(file, buffer.data(), buffer.size(), off_t(text.size()))) > 0)
        text.append(buffer.data(), std::size_t(count));
    return text;
}

void replace_all(int file, const std::string& text) {
    if (ftruncate(file, 0) == 0 && pwrite(file, text.data(), text.size(), 0) < 0) return;
}

bool overlaps(const json& holder, const std::vector<Range>& ranges) {
    for (const json& theirs : holder.at("ranges"))
        for (const Range& ours : ranges)
            if (theirs.at(0).get<int>() <= ours.last && ours.first <= theirs.at(1).get<int>()) return true;
    return false;
}

/// Lines of holders, without those of which `leaves_out` is true, and without damaged ones.
template <typename Predicate>
std::string kept_lines(const std::string& text, const Predicate& leaves_out) {
    std::istringstream lines(text);
    std::string kept;
    for (std::string line; std::getline(lines, line);) try {
            if (!leaves_out(line, json::parse(line))) kept += line + "\n";
        } catch (const json::exception&) {
        }
    return kept;
}

}  // namespace

bool lock_whole_file(int file) {
    return lock_bytes(file, F_OFD_SETLKW, F_WRLCK, 0, 0);
}

RunLock::RunLock(const std::string& pattern, std::vector<int> frames, const std::string& command)
    : pattern_(pattern) {
    const RunState state = run_state(pattern);
    folder_ = state.folder;
    name_ = state.lock();
    // Without a number in its name, one file stands for every frame.
    if (state.output.find('#') == std::string::npos) frames = {0};
    make_state_folder(state);
    open_file();
    if (held_ && take(frames)) add_holder(frames, command);
}

/// The file that has the name, with byte 0 locked: the last holder may remove it between open and lock.
void RunLock::open_file() {
    for (;;) {
        std::string fault;
        auto opened = open_file_below(folder_, name_, fault, FileUse::update);
        if (!opened)
            throw Error(ErrorKind::output, (folder_ / name_).string() + ": " + fault + " (" +
                                               spelled(Option::no_journal) + " runs without locks)");
        file_ = opened->release();
        held_ = lock_bytes(file_, F_OFD_SETLKW, F_WRLCK, 0, 1);
        struct stat ours {
        }, named{};
        fstat(file_, &ours);
        if (!held_ || (lstat((folder_ / name_).c_str(), &named) == 0 && ours.st_ino == named.st_ino)) return;
        close(file_);
    }
}

namespace {

/// The value of a line of /proc/<process>/status, such as "State"; "" where there is no such process.
std::string status_of(int process, const std::string& name) {
    std::ifstream in("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with(name + ":"))
            return std::string(trimmed(std::string_view(line).substr(name.size() + 2)));
    return "";
}

/// Gone, or on its way: proc(5). A process that was killed keeps its locks for a while.
bool is_ending(int process) {
    constexpr unsigned long long kKilled = 1ull << (SIGKILL - 1);
    const std::string state = status_of(process, "State"), pending = status_of(process, "ShdPnd");
    return state.empty() || state[0] == 'Z' || state[0] == 'X' ||
           (std::strtoull(pending.c_str(), nullptr, 16) & kKilled) != 0;
}

/// The kernel ends a worker with the run that started it.
bool is_ending_here(const json& holder) {
    if (holder.value("host", "") != host_name()) return false;
    const int process = holder.value("pid", 0), parent = holder.value("parent", 0);
    if (is_ending(process)) return true;
    return holder.value("command", "").starts_with("/proc/self/exe ") &&
           (is_ending(parent) || status_of(process, "PPid") != std::to_string(parent));
}

}  // namespace

/// Waits for holders that have been killed.
bool RunLock::lock_frames(int first, int last) {
    constexpr int kTries = 500;  // ten seconds: a process may have much memory to free
    const off_t count = off_t(last) - first + 1;
    for (int i = 0;; ++i) {
        if (lock_bytes(file_, F_OFD_SETLK, F_WRLCK, kFirstFrame + first, count)) return true;
        held_ = errno == EAGAIN || errno == EACCES;
        bool waits = false;
        if (held_)
            kept_lines(read_all(file_), [&](const std::string&, const json& holder) {
                waits |= overlaps(holder, {{first, last}}) && is_ending_here(holder);
                return false;
            });
        if (!waits || i == kTries) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
}

bool RunLock::take(const std::vector<int>& frames) {
    for (const Range& range : ranges_of(frames)) {
        if (lock_frames(range.first, range.last)) continue;
        if (!held_) return false;  // no locks here
        std::string who = "another run";
        kept_lines(read_all(file_), [&](const std::string&, const json& holder) {
            if (!overlaps(holder, {range})) return true;
            who = "process " + std::to_string(holder.value("pid", 0)) + " on host " +
                  holder.value("host", "") + " since " + holder.value("since", "") + ", frames " +
                  holder.value("frames", "") + ": " + holder.value("command", "");
            return false;
        });
        close(file_);
        throw Error(ErrorKind::output, pattern_ + ": another run is writing frames " + text_of({range}) +
                                           " of this output (" + who +
                                           "); wait for it or end it, or write to another output");
    }
    return true;
}

void RunLock::add_holder(const std::vector<int>& frames, const std::string& command) {
    const std::vector<Range> ranges = ranges_of(frames);
    json list = json::array();
    for (const Range& range : ranges) list.push_back({range.first, range.last});
    const json holder = {{"pid", getpid()},     {"parent", getppid()},       {"host", host_name()},
                         {"since", now_text()}, {"frames", text_of(ranges)}, {"ranges", list},
                         {"command", command}};
    holder_ = holder.dump(-1, ' ', false, json::error_handler_t::replace);
    // Lines of frames that are this run's now are of runs that were killed.
    replace_all(file_,
                kept_lines(read_all(file_),
                           [&](const std::string&, const json& other) { return overlaps(other, ranges); }) +
                    holder_ + "\n");
    lock_bytes(file_, F_OFD_SETLK, F_UNLCK, 0, 1);
}

RunLock::~RunLock() {
    if (held_ && lock_bytes(file_, F_OFD_SETLKW, F_WRLCK, 0, 1)) {
        const std::string others = kept_lines(
            read_all(file_), [&](const std::string& line, const json&) { return line == holder_; });
        replace_all(file_, others);
        if (others.empty()) unlink((folder_ / name_).c_str());
    }
    close(file_);
    rmdir((folder_ / name_).parent_path().c_str());  // only where nothing else is in it
}

}  // namespace aftershade
