#include "framework/document/formula.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace aftershade {

namespace {

using Numbers = std::array<double, 2>;
struct Function {
    std::string_view name;
    int arguments;
    double (*of)(const Numbers&);
};

constexpr std::array kFunctions = {
    Function{"abs", 1, [](const Numbers& x) { return std::abs(x[0]); }},
    Function{"ceil", 1, [](const Numbers& x) { return std::ceil(x[0]); }},
    Function{"floor", 1, [](const Numbers& x) { return std::floor(x[0]); }},
    Function{"max", 2, [](const Numbers& x) { return std::max(x[0], x[1]); }},
    Function{"min", 2, [](const Numbers& x) { return std::min(x[0], x[1]); }},
    Function{"mod", 2, [](const Numbers& x) { return x[0] - x[1] * std::floor(x[0] / x[1]); }},
    Function{"pow", 2, [](const Numbers& x) { return std::pow(x[0], x[1]); }},
    Function{"round", 1, [](const Numbers& x) { return std::round(x[0]); }},
    Function{"sqrt", 1, [](const Numbers& x) { return std::sqrt(x[0]); }},
    Function{"trunc", 1, [](const Numbers& x) { return std::trunc(x[0]); }}};

/// Recursive descent; after a fault every call returns 0 at once.
class Evaluator {
public:
    Evaluator(std::string_view text, const FormulaNames& value_of) : text_(text), value_of_(value_of) {}

    FormulaResult run() {
        if (text_.size() > kMaxFormulaBytes) {
            fault("the formula has more than " + std::to_string(kMaxFormulaBytes) +
                  " characters, which is the limit");
            return result_;
        }
        result_.value = sum();
        skip();
        if (at_ < text_.size()) fault("'" + std::string(1, text_[at_]) + "' is not expected here");
        return result_;
    }

private:
    void skip() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    bool take(char c) {
        skip();
        if (at_ >= text_.size() || text_[at_] != c) return false;
        ++at_;
        return true;
    }
    double fault(std::string text) {
        if (result_.fault.empty()) {
            result_.fault = std::move(text);
            result_.at = at_;
        }
        at_ = text_.size();
        return 0;
    }

    double sum() {
        double value = product();
        for (;;)
            if (take('+')) value += product();
            else if (take('-')) value -= product();
            else return value;
    }
    double product() {
        double value = factor();
        for (;;)
            if (take('*')) value *= factor();
            else if (take('/')) value /= factor();
            else return value;
    }
    double factor() {
        if (++depth_ > kMaxFormulaDepth)
            return fault("the formula has more than " + std::to_string(kMaxFormulaDepth) +
                         " brackets or signs one in another, which is the limit");
        const double value = take('-') ? -factor() : take('+') ? factor() : operand();
        --depth_;
        return value;
    }
    double operand() {
        if (take('(')) {
            const double value = sum();
            return take(')') ? value : fault("a ')' is missing");
        }
        skip();
        if (at_ >= text_.size()) return fault("the formula ends where a number or a name is expected");
        const char first = text_[at_];
        if (std::isdigit(static_cast<unsigned char>(first)) || first == '.') return number();
        if (std::isalpha(static_cast<unsigned char>(first)) || first == '_' || first == '$') return name();
        return fault("'" + std::string(1, first) + "' is not expected here");
    }
    double number() {
        double value = 0;
        // from_chars knows no ".5" without its 0 in front, so that one is added.
        const std::string digits = (text_[at_] == '.' ? "0" : "") + std::string(text_.substr(at_));
        const auto [end, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        if (failure != std::errc()) return fault("this is not a number");
        at_ += std::size_t(end - digits.data()) - (text_[at_] == '.' ? 1 : 0);
        return value;
    }
    double name() {
        const std::size_t begin = at_++;
        while (at_ < text_.size() &&
               (std::isalnum(static_cast<unsigned char>(text_[at_])) || text_[at_] == '_'))
            ++at_;
        const std::string_view word = text_.substr(begin, at_ - begin);
        if (take('(')) return call(word, begin);
        if (const auto value = value_of_(word)) return *value;
        at_ = begin;
        return fault("'" + std::string(word) + "' is not a number that it can use");
    }
    double call(std::string_view word, std::size_t begin) {
        const auto known = std::ranges::find(kFunctions, word, &Function::name);
        if (known == kFunctions.end()) {
            at_ = begin;
            return fault(
                "'" + std::string(word) +
                "' is not a function (known: abs, ceil, floor, max, min, mod, pow, round, sqrt, trunc)");
        }
        Numbers numbers{};
        for (int i = 0; i < known->arguments; ++i) {
            if (i > 0 && !take(','))
                return fault("'" + std::string(word) + "' takes " + std::to_string(known->arguments) +
                             " numbers");
            numbers[std::size_t(i)] = sum();
        }
        return take(')') ? known->of(numbers) : fault("a ')' is missing");
    }

    std::string_view text_;
    const FormulaNames& value_of_;
    std::size_t at_ = 0;
    int depth_ = 0;
    FormulaResult result_;
};

}  // namespace

FormulaResult evaluate_formula(std::string_view text, const FormulaNames& value_of) {
    return Evaluator(text, value_of).run();
}

}  // namespace aftershade
