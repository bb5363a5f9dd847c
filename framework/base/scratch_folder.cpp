#include "framework/base/scratch_folder.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>
#include <system_error>

#include "framework/base/error.h"

namespace aftershade {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder() {
    std::string name =
        (fs::temp_directory_path() / "aftershade-XXXXXX").string();  // as mkdtemp(3) fills it in
    if (!mkdtemp(name.data()))
        throw Error(ErrorKind::output, "cannot make a work folder " + name + ": " + std::strerror(errno) +
                                           " (TMPDIR names another place)");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

}  // namespace aftershade
