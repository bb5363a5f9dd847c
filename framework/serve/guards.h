// Who may ask this server for anything: the page that it serves, and nothing else.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "framework/serve/http_message.h"

namespace aftershade::serve {

/// 32 hexadecimal digits of the system's random numbers. Throws Error(ErrorKind::usage) where it has none.
std::string random_token();

/// Without an early end at the first difference, whose time would give the token away digit by digit.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// Refuses a request for another host (421), which is what a name has that was made to lead here; one that a
/// page of another origin sends (403); one of /api/ without the token (401).
std::optional<Response> refusal(const Request& request, int port, std::string_view token);

}  // namespace aftershade::serve
