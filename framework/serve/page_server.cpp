#include "framework/serve/page_server.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/effect/new_effect.h"
#include "framework/image/role.h"
#include "framework/serve/truths.h"
#include "framework/serve/view_picture.h"

namespace aftershade::serve {

namespace {

using Json = nlohmann::ordered_json;

template <typename Number>
Number number_of(const Request& request, const std::string& name, Number otherwise) {
    const std::string text = request.parameter(name);
    if (text.empty()) return otherwise;
    Number number{};
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure != std::errc() || end != text.data() + text.size())
        throw Refusal{400, "'" + name + "' is '" + text + "', which is not a number"};
    return number;
}

Json capture_json(const ServedCapture& capture) {
    const Sequence& sequence = capture.sequence;
    const CaptureHeader& header = capture.header;
    Json roles = Json::array();
    for (const std::string& name : header.roles) {
        const auto contract = find_role(name);
        const auto stored = header.role_channels.find(name);
        roles.push_back({{"name", name},
                         {"unit", unit_of_role(name)},
                         {"meaning", contract ? contract->meaning : ""},
                         {"channels", stored == header.role_channels.end()
                                          ? std::size_t(contract ? contract->channels : 0)
                                          : stored->second.size()}});
    }
    Json truths = Json::object();
    for (const auto& [frame, names] : truths_of(sequence)) truths[std::to_string(frame)] = names;
    return {{"path", capture.name},
            {"frames", sequence.frames},
            {"fps", sequence.fps},
            {"width", header.display_window.width()},
            {"height", header.display_window.height()},
            {"roles", roles},
            {"truths", truths}};
}

}  // namespace

Response PageServer::state() const {
    const auto capture = setup_.captures.now();
    Json state = setup_.look.state(capture->header);
    if (setup_.pictures.last_final()) state["has_picture"] = true;
    state["effect_folders"] = Json::array();
    for (const auto& folder : setup_.effect_folders) state["effect_folders"].push_back(folder.string());
    state["capture"] = capture_json(*capture);
    return json_response(state);
}

Response PageServer::change(const Request& request) {
    if (request.path == "/api/undo") setup_.look.undo();
    else if (request.path == "/api/redo") setup_.look.redo();
    else if (request.path == "/api/save") {
        const Json body = shallow_json(request.body);
        const bool has_name = body.is_object() && body.contains("name") && body["name"].is_string();
        setup_.look.save(has_name ? body["name"].get<std::string>() : "");
    } else {
        const Json body = shallow_json(request.body);
        if (!body.is_object() || !body.contains("revision") || !body["revision"].is_number_unsigned() ||
            !body.contains("edits"))
            throw Refusal{400, "the body is {\"revision\": NUMBER, \"edits\": [...]}"};
        setup_.look.edit(body["revision"].get<std::uint64_t>(), body["edits"]);
    }
    return state();
}

/// The frame and the capture that a request asks for.
DrawRequest PageServer::place_of(const Request& request, DrawRequest::Kind kind) const {
    DrawRequest wanted;
    wanted.kind = kind;
    const auto capture = setup_.captures.now();
    wanted.capture = capture->name;
    wanted.frame = number_of(request, "frame", capture->sequence.frames.front());
    if (std::ranges::find(capture->sequence.frames, wanted.frame) == capture->sequence.frames.end())
        throw Refusal{404, "the capture has no frame " + std::to_string(wanted.frame)};
    return wanted;
}

