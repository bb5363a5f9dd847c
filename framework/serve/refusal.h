// Why a request is not done.
#pragma once

#include <string>

namespace aftershade::serve {

/// A status of HTTP: 409 where the page is behind what the program or the disk holds, else mostly 400.
struct Refusal {
    int status = 400;
    std::string message;
};

}  // namespace aftershade::serve
