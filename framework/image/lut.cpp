#include "framework/image/lut.h"

#include "framework/base/atomic_file.h"
#include "framework/document/units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>

namespace aftershade {

namespace {

constexpr int kMaxFaults = 20;
constexpr std::uintmax_t kMaxCubeBytes = 1024u * 1024 * 1024;
constexpr int kMaxSize1d = 65536;
constexpr int kMaxSize3d = 256;

const std::vector<std::string> kKeywords = {
    "TITLE",      "LUT_1D_SIZE",        "LUT_3D_SIZE",       "DOMAIN_MIN",
    "DOMAIN_MAX", "LUT_1D_INPUT_RANGE", "LUT_3D_INPUT_RANGE"};

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

/// Takes the next word off the front of `line`; "" at its end.
std::string_view next_word(std::string_view& line) {
    while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
    const auto end = std::find_if(line.begin(), line.end(), is_space);
    const std::string_view word = line.substr(0, std::size_t(end - line.begin()));
    line.remove_prefix(word.size());
    return word;
}

/// Finite as a float too.
std::optional<double> parse_value(std::string_view word) {
    const auto value = parse_number(word);
    if (!value || std::abs(*value) > double(std::numeric_limits<float>::max())) return std::nullopt;
    return value;
}

class LutReader {
public:
    LutReader(const std::string& file, Diagnostics& diagnostics)
        : place_{file, 0, 1}, diagnostics_(diagnostics), errors_before_(diagnostics.error_count()) {}

    std::optional<Lut> read(std::string_view text) {
        while (!text.empty() && faults() < kMaxFaults) {
            const std::size_t end = std::min(text.find('\n'), text.size());
            ++place_.line;
            read_line(text.substr(0, end));
            text.remove_prefix(std::min(end + 1, text.size()));
        }
        if (faults() == 0) check_complete();
        if (faults() == kMaxFaults) fault("20 faults so far, the rest of the file is not read");
        return faults() > 0 ? std::nullopt : std::optional(std::move(lut_));
    }

private:
    int faults() const { return diagnostics_.error_count() - errors_before_; }
    void fault(std::string message) { diagnostics_.error(place_, std::move(message)); }

    std::size_t triples() const {
        const std::size_t size = std::size_t(lut_.size);
        return lut_.dimensions == 1 ? size : size * size * size;
    }

    void read_line(std::string_view line) {
        std::string_view rest = line;
        const std::string_view word = next_word(rest);
        if (word.empty() || word.front() == '#') return;
        const bool is_keyword = (word.front() >= 'A' && word.front() <= 'Z') || word.front() == '_';
        if (is_keyword) read_keyword(std::string(word), rest);
        else read_values(line);
    }

    void read_keyword(const std::string& keyword, std::string_view rest) {
        if (std::find(kKeywords.begin(), kKeywords.end(), keyword) == kKeywords.end())
            return fault("'" + keyword + "' is not a keyword of a .cube file" +
                         did_you_mean(keyword, kKeywords));
        if (!seen_.insert(keyword).second) return fault(keyword + " stands twice");
        if (!lut_.values.empty()) return fault(keyword + " must stand before the table");
        if (keyword == "TITLE") return read_title(rest);
        if (keyword == "LUT_1D_SIZE") return read_size(rest, 1, kMaxSize1d);
        if (keyword == "LUT_3D_SIZE") return read_size(rest, 3, kMaxSize3d);
        if (keyword == "DOMAIN_MIN") return read_domain(keyword, rest, lut_.domain_min);
        if (keyword == "DOMAIN_MAX") return read_domain(keyword, rest, lut_.domain_max);
        read_input_range(keyword, rest);
    }

    void read_title(std::string_view rest) {
        const std::size_t open = rest.find('"');
        const std::size_t close = rest.rfind('"');
        if (open == std::string_view::npos || open == close) return fault("TITLE needs a text in quotes");
        lut_.title = rest.substr(open + 1, close - open - 1);
    }

