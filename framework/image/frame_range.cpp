#include "framework/image/frame_range.h"

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <regex>
#include <unordered_set>
#include <utility>

namespace aftershade {

namespace {

constexpr std::size_t kMaxFrames = 1'000'000;

std::optional<int> parse_int(std::string_view text) {
    int value = 0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::optional<std::vector<int>> parse_frame_range(std::string_view text) {
    static const std::regex piece(R"(^\s*(-?\d{1,9})(?:(?:-|\.\.)(-?\d{1,9})(?:[x:](\d{1,9}))?)?\s*$)");
    std::vector<int> frames;
    std::unordered_set<int> seen;
    std::size_t start = 0;
    while (start <= text.size()) {
        const std::size_t comma = std::min(text.find(',', start), text.size());
        const std::string part(text.substr(start, comma - start));
        start = comma + 1;
        std::smatch match;
        if (!std::regex_match(part, match, piece)) return std::nullopt;
        const int first = *parse_int(match[1].str());
        const int last = match[2].matched ? *parse_int(match[2].str()) : first;
        const int step = match[3].matched ? *parse_int(match[3].str()) : 1;
        if (step == 0 || std::size_t(std::abs(last - first) / step) >= kMaxFrames) return std::nullopt;
        const int direction = last >= first ? step : -step;
        for (int frame = first; direction > 0 ? frame <= last : frame >= last; frame += direction)
            if (seen.insert(frame).second) frames.push_back(frame);
        if (frames.size() > kMaxFrames) return std::nullopt;
    }
    return frames;
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
    static const std::regex printf_style(R"(%(?:0(\d{1,2}))?d)");
    std::smatch match;
    const std::string tail = text_.substr(name);
    if (!std::regex_search(tail, match, printf_style)) return;
    start_ = name + std::size_t(match.position(0));
    length_ = std::size_t(match.length(0));
    width_ = match[1].matched ? *parse_int(match[1].str()) : 1;
}

std::string FramePattern::path(int frame) const {
    if (!has_frame()) return text_;
    std::string digits = std::to_string(std::abs(std::int64_t(frame)));
    const std::size_t width = std::size_t(width_) - (frame < 0 && width_ > 1 ? 1 : 0);
    if (digits.size() < width) digits.insert(0, width - digits.size(), '0');
    if (frame < 0) digits.insert(0, "-");
    return text_.substr(0, start_) + digits + text_.substr(start_ + length_);
}

std::optional<int> FramePattern::match(std::string_view name) const {
    const std::size_t fixed = text_.size() - length_;
    if (!has_frame() || name.size() <= fixed) return std::nullopt;
    const std::size_t digits = name.size() - fixed;
    if (name.substr(0, start_) != std::string_view(text_).substr(0, start_)) return std::nullopt;
    if (name.substr(start_ + digits) != std::string_view(text_).substr(start_ + length_)) return std::nullopt;
    const auto frame = parse_int(name.substr(start_, digits));
    return frame && path(*frame) == name ? frame : std::nullopt;
}

std::optional<int> frame_in_name(std::string_view stem) {
    const std::size_t last = stem.find_last_of("0123456789");
    if (last == std::string_view::npos) return std::nullopt;
    std::size_t first = last;
    while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
    return parse_int(stem.substr(first, last - first + 1));
}

}  // namespace aftershade
