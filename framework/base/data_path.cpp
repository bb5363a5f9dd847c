#include "framework/base/data_path.h"

#include <cstdlib>
#include <string>
#include <vector>

#include "framework/base/error.h"

namespace aftershade {

namespace fs = std::filesystem;

namespace {

thread_local const fs::path* scoped_folder = nullptr;

}  // namespace

DataPathScope::DataPathScope(const fs::path& folder) : before_(scoped_folder) {
    scoped_folder = &folder;
}

DataPathScope::~DataPathScope() {
    scoped_folder = before_;
}

fs::path data_path() {
    if (scoped_folder) return *scoped_folder;
    std::vector<fs::path> places;
    if (const char* chosen = std::getenv("AFTERSHADE_DATA"); chosen && *chosen) {
        places.emplace_back(chosen);
    } else {
        std::error_code unreadable;
        const fs::path executable = fs::read_symlink("/proc/self/exe", unreadable);
        places.emplace_back(AFTERSHADE_SOURCE_DIR);
        places.push_back(executable.parent_path().parent_path() / "share" / "aftershade");
        // An installed executable must not pick up a source tree that happens to lie on the same machine.
        if (!executable.string().starts_with(AFTERSHADE_BINARY_DIR "/")) std::swap(places[0], places[1]);
    }
    std::string tried;
    for (const fs::path& place : places) {
        if (fs::is_directory(place / "effects")) return place;
        tried += (tried.empty() ? "" : ", ") + place.string();
    }
    throw Error(ErrorKind::usage,
                "no folder 'effects' in " + tried + " (set AFTERSHADE_DATA to the folder that holds it)");
}

}  // namespace aftershade
