#include "framework/serve/http_message.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/base/text.h"

namespace aftershade::serve {

namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

std::optional<int> hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return std::nullopt;
}

/// nullopt where a '%' is not followed by two digits.
std::optional<std::string> decoded(std::string_view text) {
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '+') result += ' ';
        else if (text[i] != '%') result += text[i];
        else {
            if (i + 2 >= text.size()) return std::nullopt;
            const auto high = hex_digit(text[i + 1]), low = hex_digit(text[i + 2]);
            if (!high || !low) return std::nullopt;
            result += char(*high * 16 + *low);
            i += 2;
        }
    }
    return result;
}

bool read_query(std::string_view text, std::map<std::string, std::string>& query) {
    while (!text.empty()) {
        const std::string_view item = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), item.size() + 1));
        const std::size_t equals = std::min(item.find('='), item.size());
        const auto name = decoded(item.substr(0, equals));
        const auto value = decoded(item.substr(std::min(item.size(), equals + 1)));
        if (!name || !value || !query.emplace(*name, *value).second) return false;
    }
    return true;
}

bool is_token(std::string_view text) {
    constexpr std::string_view kOthers = "!#$%&'*+-.^_`|~";
    return !text.empty() && std::ranges::all_of(text, [&](unsigned char c) {
        return std::isalnum(c) || kOthers.find(char(c)) != std::string_view::npos;
    });
}

/// The lines after the first, up to the empty one. nullopt for one that is not "name: value", and for a name
/// that stands twice: what reads the other one would read another request.
std::optional<std::map<std::string, std::string>> read_headers(std::string_view head) {
    std::map<std::string, std::string> headers;
    while (!head.empty()) {
        const std::string_view line = head.substr(0, head.find("\r\n"));
        head.remove_prefix(std::min(head.size(), line.size() + 2));
        const std::size_t colon = line.find(':');
        if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) return std::nullopt;
        const std::string_view value = trimmed(line.substr(colon + 1));
        if (std::ranges::any_of(value, [](unsigned char c) { return c < ' ' && c != '\t'; }))
            return std::nullopt;
        if (!headers.emplace(lower_case(line.substr(0, colon)), value).second) return std::nullopt;
    }
    return headers;
}

std::optional<std::size_t> length_of(const std::map<std::string, std::string>& headers) {
    const auto found = headers.find("content-length");
    if (found == headers.end()) return 0;
    const std::string& text = found->second;
    std::size_t length = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), length);
    if (failure == std::errc::result_out_of_range) return std::string_view::npos;
    if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return length;
}

const char* reason(int status) {
    switch (status) {
        case 200: return "OK";
        case 204: return "No Content";
        case 400: return "Bad Request";
        case 401: return "Unauthorized";
        case 403: return "Forbidden";
        case 404: return "Not Found";
        case 405: return "Method Not Allowed";
        case 408: return "Request Timeout";
        case 409: return "Conflict";
        case 411: return "Length Required";
        case 413: return "Content Too Large";
        case 421: return "Misdirected Request";
        case 431: return "Request Header Fields Too Large";
        case 503: return "Service Unavailable";
        default: return "Internal Server Error";
    }
}

}  // namespace

const std::string& Request::header(const std::string& name) const {
    static const std::string none;
    const auto found = headers.find(name);
    return found == headers.end() ? none : found->second;
}

std::string Request::parameter(const std::string& name, const std::string& otherwise) const {
    const auto found = query.find(name);
    return found == query.end() ? otherwise : found->second;
}

Response json_response(const nlohmann::ordered_json& json) {
    constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
    return {200, "application/json", json.dump(-1, ' ', false, kReplace)};
}

nlohmann::ordered_json shallow_json(const std::string& text) {
    using Json = nlohmann::ordered_json;
    using Event = Json::parse_event_t;
    constexpr int kDeepest = 80;
    constexpr int kMostValues = 100'000;  // 1 MiB of text may be 350,000 lists, which take 40 MiB
    int depth = 0, values = 0;
    const auto is_small = [&](int level, Event event, Json&) {
        depth = std::max(depth, level);
        values += event == Event::value || event == Event::array_start || event == Event::object_start;
        return level <= kDeepest && values <= kMostValues;
    };
    Json json = Json::parse(text, is_small, false);
    return depth > kDeepest || values > kMostValues || json.is_discarded() ? Json() : json;
}

Response error_response(int status, const std::string& message) {
    const nlohmann::json json = {{"error", message}};
    constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
    return {status, "application/json", json.dump(-1, ' ', false, kReplace)};
}

