// The files of the page, read once: no request names a path.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// By the path of the request: "/page.js". Only regular files of `folder` itself with the extension of a
/// page's part; "/" is index.html. Throws Error(ErrorKind::usage) where the folder has no index.html.
std::map<std::string, Response> read_page_files(const std::filesystem::path& folder);

}  // namespace aftershade::serve
