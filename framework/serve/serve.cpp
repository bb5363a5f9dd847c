#include "framework/serve/serve.h"

#include <memory>

#include "framework/capture/capture.h"
#include "framework/serve/connections.h"
#include "framework/serve/guards.h"
#include "framework/serve/handover.h"
#include "framework/serve/look_model.h"
#include "framework/serve/page_files.h"
#include "framework/serve/page_server.h"
#include "framework/serve/picture_maker.h"
#include "framework/serve/render_thread.h"

namespace aftershade::serve {

namespace {

CaptureHeader first_header(const ServeOptions& options) {
    const CaptureReader reader(options.sequence, options.profiles, options.limits);
    return reader.read_header(options.sequence.file_number(options.sequence.frames.front()));
}

}  // namespace

void serve(const ServeOptions& options, const std::atomic<bool>& stop) {
    const auto files = read_page_files(options.data_folder / "page");
    const CaptureHeader header = first_header(options);
    std::vector<std::filesystem::path> folders = options.effect_folders;
    folders.push_back(options.data_folder / "effects");
    const auto find_effects = [&] { return std::make_shared<EffectRegistry>(folders); };
    const bool continues = !options.handover.empty();
    const Handover before =
        continues ? read_handover(options.handover) : Handover{options.port, random_token(), {}, {}};
    const std::filesystem::path path = std::filesystem::absolute(options.look);
    const std::unique_ptr<LookModel> look =
        continues
            ? std::make_unique<LookModel>(path, find_effects, options.read_only, before.look, before.hung)
            : std::make_unique<LookModel>(path, find_effects, options.read_only);
    Connections connections(before.port, {});
    Drawing drawing;
    drawing.status = options.status;
    const auto make = [&] {
        return std::make_unique<PictureMaker>(options.sequence, options.profiles, options.limits,
                                              options.backend, options.data_folder, drawing);
    };
    RenderThread pictures(make, stop);
    PageServer server({*look, pictures, options.sequence, header, options.capture, options.effect_folders});
    const std::string& token = before.token;
    if (options.ready && !continues)
        options.ready("http://127.0.0.1:" + std::to_string(connections.port()) + "/#token=" + token);
    connections.run(
        [&](const Request& request) {
            if (auto refused = refusal(request, connections.port(), token)) return *refused;
            if (request.path.starts_with("/api/")) return server.answer(request);
            const auto file = files.find(request.path);
            if (file == files.end()) return error_response(404, "there is nothing at this address");
            if (request.method != "GET") return error_response(405, "this address takes GET");
            return file->second;
        },
        stop,
        [&] {
            const std::string reason = options.hang ? options.hang() : "";
            const std::shared_ptr<const BoundText> drawn = drawing.look;
            if (reason.empty() || !drawn) return;
            options.restart(
                handover_bytes({connections.port(), token, look->history(), {drawn->text, reason}}));
        });
}

}  // namespace aftershade::serve
