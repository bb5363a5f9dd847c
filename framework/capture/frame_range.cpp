#include "framework/capture/frame_range.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <unordered_set>
#include <utility>

#include "framework/base/text.h"
#include "framework/base/whole_number.h"

namespace aftershade {

namespace {

bool take(std::string_view& text, std::string_view word) {
    if (!text.starts_with(word)) return false;
    text.remove_prefix(word.size());
    return true;
}

constexpr std::size_t kMaxDigits = 9;

/// Takes a number of at most kMaxDigits digits off the front.
std::optional<int> take_number(std::string_view& text) {
    const std::size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (digits > kMaxDigits) return std::nullopt;
    const auto number = whole_number(text.substr(0, digits));
    text.remove_prefix(digits);
    return number;
}

std::optional<int> take_signed_number(std::string_view& text) {
    const int sign = take(text, "-") ? -1 : 1;
    const auto number = take_number(text);
    return number ? std::optional(sign * *number) : std::nullopt;
}

struct Piece {
    int first = 0, last = 0, step = 1;
};

/// "7", "1-100", "1..100x2", "1-100:2", with white space around.
std::optional<Piece> parse_piece(std::string_view text) {
    constexpr std::string_view kSpace = " \t\n\v\f\r";
    text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
    text = text.substr(0, text.find_last_not_of(kSpace) + 1);
    const auto first = take_signed_number(text);
    if (!first) return std::nullopt;
    Piece piece{*first, *first, 1};
    if (take(text, "-") || take(text, "..")) {
        const auto last = take_signed_number(text);
        const auto step = take(text, "x") || take(text, ":") ? take_number(text) : 1;
        if (!last || !step) return std::nullopt;
        piece.last = *last;
        piece.step = *step;
    }
    return text.empty() ? std::optional(piece) : std::nullopt;
}

/// "%d" or "%04d": how much of the text it is, and the width.
struct PrintfStyle {
    std::size_t length = 0;
    int width = 1;
};

std::optional<PrintfStyle> parse_printf_style(std::string_view text) {
    std::string_view rest = text;
    if (!take(rest, "%")) return std::nullopt;
    PrintfStyle style;
    if (take(rest, "0")) {
        const std::string_view width = rest.substr(0, rest.find_first_not_of("0123456789"));
        if (width.empty() || width.size() > 2) return std::nullopt;
        style.width = *take_number(rest);
    }
    if (!take(rest, "d")) return std::nullopt;
    style.length = text.size() - rest.size();
    return style;
}

}  // namespace

std::optional<std::vector<int>> parse_frame_range(std::string_view text) {
    std::vector<int> frames;
    std::unordered_set<int> seen;
    for (const std::string_view part : split(text, ',')) {
        const auto piece = parse_piece(part);
        if (!piece) return std::nullopt;
        const auto [first, last, step] = *piece;
        if (step == 0 || std::size_t(std::abs(last - first) / step) >= kMaxRangeFrames) return std::nullopt;
        const int direction = last >= first ? step : -step;
        for (int frame = first; direction > 0 ? frame <= last : frame >= last; frame += direction)
            if (seen.insert(frame).second) frames.push_back(frame);
        if (frames.size() > kMaxRangeFrames) return std::nullopt;
    }
    return frames;
}

std::string frame_range_fault(std::string_view text) {
    if (parse_frame_range(text)) return "";
    std::size_t digits = 0, most_digits = 0;
    for (const char c : text)
        most_digits = std::max(most_digits, digits = c >= '0' && c <= '9' ? digits + 1 : 0);
    const auto is_sound = [](std::string_view part) {
        const auto piece = parse_piece(part);
        return piece && piece->step != 0;
    };
    if (most_digits <= kMaxDigits && !std::ranges::all_of(split(text, ','), is_sound))
        return "not a frame range such as 1-100x2,120";
    return "too long: a range names at most " + std::to_string(kMaxRangeFrames) +
           " frames, with numbers of at most " + std::to_string(kMaxDigits) + " digits (split the run)";
}

std::string format_frame_range(std::span<const int> frames) {
    std::string text;
    for (std::size_t first = 0; first < frames.size();) {
        std::size_t last = first;
        const std::int64_t step =
            first + 1 < frames.size() ? std::int64_t(frames[first + 1]) - frames[first] : 0;
        while (last + 1 < frames.size() && std::int64_t(frames[last + 1]) - frames[last] == step) ++last;
        // Two frames with a step are as short apart, and a step between them would mean nothing.
        if (last == first + 1 && std::abs(step) != 1) last = first;
        if (!text.empty()) text += ",";
        text += std::to_string(frames[first]);
        if (last > first) text += "-" + std::to_string(frames[last]);
        if (last > first && std::abs(step) != 1) text += "x" + std::to_string(std::abs(step));
        first = last + 1;
    }
    return text;
}

std::string frame_range_pattern() {
    const std::string piece = R"(\s*-?[0-9]{1,9}((-|\.\.)-?[0-9]{1,9}([x:](?!0+(?![0-9]))[0-9]{1,9})?)?\s*)";
    return "^" + piece + "(," + piece + ")*$";
}

FramePattern::FramePattern(std::string text) : text_(std::move(text)) {
    const std::size_t folder = text_.rfind('/');
    const std::size_t name = folder == std::string::npos ? 0 : folder + 1;
    for (const char mark : {'#', '@'}) {
        const std::size_t found = text_.find(mark, name);
        if (found == std::string::npos) continue;
        start_ = found;
        length_ = std::min(text_.find_first_not_of(mark, found), text_.size()) - found;
        width_ = int(length_);
        return;
    }
    for (std::size_t at = text_.find('%', name); at != std::string::npos; at = text_.find('%', at + 1))
        if (const auto style = parse_printf_style(std::string_view(text_).substr(at))) {
            start_ = at;
            length_ = style->length;
            width_ = style->width;
            return;
        }
}

FramePattern FramePattern::of_file(std::string name) {
    FramePattern file("");
    file.text_ = std::move(name);
    return file;
}

std::string FramePattern::path(int frame) const {
    if (!has_frame()) return text_;
    if (const auto other = other_names_.find(frame); other != other_names_.end()) return other->second;
    std::string digits = std::to_string(std::abs(std::int64_t(frame)));
    const std::size_t width = std::size_t(width_) - (frame < 0 && width_ > 1 ? 1 : 0);
    if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
    if (frame < 0) digits.insert(0, "-");
    return with(digits);
}

std::string FramePattern::with(std::string_view number) const {
    return has_frame() ? text_.substr(0, start_).append(number) + text_.substr(start_ + length_) : text_;
}

std::optional<int> FramePattern::match(std::string_view name) const {
    const auto frame = number_in(name);
    return frame && path(*frame) == name ? frame : std::nullopt;
}

std::optional<int> FramePattern::number_in(std::string_view name) const {
    const std::size_t fixed = text_.size() - length_;
    if (!has_frame() || name.size() <= fixed) return std::nullopt;
    const std::size_t digits = name.size() - fixed;
    if (name.substr(0, start_) != std::string_view(text_).substr(0, start_)) return std::nullopt;
    const std::string_view end = name.substr(start_ + digits);
    const std::string_view own_end = std::string_view(text_).substr(start_ + length_);
    // Of the extension, its case says nothing.
    const std::size_t dot = std::min(own_end.rfind('.'), own_end.size());
    if (end.substr(0, dot) != own_end.substr(0, dot) ||
        lower_case(end.substr(dot)) != lower_case(own_end.substr(dot)))
        return std::nullopt;
    return whole_number(name.substr(start_, digits));
}

std::optional<int> frame_in_name(std::string_view stem) {
    const std::size_t last = stem.find_last_of("0123456789");
    if (last == std::string_view::npos) return std::nullopt;
    std::size_t first = last;
    while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
    return whole_number(stem.substr(first, last - first + 1));
}

}  // namespace aftershade
