#include "framework/serve/serve_look.h"

#include <memory>
#include <optional>

#include "framework/capture/capture.h"
#include "framework/serve/connections.h"
#include "framework/serve/guards.h"
#include "framework/serve/look_model.h"
#include "framework/serve/page_files.h"
#include "framework/serve/page_server.h"
#include "framework/serve/picture_queue.h"

namespace aftershade::serve {

namespace {

CaptureHeader first_header(const ServeOptions& options) {
    const CaptureReader reader(options.sequence, options.profiles, options.limits);
    return reader.read_header(options.sequence.file_number(options.sequence.frames.front()));
}

/// Besides the look's own.
std::vector<std::filesystem::path> folders_to_read(const ServeOptions& options) {
    std::vector<std::filesystem::path> folders = options.effect_folders;
    folders.push_back(options.data_folder);
    std::filesystem::path last;
    for (const int frame : options.sequence.frames) {
        std::filesystem::path folder =
            options.sequence.path_of(options.sequence.file_number(frame)).parent_path();
        if (folder != last || frame == options.sequence.frames.front()) folders.push_back(folder);
        last = std::move(folder);
    }
    return folders;
}

}  // namespace

std::shared_ptr<EffectRegistry> find_effects(const ServeOptions& options) {
    std::vector<std::filesystem::path> folders = options.effect_folders;
    folders.push_back(options.data_folder / "effects");
    return std::make_shared<EffectRegistry>(folders);
}

void serve(const ServeOptions& options, const std::atomic<bool>& stop) {
    const auto files = read_page_files(options.data_folder / "page");
    const CaptureHeader header = first_header(options);
    LookModel look(
        std::filesystem::absolute(options.look), [&] { return find_effects(options); }, options.read_only,
        folders_to_read(options));
    Connections connections(options.port, {});
    const PictureQueue::Listener listener{
        [&](const DrawRequest& request) { look.drawn(request.text, request.effects_revision); },
        [&](const DrawRequest& request, const Undrawable& why) {
            look.give_up(request.text, request.effects_revision, why);
        }};
    PictureQueue pictures(options.run_drawer, listener, stop);
    PageServer server({look, pictures, options.sequence, header, options.capture, options.effect_folders});
    const std::string token = random_token();
    if (options.ready)
        options.ready("http://127.0.0.1:" + std::to_string(connections.port()) + "/#token=" + token);
    const auto at_once = [&](const Request& head) -> std::optional<Response> {
        if (auto refused = refusal(head, connections.port(), token)) return refused;
        if (head.path.starts_with("/api/")) return std::nullopt;
        const auto file = files.find(head.path);
        if (file == files.end()) return error_response(404, "there is nothing at this address");
        if (head.method != "GET") return error_response(405, "this address takes GET");
        return file->second;
    };
    std::atomic<bool> is_open = false;
    connections.run({at_once,
                     [&](const Request& request, const Connections::Reply& reply) {
                         if (!is_open.exchange(true) && options.opened) options.opened();
                         server.answer(request, reply);
                     }},
                    stop);
}

}  // namespace aftershade::serve
