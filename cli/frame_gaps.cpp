#include "cli/frame_gaps.h"

#include <string>

#include "framework/capture/frame_range.h"

namespace aftershade::cli {

namespace {

/// "2nd", "3rd", "12th".
std::string ordinal(int number) {
    const int last = number / 10 % 10 == 1 ? 0 : number % 10;
    return std::to_string(number) + (last == 1 ? "st" : last == 2 ? "nd" : last == 3 ? "rd" : "th");
}

}  // namespace

void add_missing_frames(const CaptureOptions& options, MissingFrame missing, Sequence& sequence,
                        Diagnostics& diagnostics) {
    if (sequence.frames_declared || !options.frames.empty() || sequence.frames.empty()) return;
    const Place place{options.capture};
    const FrameGaps gaps = find_gaps(sequence.frames);
    const std::string range =
        std::to_string(sequence.frames.front()) + "-" + std::to_string(sequence.frames.back());
    if (gaps.step > 1)
        diagnostics.warning(place, "only every " + ordinal(gaps.step) + " frame of " + range +
                                       " is there; the sequence is taken to have that step (--frames " +
                                       range + " runs all frames)");
    if (gaps.count == 0) return;
    if (gaps.whole.empty()) {
        const std::string text = std::to_string(gaps.count) + " frames of " + range + " are missing";
        if (missing == MissingFrame::skip) diagnostics.warning(place, text + "; they are left out");
        else diagnostics.error(place, text + "; choose frames with --frames");
        return;
    }
    if (missing == MissingFrame::error)
        diagnostics.warning(place, (gaps.count == 1 ? "frame " : "frames ") +
                                       format_frame_range(gaps.missing) + " of " + range +
                                       (gaps.count == 1 ? " is" : " are") +
                                       " missing (--missing skip leaves such frames out, --missing hold "
                                       "repeats the one before)");
    sequence.frames = gaps.whole;
}

}  // namespace aftershade::cli
