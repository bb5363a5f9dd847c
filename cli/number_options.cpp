#include "cli/number_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "framework/base/text.h"

namespace aftershade::cli {

namespace {

constexpr std::uint64_t kMostBytes = std::uint64_t(1) << 60;
constexpr unsigned kBitsOfUnit = 10;

/// 0 for a text that is not a number of bytes, or is above kMostBytes.
std::uint64_t bytes_of(std::string_view text) {
    std::uint64_t number = 0;
    const auto [at, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    std::string unit = lower_case(text.substr(std::size_t(at - text.data())));
    unit.erase(0, unit.find_first_not_of(' '));
    unsigned bits = 0;
    if (!unit.empty() && unit != "b") {
        constexpr std::string_view kPrefixes = "kmgtpe";
        const std::size_t prefix = kPrefixes.find(unit.front());
        const std::string rest = unit.substr(1);
        if (prefix == std::string_view::npos || (!rest.empty() && rest != "b" && rest != "i" && rest != "ib"))
            return 0;
        bits = kBitsOfUnit * unsigned(prefix + 1);
    }
    return failure == std::errc{} && number <= kMostBytes >> bits ? number << bits : 0;
}

std::string fault_of_float(std::string& text) {
    return lower_case(text).find("nan") != std::string::npos ? text + " is not a number" : "";
}

std::string fault_of_unsigned(std::string& text) {
    const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
    if (text.substr(begin).starts_with('-')) return text + " is below 0";
    std::uint64_t number = 0;
    const auto read = std::from_chars(text.data() + begin, text.data() + text.size(), number);
    return read.ec == std::errc::result_out_of_range ? text + " is above 18446744073709551615" : "";
}

}  // namespace

CLI::Option* takes_bytes(CLI::Option* option) {
    return option->transform(CLI::Validator(
        [](std::string& text) -> std::string {
            const std::uint64_t bytes = bytes_of(text);
            if (bytes == 0) return text + " is not a number of bytes from 1 to 1EB, such as 4GB";
            text = std::to_string(bytes);
            return "";
        },
        "SIZE"));
}

void refuse_odd_numbers(CLI::App& app) {
    for (CLI::Option* option : app.get_options()) {
        const std::string type = option->get_type_name();
        // transform() puts it before the limits of the option itself.
        if (type.find("FLOAT") != std::string::npos) option->transform(CLI::Validator(fault_of_float, ""));
        else if (type.find("UINT") != std::string::npos)
            option->transform(CLI::Validator(fault_of_unsigned, ""));
    }
    for (CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
        refuse_odd_numbers(*verb);
}

}  // namespace aftershade::cli
