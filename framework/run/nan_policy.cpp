#include "framework/run/nan_policy.h"

#include <cmath>

#include "framework/base/diagnostics.h"
#include "framework/base/option.h"
#include "framework/file/exr_file.h"
#include "framework/image/role.h"

namespace aftershade {

namespace {

bool may_be_infinite(const RoleId& role) {
    const auto known = find_role(role);
    return known && std::isinf(known->outside);
}

NonFinitePixels check_image(NanPolicy policy, Image& image, bool infinity_allowed) {
    return policy == NanPolicy::mend ? mend_non_finite(image, infinity_allowed, exr_threads())
                                     : find_non_finite(image, infinity_allowed, exr_threads());
}

/// "12 NaN and 3 infinite pixels, the first at (30, 17)".
std::string counts_text(const NonFinitePixels& pixels) {
    std::string text;
    if (pixels.nan > 0) text = std::to_string(pixels.nan) + " NaN";
    if (pixels.infinite > 0)
        text += (text.empty() ? "" : " and ") + std::to_string(pixels.infinite) + " infinite";
    return text + (pixels.count() == 1 ? " pixel, at (" : " pixels, the first at (") +
           std::to_string(pixels.x) + ", " + std::to_string(pixels.y) + ")";
}

std::string mended_text(const NonFinitePixels& pixels) {
    std::string text = "; replaced by the mean of the finite pixels around them";
    if (pixels.zeroed > 0)
        text += ", but " + std::to_string(pixels.zeroed) + " have none within " +
                std::to_string(kMendRadius_px) + " px and became 0";
    return text;
}

/// What decoding makes of NaN; "" where it keeps it.
std::string decoded_as(const RoleId& role) {
    const auto kind = kind_of_role(role);
    if (kind == RoleKind::distance) return "no hit";
    return kind == RoleKind::motion ? "no motion data" : "";
}

std::string decoded_text(NanPolicy policy, const RoleId& role) {
    const std::string decoded = decoded_as(role);
    return policy == NanPolicy::fail || decoded.empty() ? "" : "; read as " + decoded;
}

std::string remedy(NanPolicy policy, const RoleId& role = "") {
    const std::string decoded = decoded_as(role);
    const std::string mend = spelled(Option::on_nan, "mend") + " replaces such pixels";
    const std::string fail = spelled(Option::on_nan, "fail");
    if (policy != NanPolicy::fail)
        return " (" + (decoded.empty() ? mend + ", " : "") + fail + " leaves such frames out)";
    return "; the frame is left out (" + fail + "; " +
           (decoded.empty() ? mend : spelled(Option::on_nan, "warn") + " reads them as " + decoded) + ")";
}

std::string source_text(const Capture& capture) {
    std::vector<std::string> roles;
    for (const auto& [role, pixels] : capture.non_finite)
        if (pixels.mended == 0) roles.push_back(role.name());
    if (roles.empty())
        return "; what effects read has none, so an effect made them" +
               advice(": ", Option::audit, "", " names its pass");
    return "; the capture has them in " + list_of_names(roles, "and");
}

}  // namespace

void apply_nan_policy(NanPolicy policy, Capture& capture) {
    const Window& window = capture.header.data_window;
    for (auto& [role, found] : capture.non_finite) {
        found.x += window.min_x;
        found.y += window.min_y;
    }
    for (auto& [role, image] : capture.images) {
        NonFinitePixels found = check_image(policy, image, may_be_infinite(role));
        if (!found) continue;
        found.x += window.min_x;
        found.y += window.min_y;
        capture.non_finite[role] = found;
    }
}

std::vector<NonFiniteOutput> apply_nan_policy(NanPolicy policy, FrameResult& result) {
    std::vector<NonFiniteOutput> outputs;
    for (auto& [role, image] : result.images) {
        if (result.finite_roles.contains(role)) continue;
        if (const NonFinitePixels found = check_image(policy, image, may_be_infinite(role)))
            outputs.push_back({role, found});
    }
    for (const auto& [tap, image] : result.taps)
        if (const NonFinitePixels found = find_non_finite(image, true, exr_threads()))
            outputs.push_back({tap, found});
    return outputs;
}

std::vector<std::string> describe_non_finite(NanPolicy policy, const Capture& capture) {
    std::vector<std::string> sentences;
    for (const auto& [role, pixels] : capture.non_finite)
        sentences.push_back("frame " + std::to_string(capture.header.frame) + ": the role '" + role.name() +
                            "' of " + capture.header.path.string() + " has " + counts_text(pixels) +
                            decoded_text(policy, role) +
                            (pixels.mended > 0 ? mended_text(pixels) : remedy(policy, role)));
    return sentences;
}

std::vector<std::string> describe_non_finite(NanPolicy policy, const std::vector<NonFiniteOutput>& outputs,
                                             const Capture& capture) {
    std::vector<std::string> sentences;
    for (const auto& [name, pixels] : outputs)
        sentences.push_back("frame " + std::to_string(capture.header.frame) + ": the output '" + name +
                            "' has " + counts_text(pixels) + source_text(capture) +
                            (pixels.mended > 0 ? mended_text(pixels) : remedy(policy)));
    return sentences;
}

}  // namespace aftershade
