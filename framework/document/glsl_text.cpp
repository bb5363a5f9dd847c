#include "framework/document/glsl_text.h"

#include <algorithm>
#include <cctype>

#include "framework/document/units.h"

namespace aftershade {

std::string upper_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

std::string camel_case(const std::string& name) {
    std::string text;
    bool begins = true;
    for (const char c : name) {
        if (c != '_') text += begins ? char(std::toupper(static_cast<unsigned char>(c))) : c;
        begins = c == '_';
    }
    return text;
}

std::string filled(std::string_view text, const std::map<std::string, std::string>& values) {
    std::string result;
    for (std::size_t mark = text.find('$'); mark != text.npos; mark = text.find('$')) {
        const auto is_name = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; };
        const auto* end = std::find_if_not(text.begin() + mark + 1, text.end(), is_name);
        const std::size_t past = std::size_t(end - text.begin());
        const std::string name(text.substr(mark + 1, past - mark - 1));
        result += std::string(text.substr(0, mark)) + values.at(name);
        text.remove_prefix(past);
    }
    return result + std::string(text);
}

std::string glsl_float(double value) {
    std::string text = format_number(double(float(value)));
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return "(" + text + ")";
}

}  // namespace aftershade
