#include "framework/golden/golden_store.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <iterator>
#include <string_view>
#include <vector>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/base/scratch_folder.h"
#include "framework/base/sha256.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/batch/worker.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kRclone = "rclone:";

bool is_url(std::string_view store) {
    return store.starts_with("http://") || store.starts_with("https://");
}

bool has_only(std::string_view text, std::string_view signs) {
    return std::ranges::all_of(text, [&](unsigned char c) {
        return (c < 0x80 && std::isalnum(c)) || signs.find(char(c)) != signs.npos;
    });
}

/// Neither a user's name, nor a query, which would end before the image's name.
bool is_address(std::string_view rest) {
    const std::string_view host = rest.substr(0, rest.find('/'));
    return !host.empty() && has_only(host, ".-:[]_") && has_only(rest.substr(host.size()), "/.-_~%+:");
}

/// rclone reads ":sftp,ssh=COMMAND:" as a remote that runs a command: only remotes of the user's rclone.conf.
bool is_remote(std::string_view text) {
    const std::string_view name = text.substr(0, text.find(':'));
    return name.size() < text.size() && !name.empty() && name.front() != '-' && has_only(name, "_-") &&
           has_only(text.substr(name.size() + 1), "/.-_+ ");
}

/// A value of a configuration file of curl.
std::string config_text(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') result += '\\';
        result += c;
    }
    return result + "\"";
}

/// The token of the environment belongs to the addresses that the user named with it, not to any that a
/// suite names.
std::string token_line(const std::string& url) {
    const char* const token = std::getenv("AFTERSHADE_STORE_TOKEN");
    const char* const owner = std::getenv("AFTERSHADE_STORE_TOKEN_URL");
    if (!token || !*token || !owner || !*owner) return "";
    std::string prefix = owner;
    if (!prefix.ends_with('/')) prefix += '/';
    if (!(url + "/").starts_with(prefix) || printable(token) != token) return "";
    return "header = " + config_text("Authorization: Bearer " + std::string(token)) + "\n";
}

std::string curl_options(const std::string& url, double timeout_s) {
    std::string text =
        "silent\ngloboff\nfail\nparallel\nparallel-max = 8\nnetrc-optional\nproto = \"=http,https\"\n"
        "proto-redir = \"=http,https\"\nmax-redirs = 5\nconnect-timeout = 15\nspeed-limit = 1000\n"
        "speed-time = 30\nretry = 2\nretry-delay = 1\n"
        "write-out = \"%{urlnum} %{exitcode} %{errormsg}\\n\"\n";
    // A server that does not answer "100 Continue" would delay each image by a second.
    text += "header = \"Expect:\"\n";
    text += fmt::format("max-filesize = {}\nmax-time = {:.3f}\n", kMaxStoredBytes, timeout_s);
    return text + token_line(url);
}

/// Programs print addresses of their own settings, such as those of rclone.conf.
std::string without_passwords(std::string text) {
    for (std::size_t at = 0; (at = text.find("://", at)) != text.npos;) {
        at += 3;
        const std::size_t end = std::min(text.find_first_of("/ \"'", at), text.size());
        const std::size_t user = text.substr(0, end).rfind('@');
        if (user != text.npos && user >= at) text.erase(at, user + 1 - at);
    }
    return text;
}

constexpr const char* kAbsent = "has no such image";

/// What helps where a program or this one gave that fault.
const char* remedy_of(const std::string& fault) {
    const auto has = [&](const char* words) { return fault.find(words) != fault.npos; };
    if (fault == kAbsent || has("SHA-256") || has("error: 404"))
        return "put it there again, or remove its sidecar and approve a new one";
    if (has("401") || has("403"))
        return "check ~/.netrc, rclone.conf, or AFTERSHADE_STORE_TOKEN with AFTERSHADE_STORE_TOKEN_URL";
    if (has("certificate"))
        return "check its certificate, or set CURL_CA_BUNDLE to the file of its authority";
    if (has("timed out") || has("time limit") || has("too slow"))
        return "check the store, or allow more time with --timeout";
    return "check the address in the suite's 'store', and that it can be reached from here";
}

/// Whether curl would wait as long for each other image of the store.
bool is_of_all_images(const std::string& fault) {
    const auto has = [&](const char* words) { return fault.find(words) != fault.npos; };
    return has("onnect to") || has("resolve host") || has("Resolving timed out") ||
           has("onnection timed out") || has("connection timeout") || has("certificate") || has("with 0 ") ||
           has("too slow");
}

