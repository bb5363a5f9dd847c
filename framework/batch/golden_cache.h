// Copies of stored golden images on this machine, so that another checkout fetches nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

namespace aftershade {

/// Images by their SHA-256, in the folder "goldens" of the cache. Files appear by rename: any number of
/// processes may share it. A cache that cannot be used costs time only: what it could not do is in fault().
class GoldenCache {
public:
    static constexpr std::uint64_t kMaxBytes = std::uint64_t(4) << 30;

    /// "": keeps nothing.
    explicit GoldenCache(std::filesystem::path folder, std::uint64_t max_bytes = kMaxBytes)
        : folder_(std::move(folder)), max_bytes_(max_bytes) {}
    /// In the cache that AFTERSHADE_CACHE names.
    static GoldenCache from_environment();

    /// Bytes with this digest, which count as used now; "" where there are none.
    std::string load(const std::string& digest);
    void save(const std::string& digest, std::string_view bytes);
    /// Removes those that were used longest ago, until the rest has at most `max_bytes`.
    void make_room();
    /// The first reason why something could not be read or written, with the remedy; "" where all could.
    const std::string& fault() const { return fault_; }

private:
    void note(const std::string& fault);

    std::filesystem::path folder_;
    std::uint64_t max_bytes_;
    std::string fault_;
};

}  // namespace aftershade
