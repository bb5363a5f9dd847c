#include "framework/run/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/side_file.h"
#include "framework/run/run_lock.h"

namespace aftershade {

namespace fs = std::filesystem;
using nlohmann::json;

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(JournalFile, path, bytes, modified_ns, hash)

namespace {

struct FileState {
    std::uint64_t bytes = 0;
    std::int64_t modified_ns = 0;
};

std::optional<FileState> state_of(const fs::path& file) {
    struct stat state {};
    if (stat(file.c_str(), &state) != 0) return std::nullopt;
    return FileState{std::uint64_t(state.st_size),
                     std::int64_t(state.st_mtim.tv_sec) * 1'000'000'000 + state.st_mtim.tv_nsec};
}

json json_of(const JournalFrame& frame, const std::string& output) {
    json line = {{"output", output},         {"frame", frame.frame},
                 {"setup", frame.setup},     {"fingerprint", frame.fingerprint.hash},
                 {"seconds", frame.seconds}, {"inputs", frame.fingerprint.inputs},
                 {"files", frame.files}};
    if (!frame.fingerprint.before.empty()) line["before"] = frame.fingerprint.before;
    return line;
}

JournalFrame frame_of(const json& line) {
    JournalFrame frame;
    line.at("frame").get_to(frame.frame);
    line.at("setup").get_to(frame.setup);
    line.at("fingerprint").get_to(frame.fingerprint.hash);
    frame.fingerprint.before = line.value("before", "");
    line.at("inputs").get_to(frame.fingerprint.inputs);
    line.at("seconds").get_to(frame.seconds);
    line.at("files").get_to(frame.files);
    return frame;
}

/// Names of files can be any bytes; what is not UTF-8 is replaced, and such a frame never counts as current.
std::string line_of(const json& document) {
    return document.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}

}  // namespace

Journal::Journal(RunState state) : state_(std::move(state)) {
    constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 30;
    std::string fault;
    std::istringstream in(read_file_below(state_.folder, RunState::kJournal, kMostBytes, fault));
    for (std::string line; std::getline(in, line);) read_line(line);
    if (!fault.empty() && fault != kNoSuchFile)
        throw Error(ErrorKind::output, state_.journal().string() + ": this journal of earlier runs " + fault +
                                           " (make it readable, delete it, or run with " +
                                           spelled(Option::no_journal) + ")");
}

void Journal::read_line(const std::string& line) {
    try {
        const json document = json::parse(line);
        if (document.contains("parts")) {
            setups_[document.at("setup").get<std::string>()] = document.at("parts").get<FingerprintParts>();
        } else if (document.at("output").get<std::string>() == state_.output) {
            JournalFrame frame = frame_of(document);
            frames_.insert_or_assign(frame.frame, std::move(frame));
        }
    } catch (const json::exception&) {
        // A kill or a power cut in the middle of a write: its frame is rendered again.
    }
}

const JournalFrame* Journal::find(int frame) const {
    const auto found = frames_.find(frame);
    return found == frames_.end() ? nullptr : &found->second;
}

const FingerprintParts* Journal::setup(const std::string& hash) const {
    const auto found = setups_.find(hash);
    return found == setups_.end() ? nullptr : &found->second;
}

void Journal::begin(const FingerprintParts& setup) {
    make_state_folder(state_);
    const std::string hash = hash_of_parts(setup);
    if (setups_.contains(hash)) return;
    setup_line_ = line_of({{"setup", hash}, {"parts", setup}});
    setups_[hash] = setup;
}

std::string Journal::relative(const fs::path& file) const {
    const fs::path from = fs::absolute(state_.folder).lexically_normal();
    return fs::absolute(file).lexically_normal().lexically_relative(from / "").string();
}

void Journal::add(int frame, const std::string& setup, const FrameFingerprint& fingerprint,
                  const std::vector<fs::path>& files, double seconds) {
    JournalFrame entry{frame, setup, fingerprint, {}, seconds};
    for (const fs::path& file : files) {
        const auto state = state_of(file);
        const FileContent content = file_content(file);
        entry.files.push_back({relative(file), content.bytes, state ? state->modified_ns : 0, content.hash});
    }
    append(setup_line_ + line_of(json_of(entry, state_.output)));
    setup_line_.clear();
}

/// Not flushed to the disk: after a power cut the lines that are lost cost their frames' time and nothing
/// else, and the outputs themselves were flushed before they got their names.
void Journal::append(std::string line) const {
    const auto fail = [&](const std::string& why) {
        return Error(ErrorKind::output, state_.journal().string() + ": " + why + " (" +
                                            spelled(Option::no_journal) + " runs without it)");
    };
    std::string fault;
    const auto opened = open_file_below(state_.folder, RunState::kJournal, fault, FileUse::append);
    if (!opened) throw fail(fault);
    const int file = opened->descriptor();
    // Network file systems place appended bytes correctly only under a lock; others ignore that it failed.
    lock_whole_file(file);
    // What a killed run left of a line must not swallow this one.
    char last = '\n';
    const off_t end = lseek(file, 0, SEEK_END);
    if (end > 0 && pread(file, &last, 1, end - 1) == 1 && last != '\n') line.insert(0, "\n");
    errno = ENOSPC;  // what a short write means
    const ssize_t written = write(file, line.data(), line.size());
    if (written != ssize_t(line.size()))
        throw fail(std::string("cannot be written: ") + std::strerror(errno));
}

std::string Journal::fault_of_files(const JournalFrame& frame, const std::vector<fs::path>& expected) const {
    for (const fs::path& file : expected) {
        const std::string name = relative(file);
        const auto recorded = std::find_if(frame.files.begin(), frame.files.end(),
                                           [&](const JournalFile& one) { return one.path == name; });
        const auto state = state_of(file);
        if (!state) return "output " + file.filename().string() + " is missing";
        if (recorded == frame.files.end())
            return "output " + file.filename().string() + " was not written by the recorded run";
        const bool same = state->bytes == recorded->bytes && (state->modified_ns == recorded->modified_ns ||
                                                              file_content(file).hash == recorded->hash);
        if (!same) return "output " + file.filename().string() + " changed";
    }
    return "";
}

}  // namespace aftershade