    void read_size(std::string_view rest, int dimensions, int limit) {
        const std::string_view word = next_word(rest);
        const auto size = parse_number(word);
        if (!next_word(rest).empty() || !size || *size != std::floor(*size) || *size < 2 || *size > limit)
            return fault(
                fmt::format("LUT_{}D_SIZE '{}' is not a whole number from 2 to {}", dimensions, word, limit));
        if (lut_.size != 0)
            return fault(
                "both LUT_1D_SIZE and LUT_3D_SIZE: a curve in front of a cube is not supported, bake "
                "it into one table");
        lut_.dimensions = dimensions;
        lut_.size = int(*size);
    }

    template <std::size_t kCount>
    std::optional<std::array<double, kCount>> numbers(std::string_view rest) {
        std::array<double, kCount> values{};
        for (double& value : values) {
            const auto number = parse_value(next_word(rest));
            if (!number) return std::nullopt;
            value = *number;
        }
        return next_word(rest).empty() ? std::optional(values) : std::nullopt;
    }

    void read_domain(const std::string& keyword, std::string_view rest, std::array<double, 3>& end) {
        const auto values = numbers<3>(rest);
        if (!values) return fault(keyword + " needs three numbers");
        end = *values;
    }

    void read_input_range(const std::string& keyword, std::string_view rest) {
        const auto ends = numbers<2>(rest);
        if (!ends) return fault(keyword + " needs two numbers");
        if (seen_.contains("DOMAIN_MIN") || seen_.contains("DOMAIN_MAX"))
            return fault(keyword + " and DOMAIN_MIN or DOMAIN_MAX are two ways to say the same, use one");
        lut_.domain_min.fill((*ends)[0]);
        lut_.domain_max.fill((*ends)[1]);
    }

    void read_values(std::string_view line) {
        if (lut_.size == 0) {
            fault("a table begins, but no LUT_1D_SIZE or LUT_3D_SIZE before it says how long it is");
            lut_.size = kMaxSize3d;  // said once
        }
        if (lut_.values.empty()) lut_.values.reserve(std::min(triples(), std::size_t{1} << 20) * 3);
        if (lut_.values.size() == triples() * 3)
            return fault(fmt::format("more than the {} lines of the table", triples()));
        const auto values = numbers<3>(line);
        if (!values) fault("expected three numbers, not '" + std::string(line.substr(0, 40)) + "'");
        const auto triple = values.value_or(std::array<double, 3>{});
        for (const double value : triple) lut_.values.push_back(float(value));
    }

    void check_complete() {
        if (lut_.size == 0) return fault("has no LUT_1D_SIZE or LUT_3D_SIZE");
        if (lut_.values.size() != triples() * 3)
            return fault(
                fmt::format("the table ends after {} of {} lines", lut_.values.size() / 3, triples()));
        for (std::size_t c = 0; c < 3; ++c)
            if (!(lut_.domain_min[c] < lut_.domain_max[c]))
                return fault(fmt::format("the domain of {} does not rise, it is {} to {}", "rgb"[c],
                                         format_number(lut_.domain_min[c]),
                                         format_number(lut_.domain_max[c])));
        const std::string other_range = lut_.dimensions == 1 ? "LUT_3D_INPUT_RANGE" : "LUT_1D_INPUT_RANGE";
        if (seen_.contains(other_range))
            fault(fmt::format("{} does not belong to a table of {} dimension{}", other_range, lut_.dimensions,
                              lut_.dimensions == 1 ? "" : "s"));
    }

    Place place_;
    Diagnostics& diagnostics_;
    int errors_before_;
    std::set<std::string> seen_;
    Lut lut_;
};

}  // namespace

std::optional<Lut> parse_lut(std::string_view text, const std::string& file, Diagnostics& diagnostics) {
    return LutReader(file, diagnostics).read(text);
}

std::optional<Lut> read_lut(const std::filesystem::path& path, Diagnostics& diagnostics) {
    std::string fault;
    const std::string text = read_regular_file(path, kMaxCubeBytes, fault);
    if (fault.empty()) return parse_lut(text, path.string(), diagnostics);
    diagnostics.error({path.string()}, fault);
    return std::nullopt;
}

}  // namespace aftershade
