#include "framework/look/ease.h"

#include <algorithm>

#include "framework/base/diagnostics.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

/// A coordinate of the curve at `s`; its ends are 0 and 1.
double bezier(double first, double second, double s) {
    return 3 * (1 - s) * (1 - s) * s * first + 3 * (1 - s) * s * s * second + s * s * s;
}

std::optional<Ease> curve_of(const Node& node) {
    Ease ease{Ease::Kind::curve, {}};
    if (node.items.size() != ease.handles.size()) return std::nullopt;
    for (std::size_t i = 0; i < ease.handles.size(); ++i) {
        const Node& item = node.items[i];
        if (!item.is_number() || !(item.number >= 0 && item.number <= 1)) return std::nullopt;
        ease.handles[i] = item.number;
    }
    return ease;
}

}  // namespace

/// In the order of Ease::Kind.
const std::vector<std::string>& ease_names() {
    static const std::vector<std::string> names = {"linear", "smooth", "step"};
    return names;
}

double Ease::share(double of_frames) const {
    if (kind == Kind::step) return of_frames < 1 ? 0 : 1;
    if (kind == Kind::smooth) return of_frames * of_frames * (3 - 2 * of_frames);
    if (kind == Kind::linear) return of_frames;
    // x never falls where its handles are from 0 to 1, so bisection finds its one place: to the last bit.
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (bezier(handles[0], handles[2], middle) < of_frames ? low : high) = middle;
    }
    return bezier(handles[1], handles[3], high);
}

std::optional<Ease> read_ease(ObjectReader& reader, const std::string& label, Diagnostics& diagnostics) {
    const Node* node = reader.any("interpolation");
    if (!node) return std::nullopt;
    const auto& names = ease_names();
    if (node->is_array())
        if (const auto curve = curve_of(*node)) return curve;
    const auto name = std::ranges::find(names, node->string);
    if (node->is_string() && name != names.end()) return Ease{Ease::Kind(name - names.begin()), {}};
    diagnostics.error(node->place,
                      label + ": 'interpolation' is " + list_of_names(names) +
                          ", or the handles of a curve, [x1, y1, x2, y2], four numbers from 0 to 1" +
                          (node->is_string() ? did_you_mean(node->string, names) : ""));
    return std::nullopt;
}

std::string format_ease(const Ease& ease) {
    if (ease.kind != Ease::Kind::curve) return "\"" + ease_names()[std::size_t(ease.kind)] + "\"";
    std::string text;
    for (const double handle : ease.handles) text += (text.empty() ? "" : ", ") + format_number(handle);
    return "[" + text + "]";
}

}  // namespace aftershade