Response fault_response(const std::exception& error) {
    if (dynamic_cast<const Error*>(&error)) return error_response(500, error.what());
    return error_response(
        500, std::string("a fault of the program itself: ") + error.what() + "; please report it");
}

std::string response_bytes(const Response& response, bool is_kept) {
    std::string bytes = "HTTP/1.1 " + std::to_string(response.status) + " " + reason(response.status);
    if (response.status != 204)  // which has neither (RFC 9110, 8.6)
        bytes += "\r\nContent-Type: " + response.type +
                 "\r\nContent-Length: " + std::to_string(response.body.size());
    bytes += is_kept ? "\r\nConnection: keep-alive" : "\r\nConnection: close";
    bytes +=
        "\r\nCache-Control: no-store"
        "\r\nX-Content-Type-Options: nosniff"
        "\r\nX-Frame-Options: DENY"
        "\r\nReferrer-Policy: no-referrer"
        "\r\nCross-Origin-Resource-Policy: same-origin"
        "\r\nCross-Origin-Opener-Policy: same-origin"
        "\r\nContent-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; "
        "img-src 'self' blob:; connect-src 'self'; base-uri 'none'; form-action 'none'; "
        "frame-ancestors 'none'";
    for (const auto& [name, value] : response.headers) bytes += "\r\n" + name + ": " + value;
    return bytes + "\r\n\r\n" + response.body;
}

std::optional<Request> parse_request(std::string_view head) {
    const std::size_t end = head.find("\r\n\r\n"), line_end = head.find("\r\n");
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = head.substr(0, line_end);
    const std::size_t first = line.find(' '), second = line.rfind(' ');
    if (first == std::string_view::npos || second <= first || line.substr(second + 1) != "HTTP/1.1")
        return std::nullopt;
    Request request;
    request.method = line.substr(0, first);
    const std::string_view target = line.substr(first + 1, second - first - 1);
    if (!is_token(request.method) || !target.starts_with('/')) return std::nullopt;
    const std::size_t question = std::min(target.find('?'), target.size());
    request.path = target.substr(0, question);
    if (question < target.size() && !read_query(target.substr(question + 1), request.query))
        return std::nullopt;
    auto headers = read_headers(line_end == end ? "" : head.substr(line_end + 2, end - line_end - 2));
    if (!headers) return std::nullopt;
    request.headers = std::move(*headers);
    return request;
}

std::optional<Response> Incoming::add(std::string_view bytes) {
    bytes_ += bytes;
    if (request_) return std::nullopt;
    constexpr std::string_view kEnd = "\r\n\r\n";
    const std::size_t end =
        std::string_view(bytes_).substr(0, kMaxHeadBytes + kEnd.size()).find(kEnd, searched_);
    if (end == std::string_view::npos) {
        searched_ = bytes_.size() - std::min(bytes_.size(), kEnd.size() - 1);
        if (bytes_.size() < kMaxHeadBytes + kEnd.size()) return std::nullopt;
        return error_response(431, "the request's head is longer than 16 KiB");
    }
    head_ = end + kEnd.size();
    const std::string_view head = std::string_view(bytes_).substr(0, head_);
    std::size_t lines = 0;
    for (std::size_t at = head.find('\n'); at != std::string_view::npos; at = head.find('\n', at + 1))
        ++lines;
    if (lines > kMaxHeadLines)
        return error_response(431,
                              "the request's head has more than " + std::to_string(kMaxHeadLines) + " lines");
    auto request = parse_request(head);
    if (!request) return error_response(400, "the request is not HTTP/1.1");
    if (request->headers.contains("transfer-encoding"))
        return error_response(411, "a body needs its Content-Length");
    const auto length = length_of(request->headers);
    if (!length) return error_response(400, "Content-Length is not a number");
    if (*length > kMaxBodyBytes) return error_response(413, "the body is longer than 1 MiB");
    whole_ = head_ + *length;
    bytes_.reserve(whole_);  // or it would grow to twice that
    request_ = std::move(request);
    return std::nullopt;
}

bool Incoming::is_kept() const {
    return lower_case(request_->header("connection")) == "keep-alive" && bytes_.size() == whole_;
}

Request Incoming::take() {
    bytes_.resize(whole_);
    bytes_.erase(0, head_);
    request_->body = std::exchange(bytes_, {});
    return std::move(*request_);
}

}  // namespace aftershade::serve