DrawRequest PageServer::request_of(const Request& request, DrawRequest::Kind kind) const {
    DrawRequest wanted = place_of(request, kind);
    const std::shared_ptr<const BoundText> look = setup_.look.bound();
    if (!look) throw Refusal{409, "the look has faults, and there was none without before it"};
    wanted.text = look->text;
    wanted.files = look->files;
    wanted.revision = look->revision;
    wanted.effects_revision = look->effects_revision;
    wanted.scale = number_of(request, "scale", 1);
    if (wanted.scale != 1 && wanted.scale != 2 && wanted.scale != 4)
        throw Refusal{400, "'scale' is 1, 2 or 4"};
    wanted.view = request.parameter("view", "final");
    wanted.exposure_ev = number_of(request, "exposure", 0.0);
    if (!(std::abs(wanted.exposure_ev) <= 32)) throw Refusal{400, "'exposure' is from -32 to 32 stops"};
    wanted.continues = request.parameter("continues") == "1";
    return wanted;
}

/// Where nothing can be drawn.
std::optional<Response> PageServer::last_picture(const Request& request) const {
    if (setup_.look.bound() || request.parameter("view", "final") != "final" ||
        request.parameter("format") == "png")
        return std::nullopt;
    return setup_.pictures.last_final();
}

/// `revision` is that of the last text without faults.
void PageServer::require_whole_look(std::uint64_t revision) const {
    if (revision != setup_.look.revision())
        throw Refusal{409, "the look has faults; correct them before the export"};
}

DrawRequest PageServer::picture(const Request& request) const {
    DrawRequest wanted = request_of(request, DrawRequest::Kind::picture);
    const std::string format = request.parameter("format", "quick");
    if (format != "quick" && format != "png") throw Refusal{400, "'format' is quick or png"};
    wanted.is_file = format == "png";
    if (wanted.is_file && (wanted.view != "final" || wanted.exposure_ev != 0))
        throw Refusal{400, "a file is of the view final without exposure"};
    if (wanted.is_file) require_whole_look(wanted.revision);
    return wanted;
}

DrawRequest PageServer::probe(const Request& request) const {
    DrawRequest wanted = request_of(request, DrawRequest::Kind::probe);
    wanted.x = number_of(request, "x", -1);
    wanted.y = number_of(request, "y", -1);
    const Window window = setup_.captures.now()->header.display_window;
    if (wanted.x < 0 || wanted.y < 0 || wanted.x >= window.width() || wanted.y >= window.height())
        throw Refusal{400, "'x' and 'y' are a pixel of the picture"};
    return wanted;
}

DrawRequest PageServer::metrics(const Request& request) const {
    DrawRequest wanted = request_of(request, DrawRequest::Kind::metrics);
    wanted.truth = request.parameter("truth");
    return wanted;
}

/// A small picture of the look as it would be after some edits.
DrawRequest PageServer::thumbnail(const Request& request) {
    constexpr int kWidth_px = 240, kMostDivisor = 64;  // the least and the most that `run --scale` takes
    const Json body = shallow_json(request.body);
    if (!body.is_object() || !body.contains("edits")) throw Refusal{400, "the body is {\"edits\": [...]}"};
    DrawRequest wanted = place_of(request, DrawRequest::Kind::thumbnail);
    const auto look = setup_.look.tried(body["edits"]);
    wanted.text = look->text;
    wanted.files = look->files;
    wanted.effects_revision = look->effects_revision;
    wanted.revision = ++tried_texts_;
    const int width = setup_.captures.now()->header.display_window.width();
    wanted.scale = std::clamp((width + kWidth_px - 1) / kWidth_px, 1, kMostDivisor);
    return wanted;
}

DrawRequest PageServer::starts(const Request& request) const {
    DrawRequest wanted = place_of(request, DrawRequest::Kind::starts);
    wanted.effects_revision = setup_.look.effects_revision();
    return wanted;
}

Response PageServer::take_capture(const Request& request) {
    const Json body = shallow_json(request.body);
    const auto is_size = [](const Json& size) { return size.is_null() || size.is_number_unsigned(); };
    if (!body.is_object() || !body.contains("name") || !body["name"].is_string() ||
        !is_size(body.value("bytes", Json())))
        throw Refusal{400, "the body is {\"name\": TEXT, \"bytes\": SIZE of a file}"};
    const Json bytes = body.value("bytes", Json());
    setup_.captures.take(body["name"].get<std::string>(),
                         bytes.is_null() ? std::nullopt : std::optional(bytes.get<std::uint64_t>()));
    setup_.look.capture_changed();
    return state();
}

