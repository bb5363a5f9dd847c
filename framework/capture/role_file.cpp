#include "framework/capture/role_file.h"

#include <algorithm>
#include <cmath>

#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/capture/frame_file.h"
#include "framework/document/units.h"

namespace aftershade {

namespace {

std::string window_text(const Window& window) {
    return std::to_string(window.width()) + " x " + std::to_string(window.height()) + " px at (" +
           std::to_string(window.min_x) + ", " + std::to_string(window.min_y) + ")";
}

/// Both have the matrix, and it is another one beyond the rounding of floats.
bool has_other_matrix(const ExrMetadata& own, const ExrMetadata& others, const std::string& name) {
    constexpr float kRounding = 1e-4f;
    const auto stored = own.value(name), other = others.value(name);
    const auto* const a = stored ? std::get_if<std::vector<float>>(&*stored) : nullptr;
    const auto* const b = other ? std::get_if<std::vector<float>>(&*other) : nullptr;
    if (!a || !b || a->size() != b->size()) return false;
    return !std::ranges::equal(*a, *b, [](float x, float y) {
        return !(std::abs(x - y) > kRounding * std::max({std::abs(x), std::abs(y), 1.0f}));
    });
}

}  // namespace

void require_one_picture(const std::string& role, const FrameFile& file, const FrameFile& main) {
    const ExrPart& own = file.merged();
    const ExrPart& picture = main.merged();
    if (own.display_window == picture.display_window || own.data_window == picture.data_window) return;
    throw Error(ErrorKind::capture,
                file.path().string() + ": the role '" + role + "' has a display window of " +
                    window_text(own.display_window) + ", but that of " + main.path().string() + " is " +
                    window_text(picture.display_window) +
                    " (render both at one size; a crop keeps the whole picture's display window)");
}

std::vector<std::string> role_file_faults(const std::string& role, const FrameFile& file,
                                          const FrameFile& main) {
    const ExrPart &own = file.merged(), &picture = main.merged();
    const std::string begin = role + " is read from a file ";
    std::vector<std::string> faults;
    if (own.pixel_aspect != picture.pixel_aspect)
        faults.push_back(begin + "with pixel aspect " + format_number(double(own.pixel_aspect)) +
                         ", color from one with " + format_number(double(picture.pixel_aspect)) +
                         "; its pixels are taken as those of color (render both alike)");
    if (!(own.display_window == picture.display_window))
        faults.push_back(begin + "with a display window of " + window_text(own.display_window) +
                         ", color from one of " + window_text(picture.display_window) +
                         "; their data windows are equal, so its pixels are taken as those of color (render "
                         "both alike)");
    if (file.view() != main.view() && !file.view().empty() && !main.view().empty())
        faults.push_back(begin + "in the view '" + file.view() + "', color in '" + main.view() +
                         "' (choose one view for both with " + spelled(Option::view) +
                         ", or 'view' in capture.json)");
    for (const char* matrix : {"worldToCamera", "worldToNDC", "worldToScreen", "cameraTransform"})
        if (has_other_matrix(own.metadata, picture.metadata, matrix)) {
            faults.push_back(begin + "whose " + matrix +
                             " is another than that of color: it may be of another camera or frame (name the "
                             "file that was rendered with color)");
            break;
        }
    return faults;
}

}  // namespace aftershade
