#include "framework/serve/serve_look.h"

#include <memory>
#include <utility>

#include "framework/capture/capture.h"
#include "framework/serve/connections.h"
#include "framework/serve/exporter.h"
#include "framework/serve/look_model.h"
#include "framework/serve/page_server.h"
#include "framework/serve/picture_queue.h"
#include "framework/serve/serve_page.h"
#include "framework/serve/served_capture.h"

namespace aftershade::serve {

namespace {

ServedCapture open_capture(const ServeOptions& options, const std::string& name) {
    ServedCapture capture{name, options.open_sequence(name), {}};
    const CaptureReader reader(capture.sequence, options.profiles, options.limits);
    capture.header = reader.read_header(capture.sequence.file_number(capture.sequence.frames.front()));
    return capture;
}

/// Besides the look's own.
std::vector<std::filesystem::path> folders_to_read(const ServeOptions& options, const Sequence& sequence) {
    std::vector<std::filesystem::path> folders = options.effect_folders;
    folders.push_back(options.data_folder);
    for (std::filesystem::path& folder : folders_of(sequence)) folders.push_back(std::move(folder));
    return folders;
}

}  // namespace

std::shared_ptr<EffectRegistry> find_effects(const ServeOptions& options) {
    std::vector<std::filesystem::path> folders = options.effect_folders;
    folders.push_back(options.data_folder / "effects");
    return std::make_shared<EffectRegistry>(folders);
}

void serve(const ServeOptions& options, const std::atomic<bool>& stop) {
    auto files = read_page_files(options.data_folder / "page");
    ServedCaptures captures(open_capture(options, options.capture),
                            [&](const std::string& name) { return open_capture(options, name); });
    LookModel look(
        std::filesystem::absolute(options.look), [&] { return find_effects(options); }, options.read_only,
        folders_to_read(options, captures.now()->sequence), options.look_file);
    Connections connections(options.port, {});
    const PictureQueue::Listener listener{
        [&](const DrawRequest& request) { look.drawn(request.text, request.effects_revision); },
        [&](const DrawRequest& request, const Undrawable& why) {
            look.give_up(request.text, request.effects_revision, why);
        }};
    PictureQueue pictures(options.run_drawer, listener, stop);
    PictureQueue thumbnails(options.run_thumbnail_drawer,
                            {[](const DrawRequest&) {}, [](const DrawRequest&, const Undrawable&) {}}, stop,
                            PictureQueue::Start::at_first_use);
    Exporter exporter(options.run_export);
    PageServer server({look, pictures, thumbnails, captures, exporter, options.effect_folders});
    serve_page(
        connections,
        {std::move(files), options.ready, options.opened,
         [&](const Request& request, const Connections::Reply& reply) { server.answer(request, reply); }},
        stop);
}

}  // namespace aftershade::serve
