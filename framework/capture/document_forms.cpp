#include "framework/capture/document_forms.h"

#include "framework/image/color_space.h"
#include "framework/capture/frame_range.h"
#include "framework/image/role.h"

namespace aftershade {

grammar::Form role_form() {
    return grammar::name_of(role_names(), "a role", kAovPattern);
}

grammar::Form frame_range_form(const std::string& fault) {
    const auto is_range = [](const std::string& text) {
        const auto frames = parse_frame_range(text);
        return frames && !frames->empty();
    };
    return grammar::text({.pattern = frame_range_pattern(),
                          .fits = is_range,
                          .fault = fault,
                          .type = "range such as \"1-24\" or \"1-100x2,120\"",
                          .noun = "a range of frames"});
}

grammar::Form color_space_form() {
    std::vector<std::string> names = color_space_names();
    names.insert(names.begin(), "auto");
    return grammar::choice(std::move(names));
}

}  // namespace aftershade
