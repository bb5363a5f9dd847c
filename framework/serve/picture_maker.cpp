#include "framework/serve/picture_maker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "framework/base/cores.h"
#include "framework/base/error.h"
#include "framework/capture/capture_window.h"
#include "framework/effect/pass_program.h"
#include "framework/effect/program_store.h"
#include "framework/image/role.h"
#include "framework/run/nan_policy.h"
#include "framework/run/output.h"
#include "framework/serve/truths.h"
#include "framework/serve/view_picture.h"

namespace aftershade::serve {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view kTruthView = "truth:", kDifferenceView = "difference:";

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// [{"step", "param", "value"}] of the parameters whose value is taken from pixels.
nlohmann::ordered_json measured_json(const Pipeline& pipeline, const Capture& capture) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    const FrameInputs frame = FrameSetting{}.inputs(capture);
    for (const PipelineStep& step : pipeline.steps)
        for (const ParamSpec& spec : step.manifest->params) {
            const auto asked = step.values.find(spec.name);
            if (asked == step.values.end() || pixel_values(asked->second).empty()) continue;
            const std::string text = format_value(spec, resolve_param(step, spec, frame).value);
            list.push_back({{"step", step.name},
                            {"param", spec.name},
                            {"value", nlohmann::ordered_json::parse(text, nullptr, false)}});
        }
    return list;
}

/// A header of HTTP is ASCII.
std::string header_text(const nlohmann::ordered_json& json) {
    return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

bool makes(const Pipeline& pipeline, const std::string& role) {
    return pipeline.writes_role(role);
}

/// What the view shows the result of.
Pipeline pipeline_of(const PictureRequest& request) {
    Pipeline pipeline = request.look->pipeline;
    if (request.view.starts_with("tap:") || request.view.starts_with(kSharpView))
        pipeline.taps = {tap_of(request.view, pipeline)};
    if (!request.view.starts_with(kBeforeView)) return pipeline;
    const std::string name = request.view.substr(kBeforeView.size());
    const auto step = std::ranges::find(pipeline.steps, name, &PipelineStep::name);
    if (step == pipeline.steps.end())
        throw Error(ErrorKind::usage, "the look has no enabled step '" + name + "'");
    pipeline.steps.erase(step, pipeline.steps.end());
    return pipeline;
}

std::string joined_roles(std::span<const RoleId> roles) {
    std::string text;
    for (const RoleId& role : roles) text += role.name() + "\n";
    return text;
}

}  // namespace

PictureMaker::PictureMaker(Sequence sequence, std::vector<Profile> profiles, ReadLimits limits,
                           const gpu::GlChoice& gl, const std::filesystem::path& data_folder,
                           StatusWriter& status)
    : sequence_(std::move(sequence)),
      reader_(sequence_, std::move(profiles), limits),
      limits_(limits),
      status_(status),
      context_(gl),
      programs_(
          std::make_shared<ProgramCache>(context_, data_folder / "glsl", ProgramStore::from_environment())) {}

PictureMaker::~PictureMaker() = default;

void PictureMaker::adopt(Scaled& scaled, const PictureRequest& request, Pipeline pipeline) {
    const bool is_new = !scaled.pipeline || scaled.look->effects_revision != request.look->effects_revision ||
                        !pipeline.has_form_of(*scaled.pipeline);
    if (!scaled.pipeline) scaled.pipeline = std::make_unique<Pipeline>();
    *scaled.pipeline = std::move(pipeline);
    if (is_new) ++scaled.form;
    if (!scaled.renderer) {
        RendererOptions options;
        options.keeps_steps = true;
        options.compile_threads = allotted_cores() - 1;
        scaled.renderer = std::make_unique<PipelineRenderer>(context_, *scaled.pipeline, programs_,
                                                             NativeSources{nullptr, &status_}, options);
    } else if (is_new) {
        scaled.renderer->pipeline_changed();
    }
    scaled.look = request.look;
}

