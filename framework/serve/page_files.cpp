#include "framework/serve/page_files.h"

#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"

namespace aftershade::serve {

namespace fs = std::filesystem;

std::map<std::string, Response> read_page_files(const fs::path& folder) {
    static const std::map<std::string, std::string> kTypes = {{".html", "text/html; charset=utf-8"},
                                                              {".js", "text/javascript; charset=utf-8"},
                                                              {".css", "text/css; charset=utf-8"},
                                                              {".svg", "image/svg+xml"},
                                                              {".png", "image/png"}};
    std::map<std::string, Response> files;
    std::error_code failure;
    for (const auto& entry : fs::directory_iterator(folder, failure)) {
        const auto type = kTypes.find(entry.path().extension().string());
        if (type == kTypes.end() || !entry.is_regular_file(failure)) continue;
        files["/" + entry.path().filename().string()] = {200, type->second,
                                                         read_text_file(entry.path(), ErrorKind::usage)};
    }
    const auto index = files.find("/index.html");
    if (index == files.end())
        throw Error(ErrorKind::usage, (folder / "index.html").string() +
                                          ": the page is not there; install it, or "
                                          "set AFTERSHADE_DATA to the folder that has page/");
    files["/"] = index->second;
    return files;
}

}  // namespace aftershade::serve
