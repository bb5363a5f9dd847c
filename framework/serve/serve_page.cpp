#include "framework/serve/serve_page.h"

#include <sys/random.h>

#include <array>
#include <optional>
#include <system_error>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"

namespace aftershade::serve {

void serve_page(Connections& connections, const ServedPage& page, const std::atomic<bool>& stop) {
    const std::string token = random_token();
    if (page.ready) page.ready("http://127.0.0.1:" + std::to_string(connections.port()) + "/#token=" + token);
    const auto at_once = [&](const Request& head) -> std::optional<Response> {
        if (auto refused = refusal(head, connections.port(), token)) return refused;
        if (head.path.starts_with("/api/")) return std::nullopt;
        const auto file = page.files.find(head.path);
        if (file == page.files.end()) return error_response(404, "there is nothing at this address");
        if (head.method != "GET") return error_response(405, "this address takes GET");
        return file->second;
    };
    std::atomic<bool> is_open = false;
    connections.run({at_once,
                     [&](const Request& request, const Connections::Reply& reply) {
                         if (!is_open.exchange(true) && page.opened) page.opened();
                         page.answer(request, reply);
                     }},
                    stop);
}

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
