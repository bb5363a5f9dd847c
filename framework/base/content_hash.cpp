#include "framework/base/content_hash.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

// The functions in this source, compiled for speed, whatever the rest of the module is compiled for.
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <vector>

#include "framework/base/error.h"

namespace aftershade {

namespace {

std::string hexadecimal(const XXH128_hash_t& hash) {
    XXH128_canonical_t bytes;
    XXH128_canonicalFromHash(&bytes, hash);
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : bytes.digest) {
        text += kDigits[byte >> 4];
        text += kDigits[byte & 15];
    }
    return text;
}

}  // namespace

std::string content_hash(std::string_view bytes) {
    return hexadecimal(XXH3_128bits(bytes.data(), bytes.size()));
}

FileContent file_content(const std::filesystem::path& path) {
    const auto fail = [&] {
        return Error(ErrorKind::capture, path.string() + ": cannot be read: " + std::strerror(errno));
    };
    // A FIFO would be waited for, a device never end.
    const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0) throw fail();
    struct stat found {};
    if (fstat(file, &found) != 0 || !S_ISREG(found.st_mode)) {
        close(file);
        throw Error(ErrorKind::capture,
                    path.string() + ": is not a regular file (a pipe, socket or device cannot be read)");
    }
    const std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state(XXH3_createState(),
                                                                                XXH3_freeState);
    XXH3_128bits_reset(state.get());
    // As large as what a core's second-level cache holds: the hash reads what the system has just copied.
    std::vector<char> buffer(std::size_t(256) * 1024);
    FileContent content;
    ssize_t count = 0;
    while ((count = read(file, buffer.data(), buffer.size())) > 0) {
        XXH3_128bits_update(state.get(), buffer.data(), std::size_t(count));
        content.bytes += std::uint64_t(count);
    }
    const int failure = errno;
    close(file);
    errno = failure;
    if (count < 0) throw fail();
    content.hash = hexadecimal(XXH3_128bits_digest(state.get()));
    return content;
}

}  // namespace aftershade
