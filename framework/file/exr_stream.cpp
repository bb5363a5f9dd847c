#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <OpenEXR/Iex.h>

#include <cerrno>
#include <cstring>

#include "framework/base/lfs_pointer.h"
#include "framework/file/exr_internal.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace exr {

OpenFile open_exr(const fs::path& path) {
    // Not blocking: opening a pipe that nobody writes to would wait for ever.
    const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) fail(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
    return OpenFile(path, descriptor);
}

FileStream::FileStream(OpenFile file) : Imf::IStream(file.path().c_str()) {
    const fs::path& path = file.path();
    const int descriptor = file.descriptor();
    file_.reset(fdopen(descriptor, "rb"));
    if (file_) file.release();
    struct stat status = {};
    if (!file_ || fstat(descriptor, &status) != 0)
        fail(path, fmt::format("cannot be opened: {}", std::strerror(errno)));
    if (S_ISDIR(status.st_mode)) fail(path, "is a folder, not an OpenEXR file");
    if (!S_ISREG(status.st_mode))
        fail(path, "is not a regular file (a pipe, socket or device cannot be read)");
    size_ = std::uint64_t(status.st_size);
    if (size_ == 0) fail(path, "the file is empty");
    if (const std::string fault = lfs_fault(path); !fault.empty()) fail(path, fault);
}

bool FileStream::read(char bytes[], int count) {
    const std::size_t got = std::fread(bytes, 1, std::size_t(count), file_.get());
    position_ += got;
    if (got != std::size_t(count)) {
        if (std::ferror(file_.get()))
            throw Iex::IoExc(fmt::format("cannot be read: {}", std::strerror(errno)));
        throw Iex::InputExc(fmt::format("the file ends at byte {}, where more is expected", size_));
    }
    return position_ < size_;
}

void FileStream::seekg(std::uint64_t position) {
    if (position > size_) {
        throw Iex::InputExc(
            fmt::format("the file ends at byte {}, pixels are expected at {}", size_, position));
    }
    if (position == position_) return;
    if (fseeko(file_.get(), off_t(position), SEEK_SET) != 0) {
        throw Iex::IoExc(fmt::format("cannot be read: {}", std::strerror(errno)));
    }
    position_ = position;
}

void FileStream::clear() {
    std::clearerr(file_.get());
}

void FileStream::read_at(std::uint64_t offset, std::span<char> bytes) {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t got =
            pread(fileno(file_.get()), bytes.data() + done, bytes.size() - done, off_t(offset + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) throw Iex::IoExc(fmt::format("cannot be read: {}", std::strerror(errno)));
        if (got == 0)
            throw Iex::InputExc(fmt::format("the file ends at byte {}, where more is expected", size_));
        done += std::size_t(got);
    }
}

bool StreamView::read(char bytes[], int count) {
    file_.read_at(position_, {bytes, std::size_t(count)});
    position_ += std::uint64_t(count);
    return position_ < file_.byte_count();
}

}  // namespace exr

}  // namespace aftershade
