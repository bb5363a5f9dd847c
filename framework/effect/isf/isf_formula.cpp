#include "framework/effect/isf/isf_formula.h"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "framework/document/formula.h"
#include "framework/document/units.h"
#include "framework/effect/manifest/manifest.h"

namespace aftershade {

namespace {

// Of a frame, for which a formula is computed before there is one.
constexpr double kUsualWidth = 1920, kUsualHeight = 1080;

std::optional<double> usual_value(const IsfFile& file, std::string_view name) {
    if (name == "$WIDTH") return kUsualWidth;
    if (name == "$HEIGHT") return kUsualHeight;
    for (const IsfInput& input : file.inputs) {
        const bool is_number = input.type == IsfInput::Type::number || input.type == IsfInput::Type::choice;
        if (is_number && name == "$" + input.name)
            return input.default_value ? input.default_value->number : 0;
    }
    return std::nullopt;
}

}  // namespace

void check_isf_side(const IsfFile& file, const IsfPass& pass, int axis, Diagnostics& diagnostics) {
    const bool is_checked = std::ranges::any_of(file.passes, [&](const IsfPass& other) {
        return &other < &pass && other.target == pass.target && other.side[axis] == pass.side[axis];
    });
    if (is_checked) return;
    const FormulaResult side =
        evaluate_formula(pass.side[axis], [&](std::string_view name) { return usual_value(file, name); });
    const std::string what =
        std::string(axis == 0 ? "WIDTH" : "HEIGHT") + " \"" + pass.side[axis].substr(0, 100) + "\"";
    if (!side.fault.empty())
        diagnostics.error(pass.side_place[axis],
                          what + ", at character " + std::to_string(side.at + 1) + ": " + side.fault +
                              " (it has numbers, $WIDTH, $HEIGHT, $ and the name of a float or long input, "
                              "+ - * /, brackets and functions)");
    else if (!(side.value <= kMaxSide))
        diagnostics.error(pass.side_place[axis], what + " is " + format_number(side.value) +
                                                     " for a frame of 1920 x 1080; the limit is " +
                                                     std::to_string(kMaxSide));
}

std::string native_formula(const std::string& side, const std::map<std::string, std::string>& names) {
    std::string formula;
    for (std::size_t i = 0; i < side.size();) {
        if (side[i] != '$') {
            formula += side[i++];
            continue;
        }
        std::size_t end = i + 1;
        while (end < side.size() && (std::isalnum(static_cast<unsigned char>(side[end])) || side[end] == '_'))
            ++end;
        const std::string name = side.substr(i + 1, end - i - 1);
        formula += name == "WIDTH" ? "width" : name == "HEIGHT" ? "height" : names.at(name);
        i = end;
    }
    return formula;
}

bool is_in_a_formula(const IsfFile& file, const std::string& input) {
    bool is_used = false;
    for (const IsfPass& pass : file.passes)
        for (const std::string& side : pass.side)
            (void)evaluate_formula(side, [&](std::string_view name) {
                is_used |= name == "$" + input;
                return usual_value(file, name);
            });
    return is_used;
}

}  // namespace aftershade
