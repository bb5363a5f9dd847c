// A page and its server's answers on 127.0.0.1, behind a token.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <string>

#include "framework/serve/connections.h"
#include "framework/serve/http_message.h"

namespace aftershade::serve {

struct ServedPage {
    std::map<std::string, Response> files;                  ///< by the path of the request, for everyone
    std::function<void(const std::string& address)> ready;  ///< once it answers; with the token
    std::function<void()> opened;  ///< a page with the token asked for the first time; on any thread
    /// Answers at an address below /api/. [called on several threads]
    std::function<void(const Request& request, const Connections::Reply& reply)> answer;
};

/// Until `stop`.
void serve_page(Connections& connections, const ServedPage& page, const std::atomic<bool>& stop);

}  // namespace aftershade::serve