/// Whether the captures are those of the last call.
bool PictureMaker::load(Scaled& scaled, const PictureRequest& request) {
    const Pipeline& pipeline = *scaled.pipeline;
    std::vector<RoleId> reads = pipeline.capture_roles();
    std::string key = joined_roles(reads) + "objects\n" + joined(pipeline.object_names(), "\n", "\n") + "\n";
    for (const int offset : pipeline.neighbour_offsets())
        key += "offset " + std::to_string(offset) + "\n" + joined_roles(pipeline.neighbour_roles(offset));
    key += std::to_string(pipeline.last_accumulating_step() >= 0);
    if (scaled.loaded && scaled.loaded->frame == request.frame && scaled.loaded->key == key) return true;
    // Readers of other scales may not meet a change of what they read by.
    if (sequence_.object_names != pipeline.object_names()) {
        for (auto& [scale, other] : scaled_) other.loaded.reset();
        sequence_.object_names = pipeline.object_names();
    }
    scaled.loaded.reset();
    auto loaded = std::make_unique<Loaded>();
    loaded->frame = request.frame;
    loaded->key = std::move(key);
    loaded->run.frames = {request.frame};
    loaded->run.scale_divisor = request.scale;
    loaded->loader =
        std::make_unique<FrameLoader>(sequence_, reader_, pipeline, loaded->run, std::move(reads));
    loaded->neighbours = loaded->loader->neighbours(0);
    for (int i = 0; i < loaded->loader->subframe_count(); ++i)
        loaded->captures.push_back(loaded->loader->take(0, i));
    require_capture_roles(pipeline, loaded->captures.front()->header, &reader_);
    scaled.loaded = std::move(loaded);
    return false;
}

/// Whether the frame follows the one that was drawn last.
bool PictureMaker::is_next(const Scaled& scaled, int frame) const {
    if (!scaled.loaded || !scaled.is_current) return false;
    const auto before = std::ranges::find(sequence_.frames, scaled.loaded->frame);
    return before != sequence_.frames.end() && before + 1 != sequence_.frames.end() && *(before + 1) == frame;
}

FrameResult PictureMaker::draw_subframes(Scaled& scaled, const std::vector<std::string>& roles, Start start) {
    const Loaded& loaded = *scaled.loaded;
    FrameSetting setting;
    setting.neighbours = loaded.neighbours;
    // Else as `run --frames` begins with this frame.
    setting.begins_shot = start != Start::next_frame || loaded.loader->begins_shot(0);
    setting.subframe_count = int(loaded.captures.size());
    setting.scale = 1.0 / loaded.run.scale_divisor;
    setting.fps = sequence_.fps;
    const auto take = [&](int subframe) { return loaded.captures[std::size_t(subframe)]; };
    return draw_frame(*scaled.renderer, setting, take, roles, start == Start::same_frame).result;
}

PictureMaker::Scaled& PictureMaker::draw(const PictureRequest& request) {
    const auto start = Clock::now();
    context_.make_current();
    Scaled& scaled = scaled_[request.scale];
    const std::shared_ptr<const BoundText> before = scaled.look;  // until the renderer has let go of it
    Pipeline pipeline = pipeline_of(request);
    std::vector<std::string> roles = {makes(pipeline, kDisplayRole) ? kDisplayRole : kColorRole};
    if (request.view.starts_with("role:") && makes(pipeline, request.view.substr(5)))
        roles.push_back(request.view.substr(5));
    const int form_before = scaled.form;
    adopt(scaled, request, std::move(pipeline));
    const bool follows = request.continues && is_next(scaled, request.frame) && scaled.form == form_before;
    const bool is_same = load(scaled, request);
    drawn_ = 0;
    const bool is_here = is_same && scaled.is_current && scaled.revision == request.look->revision &&
                         scaled.roles_asked == roles && scaled.form == form_before;
    if (!is_here) {
        scaled.is_current = false;
        scaled.result = draw_subframes(scaled, roles,
                                       is_same   ? Start::same_frame
                                       : follows ? Start::next_frame
                                                 : Start::shot);
        drawn_ = scaled.renderer->steps_drawn();
        scaled.is_current = true;
        scaled.revision = request.look->revision;
        scaled.roles_asked = roles;
    } else {
        scaled.result.times.clear();
    }
    scaled.total_ms = ms_since(start);
    return scaled;
}

ShownView PictureMaker::picture(const Scaled& scaled, const PictureRequest& request) const {
    const Loaded& loaded = *scaled.loaded;
    return view_picture(
        {request.view, request.exposure_ev, scaled.result, *loaded.captures[loaded.captures.size() / 2]});
}

ShownView PictureMaker::shown(const Scaled& scaled, const PictureRequest& request) {
    if (request.view.starts_with(kTruthView)) {
        const Capture& wanted = truth(request.frame, request.view.substr(kTruthView.size()));
        return view_picture({"before", request.exposure_ev, scaled.result, wanted});
    }
    if (request.view.starts_with(kDifferenceView))
        return difference(request, request.view.substr(kDifferenceView.size()));
    const bool is_stored_role =
        request.view.starts_with("role:") && !scaled.result.images.contains(request.view.substr(5));
    if (!is_stored_role) return picture(scaled, request);
    return view_picture({request.view, request.exposure_ev, scaled.result, whole_capture(request.frame)});
}

