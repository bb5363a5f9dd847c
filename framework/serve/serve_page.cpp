#include "framework/serve/serve_page.h"

#include <optional>

#include "framework/serve/guards.h"

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

}  // namespace aftershade::serve