/// Runs it with each line that it prints, and returns why it failed; "" where it did not.
std::string fault_of_program(const std::string& program, const std::string& package, WorkerCommand command,
                             const WorkerListener& listener, const std::atomic<bool>& interrupt) {
    command.arguments.insert(command.arguments.begin(), program_on_path(program));
    if (command.arguments[0].empty())
        return fmt::format("needs {} on PATH (Debian package {})", program, package);
    command.limits.file_bytes = kMaxStoredBytes;
    std::string last;
    WorkerListener with_errors = listener;
    with_errors.on_stderr = [&](std::string_view line) {
        if (!trimmed(line).empty()) last = without_passwords(printable(trimmed(line)));
    };
    const WorkerResult result = run_worker(command, with_errors, &interrupt);
    if (result.succeeded()) return "";
    if (result.end != WorkerEnd::exited)
        return program + describe(result).substr(std::string_view("the worker").size());
    return fmt::format("{} ended with code {}{}{}", program, result.exit_code, last.empty() ? "" : ": ",
                       last);
}

}  // namespace

bool is_store(const std::string& text) {
    if (is_url(text)) return is_address(std::string_view(text).substr(text.find("//") + 2));
    if (text.starts_with(kRclone)) return is_remote(std::string_view(text).substr(kRclone.size()));
    return !text.empty() && text.front() != '-' && text.find(':') == text.npos;
}

std::string stored_name(const std::string& digest) {
    return digest + ".exr";
}

std::string sha256_of_file(const fs::path& file) {
    std::string fault;
    const std::string bytes = read_regular_file(file, kMaxStoredBytes, fault);
    return fault.empty() ? sha256(bytes) : "";
}

std::map<std::string, std::string> GoldenStore::fetch(const std::set<std::string>& digests,
                                                      const fs::path& folder,
                                                      const std::atomic<bool>& interrupt) const {
    if (digests.empty()) return {};
    Faults faults = transfer(Direction::fetch, digests, folder, interrupt);
    for (const std::string& digest : digests) {
        const std::string found = sha256_of_file(folder / stored_name(digest));
        std::string& fault = faults[digest];
        if (fault.empty() && found.empty()) fault = kAbsent;
        else if (fault.empty() && found != digest) fault = "its bytes have the SHA-256 " + found;
        if (fault.empty()) faults.erase(digest);
        else fault = fmt::format("{}: {}: {} ({})", store_, stored_name(digest), fault, remedy_of(fault));
    }
    return faults;
}

std::set<std::string> GoldenStore::lacking(const std::set<std::string>& digests,
                                           const std::atomic<bool>& interrupt) const {
    std::set<std::string> absent;
    if (digests.empty()) return absent;
    for (const auto& [digest, fault] : transfer(Direction::find, digests, {}, interrupt))
        absent.insert(digest);
    return absent;
}

void GoldenStore::push(const std::set<std::string>& digests, const fs::path& folder,
                       const std::atomic<bool>& interrupt) const {
    if (digests.empty()) return;
    const Faults faults = transfer(Direction::push, digests, folder, interrupt);
    for (const auto& [digest, fault] : faults)
        throw Error(ErrorKind::output,
                    fmt::format("{}: {}: {} (nothing was approved)", store_, stored_name(digest), fault));
    const ScratchFolder again;
    for (const auto& [digest, fault] : fetch(digests, again.path(), interrupt))
        throw Error(ErrorKind::output, fault + " after it was written there (nothing was approved)");
}

GoldenStore::Faults GoldenStore::transfer(Direction direction, const std::set<std::string>& digests,
                                          const fs::path& folder, const std::atomic<bool>& interrupt) const {
    if (store_.starts_with(kRclone)) return by_rclone(direction, digests, folder, interrupt);
    if (!is_url(store_)) return by_folder(direction, digests, folder);
    // Where no server answers, one image is waited for, not hundreds.
    const auto second = std::next(digests.begin());
    Faults faults = by_curl(direction, {digests.begin(), second}, folder, interrupt);
    if (!faults.empty() && is_of_all_images(faults.begin()->second)) {
        const auto& [first, fault] = *faults.begin();
        const std::string of_others = "not tried, since " + stored_name(first) + " failed: " + fault;
        for (const std::string& digest : digests) faults.try_emplace(digest, of_others);
    } else if (second != digests.end()) {
        faults.merge(by_curl(direction, {second, digests.end()}, folder, interrupt));
    }
    return faults;
}

