#include "framework/serve/drawer.h"

#include <algorithm>
#include <exception>
#include <memory>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/error.h"
#include "framework/base/path_bounds.h"
#include "framework/look/starting_looks.h"
#include "framework/serve/drawing_process.h"
#include "framework/serve/http_message.h"
#include "framework/serve/look_model.h"
#include "framework/serve/picture_maker.h"
#include "framework/serve/serve_look.h"

namespace aftershade::serve {

namespace {

/// Of what the look, its effects and its capture hold, and not of this machine.
bool is_of_documents(ErrorKind kind) {
    return kind == ErrorKind::usage || kind == ErrorKind::capture || kind == ErrorKind::effect;
}

/// The looks of requests, bound to effects of this process's own.
class Looks {
public:
    explicit Looks(const ServeOptions& options) : options_(options) {}

    /// Throws Refusal where the files on disk are no longer those that the look was bound to elsewhere, such
    /// as a look that it uses and that now names other files.
    std::shared_ptr<const BoundText> of(const DrawRequest& request) {
        if (bound_ && bound_->revision == request.revision &&
            bound_->effects_revision == request.effects_revision)
            return bound_;
        const auto effects = effects_of(request.effects_revision);
        Diagnostics faults;
        std::string refused;
        const FileRule rule([&](const std::filesystem::path& file) -> std::string {
            if (std::ranges::find(request.files, resolved_path(file).string()) != request.files.end())
                return "";
            refused = "'" + file.string() +
                      "' is not a file that the look named when it was read (change the look)";
            return "is not a file that the look named";
        });
        auto bound = bind_text(request.text, std::filesystem::absolute(options_.look), effects, faults);
        if (!refused.empty()) throw Refusal{403, refused};
        if (!bound || faults.has_errors())
            throw Refusal{409, "the effects on disk are no longer those that the look was bound to"};
        bound->revision = request.revision;
        bound->effects_revision = request.effects_revision;
        bound_ = std::move(bound);
        return bound_;
    }

    const std::shared_ptr<EffectRegistry>& effects_of(std::uint64_t revision) {
        if (!effects_ || effects_revision_ != revision) {
            effects_ = find_effects(options_);
            effects_revision_ = revision;
        }
        return effects_;
    }

private:
    const ServeOptions& options_;
    std::shared_ptr<EffectRegistry> effects_;
    std::uint64_t effects_revision_ = 0;
    std::shared_ptr<const BoundText> bound_;  // the last one
};

/// [{"name", "summary", "text"}], with "needs" in place of the text where the capture lacks roles: for each
/// its name, and with it the producer's remedy.
Response starts(const DrawRequest& request, const std::filesystem::path& data, EffectRegistry& effects,
                PictureMaker& maker) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    const CaptureHeader& header = maker.header_of(request.frame);
    for (const StartingLook& look : find_starting_looks(starting_looks_folder(data), effects, header)) {
        nlohmann::ordered_json entry = {{"name", look.name()}, {"summary", look.summary}};
        for (const MissingRole& missing : look.missing) {
            const auto remedy = header.remedies.find(missing.role);
            entry["needs"].push_back(
                {{"role", missing.role}, {"remedy", remedy == header.remedies.end() ? "" : remedy->second}});
        }
        if (look.missing.empty())
            entry["text"] =
                maker.focused_on_surface(read_text_file(look.file, ErrorKind::usage), request.frame);
        list.push_back(std::move(entry));
    }
    return json_response(list);
}

Response answer(const DrawRequest& request, const ServeOptions& options, Looks& looks, PictureMaker& maker) {
    if (request.kind == DrawRequest::Kind::starts)
        return starts(request, options.data_folder, *looks.effects_of(request.effects_revision), maker);
    if (request.kind == DrawRequest::Kind::objects) return json_response(maker.objects(request.frame));
    const PictureRequest wanted{looks.of(request),   request.frame,     request.scale,  request.view,
                                request.exposure_ev, request.continues, request.is_file};
    switch (request.kind) {
        case DrawRequest::Kind::probe: return json_response(maker.probe(wanted, request.x, request.y));
        case DrawRequest::Kind::histogram: return json_response(maker.histogram(wanted));
        case DrawRequest::Kind::metrics: return json_response(maker.metrics(wanted, request.truth));
        case DrawRequest::Kind::starts:
        case DrawRequest::Kind::objects:
        case DrawRequest::Kind::thumbnail:
        case DrawRequest::Kind::picture: break;
    }
    // A thumbnail shows what its step does, and a file is the look's: neither is the capture alone.
    const bool may_be_capture = request.kind == DrawRequest::Kind::picture && !request.is_file;
    MadePicture made = may_be_capture ? maker.make_or_show_capture(wanted) : maker.make(wanted);
    Response response{
        200,
        "image/png",
        std::move(made.png),
        {{"X-Aftershade-Times", made.times}, {"X-Aftershade-Revision", std::to_string(request.revision)}}};
    if (made.has_fault) response.headers[kFaultHeader] = "capture";
    return response;
}

/// What draws the capture of the last request.
class Maker {
public:
    Maker(const ServeOptions& options, StatusWriter& status) : options_(options), status_(status) {}

    /// Throws Error.
    PictureMaker& of(const std::string& capture) {
        if (maker_ && capture == capture_) return *maker_;
        Sequence sequence = options_.open_sequence(capture);
        maker_.reset();
        capture_ = capture;
        return maker_.emplace(std::move(sequence), options_.profiles, options_.limits, options_.gl,
                              options_.data_folder, status_);
    }

private:
    const ServeOptions& options_;
    StatusWriter& status_;
    std::string capture_;
    std::optional<PictureMaker> maker_;
};

Response answer_or_fault(const DrawRequest& request, const ServeOptions& options, Looks& looks,
                         Maker& maker) {
    try {
        return answer(request, options, looks, maker.of(request.capture));
    } catch (const Refusal& refusal) {
        return error_response(refusal.status, refusal.message);
    } catch (const Error& error) {
        return error_response(is_of_documents(error.kind()) ? 400 : 500, error.what());
    } catch (const std::exception& error) {
        return fault_response(error);
    }
}

}  // namespace

void draw_for(const ServeOptions& options, int socket) {
    StatusWriter status;
    Maker maker(options, status);
    try {
        const PictureMaker& first = maker.of(options.capture);
        if (options.drawn_by) options.drawn_by(first.gl());
    } catch (const Error& error) {
        send_answer(socket, {500, std::to_string(int(error.kind())), error.what()});
        return;
    }
    if (!send_answer(socket, {})) return;
    Looks looks(options);
    while (const auto request = receive_request(socket))
        if (!send_answer(socket, answer_or_fault(*request, options, looks, maker))) return;
}

}  // namespace aftershade::serve
