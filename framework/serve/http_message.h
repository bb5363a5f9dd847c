// Requests and answers of HTTP/1.1, as far as one page needs them: a whole request in, a whole answer out,
// and the connection closes.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace aftershade::serve {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxBodyBytes = 1024 * 1024;

struct Request {
    std::string method;
    std::string path;                            ///< as it was sent, without the query
    std::map<std::string, std::string> query;    ///< decoded
    std::map<std::string, std::string> headers;  ///< names in lower case; no name twice
    std::string body;

    /// "" where there is none.
    const std::string& header(const std::string& name) const;
    std::string parameter(const std::string& name, const std::string& otherwise = "") const;
};

struct Response {
    int status = 200;
    std::string type = "application/json";
    std::string body;
    std::map<std::string, std::string> headers{};
};

Response json_response(const nlohmann::ordered_json& json);
/// {"error": message}
Response error_response(int status, const std::string& message);

/// With the headers that every answer has: no sniffing, no store, no framing, no scripts but the page's own.
std::string response_bytes(const Response& response);

/// What the first bytes of a connection are.
struct Framing {
    bool is_whole = false;
    std::optional<Response> refusal{};  ///< no more needs to be read
};
Framing framing_of(std::string_view bytes);

/// nullopt where it is not HTTP/1.1, or where a header stands twice. `bytes` are whole.
std::optional<Request> parse_request(std::string_view bytes);

}  // namespace aftershade::serve
