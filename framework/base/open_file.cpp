#include "framework/base/open_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <utility>

namespace aftershade {

OpenFile::OpenFile(std::filesystem::path path, int descriptor)
    : path_(std::move(path)), descriptor_(descriptor) {}

OpenFile::~OpenFile() {
    if (descriptor_ >= 0) close(descriptor_);
}

OpenFile::OpenFile(OpenFile&& other) noexcept
    : path_(std::move(other.path_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

OpenFile& OpenFile::operator=(OpenFile&& other) noexcept {
    std::swap(path_, other.path_);
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

std::uint64_t OpenFile::bytes() const {
    struct stat status = {};
    return fstat(descriptor_, &status) == 0 ? std::uint64_t(status.st_size) : 0;
}

int OpenFile::release() {
    return std::exchange(descriptor_, -1);
}

}  // namespace aftershade
