#include "framework/golden/golden_comment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "framework/base/text.h"
#include "framework/golden/report_page.h"
#include "framework/golden/report_pictures.h"

namespace aftershade {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

constexpr std::size_t kMostTextBytes = 300;       // of one cell
constexpr std::size_t kMostCommandBytes = 8000;   // of one command
constexpr std::size_t kMostCommentBytes = 60000;  // GitHub takes 65,536 characters
constexpr std::size_t kMostThumbnailRows = 8;

std::string text_of(const Json& value) {
    return value.is_string() ? value.get<std::string>() : "";
}

/// Without the rest of a long text; no character is cut.
std::string shortened(std::string text) {
    if (text.size() <= kMostTextBytes) return text;
    std::size_t end = kMostTextBytes;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return text.substr(0, end) + "…";
}

/// Text of a stranger as code: Markdown, HTML and mentions in it stay text, and a table keeps its cells.
std::string code(const std::string& text) {
    std::string plain = shortened(printable(text));
    std::ranges::replace(plain, '`', '\'');
    for (std::size_t at = 0; (at = plain.find('|', at)) != plain.npos; at += 2) plain.insert(at, "\\");
    return plain.empty() ? "" : "`" + plain + "`";
}

/// A block of code, whose fence is longer than any in it.
std::string block(const std::string& text) {
    std::size_t longest = 2, run = 0;
    for (const char c : text) longest = std::max(longest, run = c == '`' ? run + 1 : 0);
    const std::string fence(longest + 1, '`');
    return fence + "\n" + printable_lines(text) + "\n" + fence;
}

/// A path as a reference of RFC 3986.
std::string uri_of(const std::string& path) {
    std::string uri;
    for (const char c : path)
        if (std::isalnum(static_cast<unsigned char>(c)) ||
            std::string_view("/-._~").find(c) != std::string_view::npos)
            uri += c;
        else uri += fmt::format("%{:02X}", static_cast<unsigned char>(c));
    return uri;
}

bool is_bad(const Json& thing) {
    return text_of(thing.at("verdict")) != "same";
}

/// Failures before warnings, else in the suite's order.
std::vector<const Json*> bad_cases(const Json& report) {
    std::vector<const Json*> cases;
    for (const Json& test : report.at("cases"))
        if (is_bad(test)) cases.push_back(&test);
    std::ranges::stable_partition(cases, [](const Json* test) { return test->at("verdict") != "warning"; });
    return cases;
}

/// A figure of a report, which has words for those that JSON lacks.
double figure_of(const Json& value) {
    const std::string word = text_of(value);
    if (word == "inf" || word == "-inf" || word == "nan") return std::strtod(word.c_str(), nullptr);
    return value.is_number() ? value.get<double>() : 0;
}

std::int64_t whole_of(const Json& value) {
    constexpr std::int64_t kMost = 1'000'000'000;  // a stranger's report may hold any
    return value.is_number_integer() ? std::clamp(value.get<std::int64_t>(), -kMost, kMost) : 0;
}

/// The largest difference of an image's layers: "0.4375 at (176, 31) R". No number is larger than NaN.
std::string worst_of(const Json& image) {
    const Json& comparison = image.at("comparison");
    if (!comparison.is_object()) return "";
    std::string text;
    double most = 0;
    for (const Json& layer : comparison.at("layers")) {
        const Json& error = layer.at("max_error");
        if (!error.is_object()) continue;
        const double value = figure_of(error.at("value"));
        if (std::isnan(most) || (!std::isnan(value) && value <= most)) continue;
        most = value;
        text = fmt::format("{} at ({}, {}) {}", std::isnan(most) ? "NaN" : fmt::format("{:.4g}", most),
                           whole_of(error.at("x")), whole_of(error.at("y")), text_of(error.at("channel")));
    }
    return text;
}

/// The percentage of pixels that exceed a limit, in the layer with the largest one.
std::string share_of(const Json& image) {
    const Json& comparison = image.at("comparison");
    double most = 0;
    if (comparison.is_object())
        for (const Json& layer : comparison.at("layers"))
            for (const char* kind : {"failing", "warning"})
                most = std::max(most, figure_of(layer.at(kind).at("percent")));
    return std::isfinite(most) && most > 0 ? fmt::format("{:.3g} %", most) : "";
}

/// What changed since the approval; for a case without images the first error.
std::string cause_of(const Json& test, const Json* image) {
    const Json& lines = image ? (image->at("changes").empty() ? image->at("reasons") : image->at("changes"))
                              : test.at("messages");
    std::string first;
    for (const Json& line : lines) {
        if (first.empty()) first = text_of(line);
        if (image || text_of(line).find("error") != std::string::npos) return text_of(line);
    }
    return first;
}

struct Row {
    const Json* test = nullptr;
    const Json* image = nullptr;  ///< nullptr: the case has none
};

/// The bad images of the bad cases; a case that has no such image has a row of its own.
std::vector<Row> rows_of(const std::vector<const Json*>& cases) {
    std::vector<Row> rows;
    for (const Json* test : cases) {
        const std::size_t before = rows.size();
        for (const Json& image : test->at("images"))
            if (is_bad(image)) rows.push_back({test, &image});
        if (rows.size() == before) rows.push_back({test, nullptr});
    }
    return rows;
}

/// A verdict is words of ours, unless a stranger wrote another.
std::string verdict_of(const Json& thing) {
    const std::string text = text_of(thing.at("verdict"));
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || c == ' '; };
    return std::ranges::all_of(text, fits) ? shortened(text) : code(text);
}

