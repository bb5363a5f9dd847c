// A temporary file that becomes the output; shared by the writers of this folder.
#pragma once

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>

namespace aftershade {

/// Every failure is Error(ErrorKind::output) that begins with the final path.
class OutputStream {
public:
    explicit OutputStream(const std::filesystem::path& path) : path_(path), atomic_(path) {
        namespace fs = std::filesystem;
        std::error_code ignored;
        const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
        if (!path.has_filename() || fs::is_directory(path, ignored))
            fail("is a folder, a file name is expected");
        if (!fs::is_directory(folder, ignored))
            fail(fmt::format("there is no folder '{}' (create it first)", folder.string()));
        file_.reset(std::fopen(atomic_.temporary_path().c_str(), "wbe"));
        if (!file_) fail_with_reason("cannot be created");
    }

    void write(const void* bytes, std::size_t count) {
        if (std::fwrite(bytes, 1, count, file_.get()) != count) fail_with_reason("cannot be written");
    }

    void seek(std::uint64_t position) {
        if (fseeko(file_.get(), off_t(position), SEEK_SET) != 0) fail_with_reason("cannot be written");
    }

    /// Closes, flushes to disk and renames.
    void commit() {
        std::FILE* file = file_.release();
        const bool sound = std::ferror(file) == 0;
        if (std::fclose(file) != 0 || !sound) fail_with_reason("cannot be written");
        atomic_.commit();
    }

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::output, path_.string() + ": " + what);
    }

private:
    struct Closer {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };

    [[noreturn]] void fail_with_reason(const char* what) const {
        fail(fmt::format("{}: {}", what, std::strerror(errno)));
    }

    std::filesystem::path path_;
    AtomicFile atomic_;
    std::unique_ptr<std::FILE, Closer> file_;
};

}  // namespace aftershade
