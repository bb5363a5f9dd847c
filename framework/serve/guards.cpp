#include "framework/serve/guards.h"

#include <sys/random.h>

#include <array>

#include "framework/base/error.h"

namespace aftershade::serve {

std::string random_token() {
    std::array<unsigned char, 16> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size()))
        throw Error(ErrorKind::usage, "the system gives no random numbers for the page's token");
    constexpr std::string_view kDigits = "0123456789abcdef";
    std::string token;
    for (const unsigned char byte : bytes) {
        token += kDigits[byte >> 4];
        token += kDigits[byte & 15];
    }
    return token;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    unsigned difference = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        difference |= unsigned(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
    return difference == 0;
}

std::optional<Response> refusal(const Request& request, int port, std::string_view token) {
    const std::string numbers = "127.0.0.1:" + std::to_string(port);
    const std::string name = "localhost:" + std::to_string(port);
    const std::string& host = request.header("host");
    if (host != numbers && host != name)
        return error_response(421, "this server answers for " + numbers + " alone");
    const std::string& origin = request.header("origin");
    if (!origin.empty() && origin != "http://" + host)
        return error_response(403, "this server answers to its own page alone");
    const std::string& site = request.header("sec-fetch-site");
    if (request.path.starts_with("/api/") && !site.empty() && site != "same-origin" && site != "none")
        return error_response(403, "this server answers to its own page alone");
    if (request.path.starts_with("/api/") &&
        !equal_in_constant_time(request.header("x-aftershade-token"), token))
        return error_response(401,
                              "the token is missing or wrong; open the address that the program printed");
    return std::nullopt;
}

}  // namespace aftershade::serve
