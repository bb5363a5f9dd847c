// A file that is open already, for readers that must not look its name up again.
#pragma once

#include <cstdint>
#include <filesystem>

namespace aftershade {

/// A regular file that is open for reading; closes itself. This file is read even if its name changes.
/// [moves only]
class OpenFile {
public:
    /// Takes the descriptor over. `path` is what messages name.
    OpenFile(std::filesystem::path path, int descriptor);
    ~OpenFile();
    OpenFile(OpenFile&& other) noexcept;
    OpenFile& operator=(OpenFile&& other) noexcept;

    const std::filesystem::path& path() const { return path_; }
    int descriptor() const { return descriptor_; }
    /// 0 where the system does not say.
    std::uint64_t bytes() const;
    /// The caller closes the descriptor.
    int release();

private:
    std::filesystem::path path_;
    int descriptor_;
};

}  // namespace aftershade