GoldenStore::Faults GoldenStore::by_folder(Direction direction, const std::set<std::string>& digests,
                                           const fs::path& folder) const {
    const fs::path there = suite_folder_ / store_;
    Faults faults;
    const std::string why = out_of_bounds(there, suite_folder_);
    for (const std::string& digest : digests) {
        const fs::path name = stored_name(digest);
        std::string fault = why;
        if (fault.empty() && direction != Direction::push) {
            const std::string bytes = read_file_below(there, name, kMaxStoredBytes, fault);
            if (fault.empty() && direction == Direction::fetch) write_text_file(folder / name, bytes);
        } else if (fault.empty()) {
            const std::string bytes = read_text_file(folder / name, ErrorKind::output, kMaxStoredBytes);
            std::error_code failure;
            fs::create_directories(there, failure);
            if (failure)
                fault = "the store's folder cannot be made: " + failure.message() +
                        " (remove what is in its place, or name another 'store')";
            else write_text_file(path_below(there, name), bytes);
        }
        if (!fault.empty()) faults[digest] = fault;
    }
    return faults;
}

GoldenStore::Faults GoldenStore::by_curl(Direction direction, const std::set<std::string>& digests,
                                         const fs::path& folder, const std::atomic<bool>& interrupt) const {
    const std::string url = store_.ends_with('/') ? store_.substr(0, store_.size() - 1) : store_;
    const std::vector<std::string> in_order(digests.begin(), digests.end());
    std::string config = curl_options(url, std::chrono::duration<double>(timeout_).count());
    // What a token is sent with stays where it was sent to.
    if (direction != Direction::push) config += "location\n";
    if (direction == Direction::find) config += "head\n";
    for (const std::string& digest : in_order) {
        const std::string file =
            direction == Direction::find ? "/dev/null" : (folder / stored_name(digest)).string();
        config += (direction == Direction::push ? "upload-file = " : "output = ") + config_text(file) + "\n";
        config += "url = " + config_text(url + "/" + stored_name(digest)) + "\n";
    }
    const ScratchFolder scratch;  // that no one else can read: the token is in the file
    const fs::path file = scratch.path() / "curl.conf";
    write_text_file(file, config);
    Faults faults;
    std::set<std::string> seen;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) {
        const std::vector<std::string_view> words = split(line, ' ');
        const std::size_t index = std::strtoul(std::string(words[0]).c_str(), nullptr, 10);
        if (words.size() < 2 || index >= in_order.size()) return;
        seen.insert(in_order[index]);
        const std::size_t message = words[0].size() + words[1].size() + 2;
        if (words[1] == "0") faults.erase(in_order[index]);
        else faults[in_order[index]] = printable(line.substr(std::min(message, line.size())));
    };
    WorkerCommand command;
    // -q comes first: the user's ~/.curlrc does not apply.
    command.arguments = {"-q", "-K", file.string()};
    const std::string fault = fault_of_program("curl", "curl", command, listener, interrupt);
    for (const std::string& digest : in_order)
        if (!fault.empty() && !seen.contains(digest)) faults[digest] = fault;
    return faults;
}

GoldenStore::Faults GoldenStore::by_rclone(Direction direction, const std::set<std::string>& digests,
                                           const fs::path& folder, const std::atomic<bool>& interrupt) const {
    const std::string remote = store_.substr(kRclone.size());
    const ScratchFolder scratch;
    const fs::path list = scratch.path() / "names";
    std::string names;
    for (const std::string& digest : digests) names += stored_name(digest) + "\n";
    write_text_file(list, names);
    // rclone's --timeout limits silence, as curl's speed-time does.
    const auto silence = std::min<std::chrono::duration<double>>(timeout_, std::chrono::seconds(30));
    const std::string timeout = fmt::format("{:.3f}s", silence.count());
    WorkerCommand command;
    command.arguments = {direction == Direction::find ? "lsf" : "copy",
                         "--files-from-raw",
                         list.string(),
                         "--no-traverse",
                         "--retries",
                         "2",
                         "--low-level-retries",
                         "2",
                         "--contimeout",
                         "15s",
                         "--timeout",
                         timeout,
                         "--"};
    if (direction == Direction::push) command.arguments.push_back(folder.string());
    command.arguments.push_back(remote);
    if (direction == Direction::fetch) command.arguments.push_back(folder.string());
    command.limits.wall_time = timeout_ * int(digests.size() / 4 + 2);
    std::set<std::string> listed;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { listed.emplace(trimmed(line)); };
    const std::string fault = fault_of_program("rclone", "rclone", command, listener, interrupt);
    const auto is_there = [&](const fs::path& name) {
        if (direction == Direction::find) return listed.contains(name.string());
        return fault.empty() || (direction == Direction::fetch && fs::exists(folder / name));
    };
    Faults faults;
    for (const std::string& digest : digests)
        if (!is_there(stored_name(digest))) faults[digest] = fault;
    return faults;
}

}  // namespace aftershade
