#include "framework/capture/document_forms.h"

#include "framework/capture/frame_range.h"

namespace aftershade {

grammar::Form frame_range_form(const std::string& fault) {
    const auto is_range = [](const std::string& text) {
        const auto frames = parse_frame_range(text);
        return frames && !frames->empty();
    };
    return grammar::text({.pattern = {frame_range_pattern(), is_range},
                          .fault = fault,
                          .type = "range such as \"1-24\" or \"1-100x2,120\"",
                          .noun = "a range of frames"});
}

}  // namespace aftershade
