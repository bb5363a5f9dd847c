// A page, its files and its server's answers on 127.0.0.1, behind a token: who may ask this server.
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

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

/// By the path of the request: "/page.js". Only regular files of `folder` itself with the extension of a
/// page's part; "/" is index.html. Throws Error(ErrorKind::usage) where the folder has no index.html.
std::map<std::string, Response> read_page_files(const std::filesystem::path& folder);

/// 32 hexadecimal digits of the system's random numbers. Throws Error(ErrorKind::usage) where it has none.
std::string random_token();

/// Without an early end at the first difference, whose time would give the token away digit by digit.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Refuses a request for another host (421), which is what a name has that was made to lead here; one that a
/// page of another origin sends (403); one of /api/ without the token (401).
std::optional<Response> refusal(const Request& request, int port, std::string_view token);

}  // namespace aftershade::serve