std::string PictureMaker::file_of(const Scaled& scaled) const {
    const Loaded& loaded = *scaled.loaded;
    return encode_display("the picture", {}, scaled.result, *loaded.captures[loaded.captures.size() / 2]);
}

MadePicture PictureMaker::make(const PictureRequest& request) {
    const auto start = Clock::now();
    Scaled& scaled = draw(request);
    const ShownView view = request.is_file ? ShownView{} : shown(scaled, request);
    MadePicture made;
    made.png = request.is_file ? file_of(scaled) : quick_png(view.picture, !is_false_color(request.view));
    nlohmann::ordered_json times;
    times["passes"] = nlohmann::ordered_json::array();
    for (const graph::PassTime& time : scaled.result.times) {
        const std::size_t dot = time.pass.find('.');
        const std::string step = dot == std::string::npos ? "" : time.pass.substr(0, dot);
        const std::string name = dot == std::string::npos ? time.pass : time.pass.substr(dot + 1);
        times["passes"].push_back({{"step", step}, {"name", name}, {"ms", time.milliseconds}});
    }
    times["draw_ms"] = scaled.total_ms;
    times["total_ms"] = ms_since(start);
    times["steps_drawn"] = drawn_;
    times["steps_cached"] = int(scaled.pipeline->steps.size()) - drawn_;
    times["memory_bytes"] = scaled.renderer->graph_bytes().first;
    times["gl_objects"] = context_.objects().total();
    std::uint64_t non_finite = 0;
    for (const NonFiniteOutput& output : apply_nan_policy(NanPolicy::warn, scaled.result))
        non_finite += output.pixels.count();
    times["non_finite"] = non_finite;
    const CaptureHeader& header = scaled.loaded->captures.front()->header;
    times["warnings"] = header.warnings;
    for (const std::string& difference : header.differences) times["warnings"].push_back(difference);
    const Capture& middle = *scaled.loaded->captures[scaled.loaded->captures.size() / 2];
    times["measured"] = measured_json(*scaled.pipeline, middle);
    if (!view.legend.is_null()) times["legend"] = view.legend;
    if (request.view.starts_with(kSharpView)) {
        const auto [near_m, far_m] = sharp_range_m(scaled.result.taps.begin()->second, middle);
        if (near_m <= far_m) times["sharp_m"] = {near_m, far_m};
    }
    made.times = header_text(times);
    return made;
}

MadePicture PictureMaker::make_or_show_capture(const PictureRequest& request) {
    try {
        return make(request);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::capture) throw;
        std::optional<ShownView> view = view_without_steps(request);
        if (!view) throw;
        nlohmann::ordered_json times = {
            {"fault", {{"message", error.what()}, {"step", step_at_fault(request)}}}};
        if (!view->legend.is_null()) times["legend"] = view->legend;
        return {quick_png(view->picture, view->legend.is_null()), header_text(times), true};
    }
}

/// A role or a truth that the request shows, else the picture before all steps; nullopt without a colour.
std::optional<ShownView> PictureMaker::view_without_steps(const PictureRequest& request) {
    static const std::string kBefore = "before";
    const std::string role = request.view.starts_with("role:") ? request.view.substr(5) : "";
    const bool is_truth = request.view.starts_with(kTruthView);
    const Capture& capture = is_truth ? truth(request.frame, request.view.substr(kTruthView.size()))
                                      : whole_capture(request.frame);
    const bool is_stored_role = capture.images.contains(role);
    if (!is_stored_role && !capture.images.contains(kColorRole)) return std::nullopt;
    return view_picture({is_stored_role ? request.view : kBefore, request.exposure_ev, {}, capture});
}

/// The first step that takes from the frame what the frame has not; "" where no single step is at fault.
std::string PictureMaker::step_at_fault(const PictureRequest& request) {
    const auto& scaled = scaled_[request.scale];
    const CaptureHeader header = header_of(request.frame);
    const std::vector<MissingRole> all_missing = find_missing_roles(request.look->pipeline, header);
    const bool is_loaded = scaled.loaded && scaled.loaded->frame == request.frame;
    for (const PipelineStep& step : request.look->pipeline.steps) {
        for (const MissingRole& missing : all_missing)
            if (missing.who.starts_with("step '" + step.name + "' ")) return step.name;
        if (!is_loaded) continue;
        const FrameInputs frame = FrameSetting{}.inputs(*scaled.loaded->captures.front());
        try {
            for (const ParamSpec& spec : step.manifest->params) resolve_param(step, spec, frame);
        } catch (const Error&) {
            return step.name;
        }
    }
    return "";
}

