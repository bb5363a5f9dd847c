// The answer of the page's server at each address.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/effect/registry.h"
#include "framework/serve/exporter.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_model.h"
#include "framework/serve/picture_queue.h"
#include "framework/serve/served_capture.h"

namespace aftershade::serve {

/// [refers to what the caller keeps]
struct PageSetup {
    LookModel& look;
    PictureQueue& pictures;
    PictureQueue& thumbnails;  ///< of a process of its own, so that no picture waits for them
    ServedCaptures& captures;
    Exporter& exporter;
    std::vector<std::filesystem::path> effect_folders;  ///< those that the user named
};

/// [any thread]
class PageServer {
public:
    explicit PageServer(PageSetup setup)
        : setup_(std::move(setup)), stamp_(stamp_of_folders(setup_.effect_folders)) {}

    using Reply = PictureQueue::Reply;
    /// Answers a request to an address below /api/ that refusal() lets through; a picture once it is drawn.
    void answer(const Request& request, const Reply& reply);

private:
    Response state() const;
    Response change(const Request& request);
    std::optional<Response> last_picture(const Request& request) const;
    void require_whole_look(std::uint64_t revision) const;
    DrawRequest picture(const Request& request) const;
    DrawRequest probe(const Request& request) const;
    DrawRequest metrics(const Request& request) const;
    DrawRequest thumbnail(const Request& request);
    DrawRequest starts(const Request& request) const;
    Response take_capture(const Request& request);
    Response command() const;
    Response start_export(const Request& request);
    Response changes();
    Response shaders(const Request& request) const;
    Response save_shader(const Request& request);
    Response new_effect(const Request& request);
    void follow_effects();
    DrawRequest place_of(const Request& request, DrawRequest::Kind kind) const;
    DrawRequest request_of(const Request& request, DrawRequest::Kind kind) const;

    PageSetup setup_;
    std::mutex bodies_;                           // held while one is read
    std::atomic<std::uint64_t> tried_texts_ = 0;  // each of which is another revision
    std::mutex mutex_;                            // of what follows
    std::string stamp_;                           // of the effects as they were last read
};

}  // namespace aftershade::serve