Response PageServer::command() const {
    const auto capture = setup_.captures.now();
    const char* output = capture->sequence.frames.size() == 1 ? "out.png" : "out_####.png";
    std::vector<std::string> words = {"aftershade",  "run", setup_.look.saved_path().string(),
                                      capture->name, "-o",  output};
    if (!capture->sequence.frames_declared && find_gaps(capture->sequence.frames).count > 0)
        words.insert(words.end(), {spelled(Option::missing), "skip"});
    return json_response({{"command", printed_command(words)}});
}

/// Writes the frames of the look as edited.
Response PageServer::start_export(const Request& request) {
    const Json body = shallow_json(request.body);
    for (const char* key : {"name", "format"})
        if (!body.is_object() || !body.contains(key) || !body[key].is_string())
            throw Refusal{400, "the body is {\"name\", \"format\"}, both of them a text"};
    if (setup_.look.is_read_only())
        throw Refusal{403, "nothing is exported: the program runs with " + spelled(Option::read_only)};
    const auto look = setup_.look.bound();
    require_whole_look(look ? look->revision : 0);
    const auto capture = setup_.captures.now();
    setup_.exporter.start({body["name"].get<std::string>(), body["format"].get<std::string>(), look->text,
                           look->files, setup_.look.folder(), capture->name, capture->sequence.frames});
    return json_response(setup_.exporter.state());
}

/// Has the effects read again where their files are not those that were read.
void PageServer::follow_effects() {
    const std::lock_guard lock(mutex_);
    std::string stamp = stamp_of_folders(setup_.effect_folders);
    if (stamp == stamp_) return;
    stamp_ = std::move(stamp);
    setup_.look.reload_effects();
}

Response PageServer::changes() {
    follow_effects();
    setup_.look.follow_file();
    return json_response(setup_.look.revisions());
}

Response PageServer::shaders(const Request& request) const {
    const EffectFiles files = setup_.look.files_of(request.parameter("effect"));
    Json json = {{"folder", files.folder.string()}, {"why_not", files.why_not}, {"files", Json::object()}};
    for (const std::string& name : files.names()) json["files"][name] = files.read(name);
    return json_response(json);
}

Response PageServer::save_shader(const Request& request) {
    const Json body = shallow_json(request.body);
    for (const char* key : {"effect", "file", "before", "text"})
        if (!body.is_object() || !body.contains(key) || !body[key].is_string())
            throw Refusal{400,
                          "the body is {\"effect\", \"file\", \"before\", \"text\"}, each of them a text"};
    setup_.look.files_of(body["effect"].get<std::string>())
        .write(body["file"].get<std::string>(), body["before"].get<std::string>(),
               body["text"].get<std::string>());
    follow_effects();
    return state();
}

Response PageServer::new_effect(const Request& request) {
    constexpr std::size_t kLongestId = 64;  // characters
    const Json body = shallow_json(request.body);
    for (const char* key : {"folder", "effect"})
        if (!body.is_object() || !body.contains(key) || !body[key].is_string())
            throw Refusal{400, "the body is {\"folder\", \"effect\"}, both of them a text"};
    const std::filesystem::path folder = body["folder"].get<std::string>();
    const auto id = body["effect"].get<std::string>();
    if (setup_.look.is_read_only())
        throw Refusal{403, "no effect is made: the program runs with " + spelled(Option::read_only)};
    if (std::ranges::find(setup_.effect_folders, folder) == setup_.effect_folders.end())
        throw Refusal{403, "'" + folder.string() + "' is not a folder of " + spelled(Option::effect_path)};
    if (!is_snake_case(id)) throw Refusal{400, "the effect's name '" + id + "' " + kMustBeSnakeCase};
    if (id.size() > kLongestId)
        throw Refusal{400, "the effect's name has " + std::to_string(id.size()) +
                               " characters; the most is " + std::to_string(kLongestId)};
    std::error_code failure;
    if (setup_.look.has_effect(id) ||
        std::filesystem::symlink_status(folder / id, failure).type() != std::filesystem::file_type::not_found)
        throw Refusal{409, "'" + id + "' is there already; choose another name"};
    make_effect(folder, id);
    follow_effects();
    return state();
}

