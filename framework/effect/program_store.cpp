#include "framework/effect/program_store.h"

#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/cache_room.h"
#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

constexpr const char* kExtension = ".program";
constexpr std::string_view kMagic = "aftershade program 2\n";
/// More than any program of ours; what is larger is no program.
constexpr std::uintmax_t kMaxFileBytes = std::uintmax_t(64) << 20;

void append(std::string& bytes, std::uint64_t value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    bytes.append(raw, sizeof raw);
}

/// Takes values off the front; `sound` turns false where too little is left.
struct Taker {
    std::string_view rest;
    bool sound = true;

    std::string_view bytes(std::uint64_t count) {
        if (count > rest.size()) sound = false;
        if (!sound) return {};
        const std::string_view taken = rest.substr(0, std::size_t(count));
        rest.remove_prefix(std::size_t(count));
        return taken;
    }
    std::uint64_t number() {
        std::uint64_t value = 0;
        const std::string_view raw = bytes(sizeof value);
        if (sound) std::memcpy(&value, raw.data(), sizeof value);
        return value;
    }
};

std::string file_text(const std::string& key, const gpu::ProgramBinary& binary) {
    std::string text(kMagic);
    append(text, key.size());
    text += key;
    append(text, binary.format);
    append(text, binary.bytes.size());
    text.append(reinterpret_cast<const char*>(binary.bytes.data()), binary.bytes.size());
    return text + content_hash(text);
}

const char* environment(const char* name) {
    const char* value = std::getenv(name);
    return value && *value ? value : nullptr;
}

}  // namespace

ProgramStore ProgramStore::from_environment() {
    if (const char* folder = environment("AFTERSHADE_CACHE"))
        return std::strcmp(folder, "off") == 0 ? ProgramStore() : ProgramStore(fs::path(folder));
    // The XDG base directory specification has relative paths ignored.
    if (const char* cache = environment("XDG_CACHE_HOME"); cache && fs::path(cache).is_absolute())
        return {fs::path(cache), "aftershade"};
    if (const char* home = environment("HOME")) return {fs::path(home) / ".cache", "aftershade"};
    return {};
}

fs::path ProgramStore::file_of(const std::string& key) const {
    return folder_ / (content_hash(key) + kExtension);
}

std::optional<gpu::ProgramBinary> ProgramStore::load(const std::string& key) const {
    if (!is_on()) return std::nullopt;
    std::string fault;
    const std::string text = read_file_below(named_, below_ / file_of(key).filename(), kMaxFileBytes, fault);
    Taker taker{text};
    if (taker.bytes(kMagic.size()) != kMagic || taker.bytes(taker.number()) != key) return std::nullopt;
    gpu::ProgramBinary binary;
    binary.format = static_cast<unsigned int>(taker.number());
    const std::string_view bytes = taker.bytes(taker.number());
    const std::string_view hashed = std::string_view(text).substr(0, text.size() - taker.rest.size());
    const std::string hash = content_hash(hashed);
    if (taker.bytes(hash.size()) != hash || !taker.sound || !taker.rest.empty()) return std::nullopt;
    binary.bytes.resize(bytes.size());
    std::memcpy(binary.bytes.data(), bytes.data(), bytes.size());
    return binary;
}

void ProgramStore::make_folder() const {
    std::error_code failure;
    fs::create_directories(named_, failure);
    make_folder_below(named_, below_);
}

std::string ProgramStore::fault() const {
    try {
        make_folder();
    } catch (const Error& error) {
        return error.what();
    }
    if (access(folder_.c_str(), W_OK | X_OK) == 0) return "";
    return folder_.string() + ": cannot be written: " + std::strerror(errno) +
           " (choose another folder with AFTERSHADE_CACHE)";
}

void ProgramStore::make_room() const {
    make_cache_room(folder_, max_bytes_, [](const fs::path& file) { return file.extension() == kExtension; });
}

void ProgramStore::save(const std::string& key, const gpu::ProgramBinary& binary) const {
    if (!is_on()) return;
    try {
        make_folder();
        AtomicFile file(path_below(named_, below_ / file_of(key).filename()));
        const std::string text = file_text(key, binary);
        std::ofstream out(file.temporary_path(), std::ios::binary);
        out.write(text.data(), static_cast<std::streamsize>(text.size()));
        out.close();
        // A file without its contents counts as absent, and a disk may take long to flush each.
        if (out) file.commit(AtomicFile::Flush::no);
        make_room();
    } catch (const Error&) {
        // A full disk or a folder of somebody else's costs time only: the program is compiled again.
    }
}

}  // namespace aftershade
