#include "framework/render/graph_key.h"

#include <algorithm>

#include "framework/look/pixel_shape.h"

namespace aftershade {

namespace {

using About = GraphQuestion::About;

template <typename Value>
Value found_or(const std::map<std::string, Value>& values, const std::string& name, Value otherwise) {
    const auto found = values.find(name);
    return found == values.end() ? otherwise : found->second;
}

std::vector<double> square_pixels_of(const GraphFrame& frame) {
    const CaptureHeader& header = frame.inputs.capture->header;
    const SquareSteps steps(frame.pipeline, header.pixel_aspect);
    const PixelStretch& stretch = steps.stretch();
    if (stretch.is_none()) return {};
    const Window &data = header.data_window, &display = header.display_window;
    const Window window = stretched(data, display, stretch);
    const int first_px = stretch.axis == 0 ? data.min_x - display.min_x : data.min_y - display.min_y;
    return {double(stretch.axis),   double(stretch.to),
            double(stretch.from),   double(stretch.phase(first_px)),
            double(window.width()), double(window.height())};
}

std::vector<double> display_window_of(const GraphFrame& frame, bool is_square) {
    const CaptureHeader& header = frame.inputs.capture->header;
    const PixelStretch stretch =
        is_square ? SquareSteps(frame.pipeline, header.pixel_aspect).stretch() : PixelStretch{};
    const Window data = stretched(header.data_window, header.display_window, stretch);
    const Window display = stretched(header.display_window, header.display_window, stretch);
    return {double(display.min_x - data.min_x), double(display.min_y - data.min_y), double(display.width()),
            double(display.height())};
}

ParamValue answer_to(const GraphQuestion& question, const GraphFrame& frame) {
    const std::string& name = question.name;
    const auto native = [&]() -> const NativeResult& { return *frame.natives.result(question.of); };
    switch (question.about) {
        case About::width_px: return std::int64_t(frame.inputs.capture->header.data_window.width());
        case About::height_px: return std::int64_t(frame.inputs.capture->header.data_window.height());
        case About::square_pixels: return square_pixels_of(frame);
        case About::display_window: return display_window_of(frame, question.of == 1);
        case About::image: return frame.inputs.has_image(name, question.of);
        case About::wanted_role:
            return std::find(frame.roles.begin(), frame.roles.end(), name) != frame.roles.end();
        case About::param: {
            const PipelineStep& step = frame.pipeline.steps[std::size_t(question.of)];
            return aspect_of(*step.manifest->find_param(name),
                             frame.params[std::size_t(question.of)].get(name), question.aspect);
        }
        case About::native_enabled: return found_or(native().enabled, name, true);
        case About::native_turns: return std::int64_t(found_or(native().repeats, name, -1));
        case About::native_table: break;
    }
    const NativeTable& table = native().tables.at(name);
    return std::vector<double>{double(table.width), double(table.height)};
}

}  // namespace

bool GraphKey::holds(const GraphFrame& frame) const {
    return std::all_of(answers_.begin(), answers_.end(), [&](const auto& asked) {
        const auto& [question, answer] = asked;
        // Most questions are of this kind: no copy.
        if (question.about == About::param && question.aspect == ParamAspect::value)
            return frame.params[std::size_t(question.of)].get(question.name) == answer;
        return answer_to(question, frame) == answer;
    });
}

bool GraphKey::asked(const GraphQuestion& question) const {
    return std::any_of(answers_.begin(), answers_.end(),
                       [&](const auto& asked) { return asked.first == question; });
}

const ParamValue& GraphFrameReader::ask(const GraphQuestion& question) {
    const auto known = answers_.find(question);
    if (known != answers_.end()) return known->second;
    return answers_.emplace(question, answer_to(question, frame_)).first->second;
}

int GraphFrameReader::width_px() {
    return int(std::get<std::int64_t>(ask({About::width_px, 0, ""})));
}

int GraphFrameReader::height_px() {
    return int(std::get<std::int64_t>(ask({About::height_px, 0, ""})));
}

GraphFrameReader::SquareGrid GraphFrameReader::square_pixels() {
    const auto& values = std::get<std::vector<double>>(ask({About::square_pixels, 0, ""}));
    if (values.empty()) return {};
    return {{int(values[0]), std::int64_t(values[1]), std::int64_t(values[2])},
            int(values[3]),
            int(values[4]),
            int(values[5])};
}

GraphFrameReader::DisplayWindow GraphFrameReader::display_window(bool is_square) {
    const auto& values = std::get<std::vector<double>>(ask({About::display_window, is_square ? 1 : 0, ""}));
    return {int(values[0]), int(values[1]), int(values[2]), int(values[3])};
}

bool GraphFrameReader::has_image(const RoleId& role, int offset) {
    return std::get<bool>(ask({About::image, offset, role.name()}));
}

bool GraphFrameReader::wants(const std::string& role) {
    return std::get<bool>(ask({About::wanted_role, 0, role}));
}

ParamReader GraphFrameReader::params(int step) {
    return {frame_.params[std::size_t(step)],
            [this, step](const std::string& name, ParamAspect aspect, const ParamValue& answer) {
                answers_.try_emplace({About::param, step, name, aspect}, answer);
            }};
}

bool GraphFrameReader::native_enabled(int step, const std::string& pass) {
    return std::get<bool>(ask({About::native_enabled, step, pass}));
}

int GraphFrameReader::native_turns(int step, const std::string& pass, int otherwise) {
    const int turns = int(std::get<std::int64_t>(ask({About::native_turns, step, pass})));
    return turns < 0 ? otherwise : turns;
}

gpu::TextureDesc GraphFrameReader::native_table(int step, const NativeTableSpec& table) {
    const auto& size = std::get<std::vector<double>>(ask({About::native_table, step, table.name}));
    return table_desc(*parse_native_element(table.element), int(size[0]), int(size[1]));
}

}  // namespace aftershade
