#include "framework/base/cache_room.h"

#include <algorithm>
#include <system_error>
#include <vector>

namespace aftershade {

namespace fs = std::filesystem;

void make_cache_room(const fs::path& folder, std::uint64_t max_bytes, bool (*is_of_cache)(const fs::path&)) {
    struct Kept {
        fs::file_time_type written;
        std::uintmax_t bytes;
        fs::path path;
    };
    std::vector<Kept> files;
    std::uintmax_t sum = 0;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end;
         entry.increment(failure)) {
        if (!is_of_cache(entry->path())) continue;
        std::error_code gone;
        const Kept kept{entry->last_write_time(gone), entry->file_size(gone), entry->path()};
        if (gone) continue;
        sum += kept.bytes;
        files.push_back(kept);
    }
    if (sum <= max_bytes) return;
    std::ranges::sort(files, {}, &Kept::written);
    for (const Kept& kept : files) {
        if (sum <= max_bytes) return;
        fs::remove(kept.path, failure);
        sum -= kept.bytes;
    }
}

}  // namespace aftershade