std::string table_row(const Row& row) {
    const std::string name = text_of(row.test->at("name"));
    return fmt::format("| {} | {} | {} | {} | {} | {} |\n", code(name),
                       row.image ? code(text_of(row.image->at("name"))) : "",
                       verdict_of(row.image ? *row.image : *row.test),
                       row.image ? code(worst_of(*row.image)) : "", row.image ? share_of(*row.image) : "",
                       code(cause_of(*row.test, row.image)));
}

std::string headline(const Json& report) {
    if (const auto error = report.find("error"); error != report.end())
        return "### Golden images: the run ended early\n\n" + block(shortened(text_of(*error))) + "\n";
    const Json& counts = report.at("counts");
    const auto number = [&](const char* key) { return whole_of(counts.at(key)); };
    const std::int64_t failed = number("failed") + number("orphans");
    if (failed + number("warned") == 0)
        return fmt::format("### Golden images: {} as approved\n",
                           counted(std::size_t(number("passed")), "case"));
    return fmt::format("### Golden images: {} failed, {} with warnings, {} as approved\n", failed,
                       number("warned"), number("passed"));
}

/// "" where no picture can be read.
std::string thumbnails(const fs::path& report, const std::vector<Row>& rows,
                       const GoldenCommentOptions& options) {
    if (options.pictures_url.empty()) return "";
    ThumbnailSheet sheet(report);
    std::string names;
    for (const Row& row : rows) {
        if (!row.image || sheet.rows() == kMostThumbnailRows) continue;
        const Json& pictures = row.image->at("pictures");
        if (!sheet.add({text_of(pictures.at("reference")), text_of(pictures.at("test")),
                        text_of(pictures.at("difference"))}))
            continue;
        names += (names.empty() ? "" : ", ") + code(text_of(row.image->at("name")));
    }
    if (sheet.rows() == 0) return "";
    sheet.write();
    return fmt::format("\nReference, test and difference of {}:\n\n![thumbnails]({}/{})\n", names,
                       options.pictures_url, ThumbnailSheet::kName);
}

std::string commands_of(const Json& data) {
    std::string text;
    for (const auto& [key, what] :
         {std::pair{"approve", "approve"}, {"approve_machine", "keep this machine's images too"}}) {
        const auto command = data.find(key);
        if (command == data.end() || !command->is_string()) continue;
        const std::string words = command->get<std::string>();
        text += words.size() > kMostCommandBytes
                    ? fmt::format("\nThe command to {} is in the report.\n", what)
                    : fmt::format("\nTo {}:\n\n{}\n", what, block(words));
    }
    return text;
}

std::string machine_of(const Json& data) {
    const auto environment = data.find("environment");
    if (environment == data.end()) return "";
    std::vector<std::string> words;
    for (const char* key : {"renderer", "version", "commit"})
        if (const std::string word = text_of(environment->at(key)); !word.empty()) words.push_back(word);
    return "\n" + code(joined(words, ", ", ", "));
}

/// As many of the lines as fit, in whole.
std::size_t append_lines(const std::vector<std::string>& lines, std::size_t most_bytes, std::string& text) {
    std::size_t count = 0;
    for (; count < lines.size() && text.size() + lines[count].size() <= most_bytes; ++count)
        text += lines[count];
    return count;
}