const Capture& PictureMaker::whole_capture(int frame) {
    if (!whole_ || whole_frame_ != frame) {
        whole_.reset();
        objects_.reset();
        const int number = sequence_.file_number(frame, sequence_.subframes / 2);
        whole_ = std::make_unique<Capture>(reader_.read(number, header_of(frame).roles));
        whole_frame_ = frame;
    }
    return *whole_;
}

const FrameObjects& PictureMaker::frame_objects(int frame) {
    const Capture& whole = whole_capture(frame);
    const int number = sequence_.file_number(frame, sequence_.subframes / 2);
    if (!objects_) objects_.emplace(reader_, sequence_, number, whole);
    return *objects_;
}

nlohmann::ordered_json PictureMaker::objects(int frame) {
    return frame_objects(frame).list(reader_, sequence_.file_number(frame, sequence_.subframes / 2));
}

const Capture& PictureMaker::truth(int frame, const std::string& name) {
    const std::pair key(frame, name);
    if (!truth_ || truth_key_ != key) {
        truth_.reset();
        truth_ = std::make_unique<Capture>(read_truth(sequence_, frame, name, header_of(frame), limits_));
        truth_key_ = key;
    }
    return *truth_;
}

const Image& PictureMaker::made_color(const PictureRequest& request) {
    PictureRequest full = request;
    full.scale = 1;
    full.view = std::string("role:") + kColorRole;
    const Scaled& scaled = draw(full);
    const auto made = scaled.result.images.find(kColorRole);
    if (made != scaled.result.images.end()) return made->second;
    return whole_capture(request.frame).images.at(kColorRole);
}

nlohmann::ordered_json PictureMaker::metrics(const PictureRequest& request, const std::string& name) {
    return metrics_json(name, truth(request.frame, name), made_color(request));
}

/// By channel, in linear light, so that the viewer's exposure makes small ones visible.
ShownView PictureMaker::difference(const PictureRequest& request, const std::string& name) {
    const Capture& reference = truth(request.frame, name);
    Capture apart;
    apart.header = reference.header;
    apart.images.emplace(kColorRole,
                         absolute_difference(reference.images.at(kColorRole), made_color(request)));
    return view_picture({"before", request.exposure_ev, {}, apart});
}

CaptureHeader PictureMaker::header_of(int frame) const {
    return reader_.read_header(sequence_.file_number(frame, sequence_.subframes / 2));
}

std::string PictureMaker::focused_on_surface(const std::string& text, int frame) {
    constexpr std::string_view kMiddle = "\"uv\": [0.5, 0.5]";
    const std::size_t at = text.find(kMiddle);
    if (at == std::string::npos) return text;
    const auto place = nearest_surface(whole_capture(frame));
    if (!place) return text;
    const auto [u, v] = *place;
    return text.substr(0, at) + fmt::format("\"uv\": [{:.4g}, {:.4g}]", u, v) +
           text.substr(at + kMiddle.size());
}

nlohmann::ordered_json PictureMaker::probe(const PictureRequest& request, int x, int y) {
    const Capture& whole = whole_capture(request.frame);
    nlohmann::ordered_json json = probe_json(whole, x, y);
    json["objects"] = frame_objects(request.frame).at(place_of_pixel(whole.header, x, y));
    PictureRequest full = request;
    full.scale = 1;
    full.view = "final";
    json["result"] = nullptr;
    try {
        Scaled& scaled = draw(full);
        json["result"] = result_at(scaled.result, scaled.loaded->captures.front()->header, x, y);
    } catch (const Error& error) {
        // What the capture has stays there to be picked, which may be what mends the step.
        if (error.kind() != ErrorKind::capture) throw;
    }
    return json;
}

nlohmann::ordered_json PictureMaker::histogram(const PictureRequest& request) {
    PictureRequest full = request;
    full.view = "final";
    try {
        return histogram_json(picture(draw(full), full).picture);
    } catch (const Error& error) {
        const auto view = error.kind() == ErrorKind::capture ? view_without_steps(full) : std::nullopt;
        if (!view) throw;
        return histogram_json(view->picture);
    }
}

}  // namespace aftershade::serve
