// Frame numbers as people write them.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aftershade {

/// Frames that one text may name.
inline constexpr std::size_t kMaxRangeFrames = 1'000'000;

/// "7", "1-100", "1-100x2", "1-10:2", "1..10", "10-1" (backwards), "-5--1", and lists of these with commas.
/// Frames come in the order written; a frame that is named again is dropped. nullopt for anything else, for a
/// step of 0 and for more than kMaxRangeFrames frames.
std::optional<std::vector<int>> parse_frame_range(std::string_view text);

/// Why parse_frame_range() refuses the text, with the limit or an example; "" where it does not.
std::string frame_range_fault(std::string_view text);

/// The shortest such text for frames in this order: "1-100", "1-99x2,120".
std::string format_frame_range(std::span<const int> frames);

/// The same as a regular expression of ECMA-262, for schemas; it cannot count the frames.
std::string frame_range_pattern();

/// A file name with the frame number left open: "####" (padded to the number of #), "%04d", "%d", or "@" (no
/// padding;
/// "@@@@" pads).
class FramePattern {
public:
    explicit FramePattern(std::string text);
    /// A name without a frame number, with any marks.
    static FramePattern of_file(std::string name);
    bool has_frame() const { return length_ > 0; }
    const std::string& text() const { return text_; }
    std::string path(int frame) const;
    /// The file of `frame` has this name from now on, which is padded or spelled in another way.
    void name_otherwise(int frame, std::string name) {
        other_names_.insert_or_assign(frame, std::move(name));
    }
    /// The name with this text in the number's place.
    std::string with(std::string_view number) const;
    /// The frame number in `name` if the pattern fits it.
    std::optional<int> match(std::string_view name) const;
    /// The same, however the number is padded and in whichever case the extension is: "f_####.exr" fits
    /// "f_12.exr", "f_-0001.exr" and "f_0002.EXR".
    std::optional<int> number_in(std::string_view name) const;

private:
    std::string text_;
    std::size_t start_ = 0;
    std::size_t length_ = 0;  // of the placeholder
    int width_ = 0;           // digits, padded with zeros
    std::map<int, std::string> other_names_;
};

/// The last group of digits in a file's stem: "gbuffer_0004.exr" is frame 4.
std::optional<int> frame_in_name(std::string_view stem);

}  // namespace aftershade