void PageServer::answer(const Request& request, const Reply& reply) {
    using Answer = std::function<void()>;
    const auto now = [&](auto make) { return [&, make] { reply(make()); }; };
    const auto drawn = [&](auto make) { return [&, make] { setup_.pictures.run(make(), reply); }; };
    const std::map<std::string, std::pair<std::string, Answer>> answers = {
        {"/api/state", {"GET", now([&] { return state(); })}},
        {"/api/effects", {"GET", now([&] {
                              return Response{200, "application/json", setup_.look.effects_json()};
                          })}},
        {"/api/schema", {"GET", now([&] {
                             return Response{200, "application/json", setup_.look.schema_json()};
                         })}},
        {"/api/picture",
         {"GET",
          [&] {
              if (auto last = last_picture(request)) reply(std::move(*last));
              else setup_.pictures.run(picture(request), reply);
          }}},
        {"/api/thumbnail", {"POST", [&] { setup_.thumbnails.run(thumbnail(request), reply); }}},
        {"/api/starts", {"GET", [&] { setup_.thumbnails.run(starts(request), reply); }}},
        {"/api/objects",
         {"GET", [&] { setup_.thumbnails.run(place_of(request, DrawRequest::Kind::objects), reply); }}},
        {"/api/capture", {"POST", now([&] { return take_capture(request); })}},
        {"/api/probe", {"GET", drawn([&] { return probe(request); })}},
        {"/api/histogram", {"GET", drawn([&] { return request_of(request, DrawRequest::Kind::histogram); })}},
        {"/api/metrics", {"GET", drawn([&] { return metrics(request); })}},
        {"/api/command", {"GET", now([&] { return command(); })}},
        {"/api/export", {"GET", now([&] { return json_response(setup_.exporter.state()); })}},
        {"/api/export/start", {"POST", now([&] { return start_export(request); })}},
        {"/api/export/cancel", {"POST", now([&] {
                                    setup_.exporter.cancel();
                                    return json_response(setup_.exporter.state());
                                })}},
        {"/api/changes", {"GET", now([&] { return changes(); })}},
        {"/api/shaders", {"GET", now([&] { return shaders(request); })}},
        {"/api/shader", {"POST", now([&] { return save_shader(request); })}},
        {"/api/effect", {"POST", now([&] { return new_effect(request); })}},
        {"/api/edit", {"POST", now([&] { return change(request); })}},
        {"/api/undo", {"POST", now([&] { return change(request); })}},
        {"/api/redo", {"POST", now([&] { return change(request); })}},
        {"/api/save", {"POST", now([&] { return change(request); })}}};
    const auto found = answers.find(request.path);
    if (found == answers.end()) return reply(error_response(404, "there is nothing at this address"));
    if (request.method != found->second.first)
        return reply(error_response(405, "this address takes " + found->second.first));
    try {
        // One body at a time: JSON takes up to 50 times the memory of its text.
        const std::unique_lock lock =
            request.body.empty() ? std::unique_lock<std::mutex>() : std::unique_lock(bodies_);
        found->second.second();
    } catch (const Refusal& refusal) {
        reply(error_response(refusal.status, refusal.message));
    } catch (const Error& error) {
        reply(error_response(500, error.what()));
    }
}

}  // namespace aftershade::serve