std::string markdown_of(const fs::path& report, const Json& data, const GoldenCommentOptions& options) {
    const std::vector<Row> rows = rows_of(bad_cases(data));
    std::string text = fmt::format("<!-- aftershade golden: {} -->\n{}",
                                   xml_text(shortened(printable(text_of(data.at("suite"))))), headline(data));
    std::string end = thumbnails(report, rows, options) + commands_of(data) + machine_of(data);
    if (!options.report_url.empty()) end += fmt::format(" · [report]({})", options.report_url);
    constexpr std::size_t kRemarkBytes = 200;  // that something is left out
    const std::size_t most = kMostCommentBytes - std::min(kMostCommentBytes, end.size() + kRemarkBytes);
    if (!rows.empty()) {
        text +=
            "\n| case | image | verdict | largest difference | pixels beyond the limit | cause "
            "|\n|---|---|---|---|---|---|\n";
        std::vector<std::string> lines;
        for (std::size_t i = 0; i < std::min(rows.size(), options.rows); ++i)
            lines.push_back(table_row(rows[i]));
        const std::size_t shown = append_lines(lines, most, text);
        if (rows.size() > shown) text += fmt::format("\n{} more in the report.\n", rows.size() - shown);
    }
    std::vector<std::string> orphans;
    for (const Json& orphan : data.at("orphans"))
        orphans.push_back(fmt::format("\n{}: no case gives this golden.\n", code(text_of(orphan))));
    const std::size_t shown = append_lines(orphans, most, text);
    if (orphans.size() > shown)
        text += fmt::format("\nMore goldens without a case, in the report: {}.\n", orphans.size() - shown);
    return text + end + "\n";
}

/// As GitHub's workflow commands escape it.
std::string command_text(const std::string& text, bool is_property) {
    std::string result;
    for (const char c : text)
        if (c == '%') result += "%25";
        else if (c == '\r') result += "%0D";
        else if (c == '\n') result += "%0A";
        else if (is_property && c == ':') result += "%3A";
        else if (is_property && c == ',') result += "%2C";
        else result += c;
    return result;
}

std::string message_of(const Row& row) {
    std::string text = row.image ? text_of(row.image->at("name")) + ": " : "";
    if (row.image)
        for (const Json& reason : row.image->at("reasons")) text += text_of(reason) + "\n";
    else text += cause_of(*row.test, nullptr) + "\n";
    text.pop_back();
    return text;
}

/// The document of the row's case.
std::string file_of(const Row& row) {
    return fs::path(text_of(row.test->at("file"))).lexically_normal().generic_string();
}

std::string annotations_of(const std::vector<Row>& rows) {
    std::string text;
    for (const Row& row : rows)
        text += fmt::format(
            "::{} file={},title={}::{}\n", row.test->at("verdict") == "warning" ? "warning" : "error",
            command_text(file_of(row), true), command_text("golden " + text_of(row.test->at("name")), true),
            command_text(message_of(row), false));
    return text;
}

std::string sarif_of(const std::vector<Row>& rows) {
    Json results = Json::array();
    for (const Row& row : rows) {
        // GitHub's code scanning requires a line.
        const Json location = {
            {"physicalLocation",
             {{"artifactLocation", {{"uri", uri_of(file_of(row))}}}, {"region", {{"startLine", 1}}}}}};
        const bool warns = row.test->at("verdict") == "warning";
        results.push_back({{"ruleId", warns ? "golden-warning" : "golden-failure"},
                           {"level", warns ? "warning" : "error"},
                           {"message", {{"text", text_of(row.test->at("name")) + ": " + message_of(row)}}},
                           {"locations", Json::array({location})}});
    }
    const auto rule = [](const char* id, const char* text) {
        return Json{{"id", id}, {"shortDescription", {{"text", text}}}};
    };
    const Json rules =
        Json::array({rule("golden-failure", "An image differs from its golden by more than its tolerance."),
                     rule("golden-warning", "An image differs from its golden, within its tolerance.")});
    const Json run = {{"tool", {{"driver", {{"name", "aftershade golden"}, {"rules", rules}}}}},
                      {"results", results}};
    return Json{{"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
                {"version", "2.1.0"},
                {"runs", Json::array({run})}}
               .dump(2, ' ', false, Json::error_handler_t::replace) +
           "\n";
}

}  // namespace

GoldenComment comment_on(const fs::path& report, const GoldenCommentOptions& options) {
    GoldenComment comment;
    with_report(report, [&](Json& data) {
        const std::vector<Row> rows = rows_of(bad_cases(data));
        comment = {markdown_of(report, data, options), annotations_of(rows), sarif_of(rows)};
    });
    return comment;
}

}  // namespace aftershade
