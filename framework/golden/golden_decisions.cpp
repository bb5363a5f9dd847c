#include "framework/golden/golden_decisions.h"

#include <fnmatch.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "framework/document/document.h"

namespace aftershade {

using Json = nlohmann::ordered_json;
using Presence = ObjectReader::Presence;

namespace {

std::string fault_of_line(std::string_view text, std::size_t most) {
    const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
    if (text.size() > most) return fmt::format("has {} bytes; the most is {}", text.size(), most);
    if (std::ranges::any_of(text, is_control)) return "has a control character; write one line of text";
    return "";
}

/// A text of one line, since it is printed and stands in sidecars.
std::string line_of(ObjectReader& reader, const Node& node, const std::string& key, std::size_t most,
                    Presence presence, Diagnostics& diagnostics) {
    const std::string text = reader.text(key, presence).value_or("");
    if (const std::string fault = fault_of_line(text, most); !fault.empty())
        diagnostics.error(node.find(key)->place, fmt::format("'{}' {}", key, fault));
    return text;
}

SeenImage image_of(const Node& node, Diagnostics& diagnostics) {
    ObjectReader reader(node, "the image", diagnostics);
    SeenImage image;
    image.name = line_of(reader, node, "name", kMostNameBytes, Presence::required, diagnostics);
    image.test = line_of(reader, node, "test", kMostNameBytes, Presence::required, diagnostics);
    const Node* const reference = reader.any("reference");
    if (reference && reference->kind != Node::Kind::null)
        image.reference = line_of(reader, node, "reference", kMostNameBytes, Presence::optional, diagnostics);
    reader.finish();
    return image;
}

GoldenDecision decision_of(const Node& node, const std::string& author, Diagnostics& diagnostics) {
    static const std::array kWords{std::string("approve"), std::string("reject")};
    ObjectReader reader(node, "the decision", diagnostics);
    GoldenDecision decision;
    decision.test = line_of(reader, node, "case", kMostNameBytes, Presence::required, diagnostics);
    decision.approves = reader.choice("decision", kWords, Presence::required) == kWords[0];
    decision.adds = reader.boolean("add").value_or(false);
    decision.note = line_of(reader, node, "note", kMostNoteBytes, Presence::optional, diagnostics);
    decision.by = line_of(reader, node, "by", kMostNameBytes, Presence::optional, diagnostics);
    if (decision.by.empty()) decision.by = author;
    if (const Node* const images = reader.array("images"))
        for (const Node& image : images->items) decision.images.push_back(image_of(image, diagnostics));
    decision.is_written = reader.boolean("written").value_or(false);
    reader.finish();
    return decision;
}

/// The address of "Ada <ada@example.org>", else the whole text.
std::string_view identity_of(std::string_view by) {
    const std::size_t open = by.rfind('<');
    if (open == by.npos || !by.ends_with('>')) return by;
    return by.substr(open + 1, by.size() - open - 2);
}

}  // namespace

std::string fault_of_name(std::string_view text) {
    return fault_of_line(text, kMostNameBytes);
}

std::vector<GoldenDecision> parse_decisions(std::string_view text, const std::string& file,
                                            Diagnostics& diagnostics) {
    std::vector<GoldenDecision> decisions;
    const auto node = parse_document(text, file, diagnostics);
    if (!node) return decisions;
    ObjectReader reader(*node, "the document", diagnostics);
    if (!reader.is_object()) return decisions;
    check_document_version(reader, *node, diagnostics);
    const std::string author =
        line_of(reader, *node, "author", kMostNameBytes, Presence::optional, diagnostics);
    if (const Node* const list = reader.array("decisions", Presence::required))
        for (const Node& one : list->items) decisions.push_back(decision_of(one, author, diagnostics));
    reader.finish();
    return decisions;
}

Json json_of(const GoldenDecision& decision) {
    Json json = {{"case", decision.test},
                 {"decision", decision.approves ? "approve" : "reject"},
                 {"note", decision.note},
                 {"by", decision.by},
                 {"images", Json::array()}};
    if (decision.adds) json["add"] = true;
    if (decision.is_written) json["written"] = true;
    for (const SeenImage& image : decision.images)
        json["images"].push_back(
            {{"name", image.name},
             {"test", image.test},
             {"reference", image.reference.empty() ? Json(nullptr) : Json(image.reference)}});
    return json;
}

std::string decisions_text(const std::vector<GoldenDecision>& decisions) {
    Json list = Json::array();
    for (const GoldenDecision& decision : decisions) list.push_back(json_of(decision));
    return Json{{"aftershade", 1}, {"decisions", std::move(list)}}.dump(1, ' ', false,
                                                                        Json::error_handler_t::replace) +
           "\n";
}

std::vector<GoldenDecision> decisions_of_message(std::string_view message, const std::string& author) {
    constexpr std::string_view kTag = "golden: approve ";
    std::vector<GoldenDecision> decisions;
    std::istringstream lines{std::string(message)};
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with(kTag)) continue;
        std::istringstream words(line.substr(kTag.size()));
        for (std::string word; words >> word;) {
            while (word.ends_with(',')) word.pop_back();
            if (!word.empty()) decisions.push_back({word, true, false, "", author});
        }
    }
    return decisions;
}

bool GoldenApprovers::may(const std::string& by, const std::string& test) const {
    const std::string identity(identity_of(by));
    return !identity.empty() && std::ranges::any_of(entries, [&](const Entry& entry) {
        const auto fits = [&](const std::string& glob) {
            return fnmatch(glob.c_str(), test.c_str(), 0) == 0;
        };
        return std::ranges::find(entry.who, identity) != entry.who.end() &&
               std::ranges::any_of(entry.cases, fits);
    });
}

GoldenApprovers read_approvers(const std::filesystem::path& file, Diagnostics& diagnostics) {
    GoldenApprovers approvers;
    const auto node = read_document(file, diagnostics);
    if (!node) return approvers;
    ObjectReader reader(*node, "the document", diagnostics);
    if (!reader.is_object()) return approvers;
    check_document_version(reader, *node, diagnostics);
    if (const Node* const list = reader.array("approvers", Presence::required))
        for (const Node& one : list->items) {
            ObjectReader entry(one, "the entry", diagnostics);
            GoldenApprovers::Entry result{entry.texts("cases"), entry.texts("who")};
            const auto is_empty = [](const std::string& text) { return text.empty(); };
            if (result.who.empty() || std::ranges::any_of(result.who, is_empty))
                diagnostics.error(one.place,
                                  "'who' has no address; list addresses: \"who\": [\"ada@example.org\"]");
            // A list that was emptied is not one that was left out.
            if (!one.find("cases")) result.cases = {"*"};
            else if (result.cases.empty())
                diagnostics.error(one.place,
                                  "'cases' is empty; list globs of cases, or leave it out for all cases");
            entry.finish();
            approvers.entries.push_back(std::move(result));
        }
    if (approvers.entries.empty() && !diagnostics.has_errors())
        diagnostics.error(node->place,
                          "'approvers' is empty, so no one may approve; write \"approvers\": "
                          "[{\"who\": [\"ada@example.org\"]}]");
    reader.finish();
    return approvers;
}

}  // namespace aftershade
