// Requests and answers of HTTP/1.1, as far as one page needs them: a whole request in, a whole answer out.
// Refusal says why a request is not done.
#pragma once

#include <cstddef>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

namespace aftershade::serve {

inline constexpr std::size_t kMaxHeadBytes = 16 * 1024;
inline constexpr std::size_t kMaxHeadLines = 64;  ///< a browser sends 20
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
/// Null for a text that is not JSON, or is nested deeper or has more values than anything that a page sends.
nlohmann::ordered_json shallow_json(const std::string& text);
/// {"error": message}
Response error_response(int status, const std::string& message);
/// Code 500: the message of an Error; of any other exception that it is a fault of the program.
Response fault_response(const std::exception& error);

/// With the headers that every answer has: no sniffing, no store, no framing, and no scripts except the
/// page's own.
std::string response_bytes(const Response& response, bool is_kept = false);

/// nullopt where it is not HTTP/1.1, or where a header stands twice. `head` ends with its empty line; what is
/// behind that counts for nothing.
std::optional<Request> parse_request(std::string_view head);

/// A request that comes in pieces. Each byte is searched for the head's end once, and the head is read once.
class Incoming {
public:
    /// What no more needs to be read of, once there is such a thing.
    std::optional<Response> add(std::string_view bytes);
    bool has_begun() const { return !bytes_.empty(); }
    /// The message without its body, once the head is complete; else nullptr.
    const Request* head() const { return request_ ? &*request_ : nullptr; }
    bool is_whole() const { return request_ && bytes_.size() >= whole_; }
    /// Whether another request may follow on the connection, as browsers ask; not one that came too early.
    bool is_kept() const;
    std::size_t held_bytes() const { return bytes_.empty() ? 0 : bytes_.capacity(); }
    Request take();

private:
    std::string bytes_;
    std::size_t searched_ = 0;  // of bytes_, for the head's end
    std::optional<Request> request_;
    std::size_t whole_ = 0;  // bytes of head and body
    std::size_t head_ = 0;   // bytes of the head
};

/// A status of HTTP: 409 where the page is behind what the program or the disk holds, else mostly 400.
struct Refusal {
    int status = 400;
    std::string message;
};

}  // namespace aftershade::serve
