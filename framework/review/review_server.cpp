#include "framework/review/review_server.h"

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "framework/base/atomic_file.h"
#include "framework/base/content_hash.h"
#include "framework/base/data_path.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/base/text.h"
#include "framework/document/document.h"
#include "framework/golden/report_page.h"
#include "framework/serve/http_message.h"
#include "framework/serve/serve_page.h"

namespace aftershade::review {

namespace {

using Json = nlohmann::ordered_json;
using serve::Refusal;
using serve::Request;
using serve::Response;

std::string text_of(const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

/// Names of a report, as decisions.json takes them: with others no reviewer could read the file again.
void check_names(const std::string& test, const std::vector<SeenImage>& images) {
    const auto check = [](const char* what, const std::string& name) {
        if (const std::string fault = fault_of_name(name); !fault.empty())
            throw Error(ErrorKind::capture, std::string("report.json: ") + what + " '" +
                                                printable(name.substr(0, 40)) + "...' " + fault +
                                                " (run the suite again; no case draws such a name)");
    };
    check("the name of a case", test);
    for (const SeenImage& image : images) {
        check("the name of an image", image.name);
        check("the hash of an image", image.test);
        check("the hash of an image", image.reference);
    }
}

/// One decision of a request's body.
struct Wish {
    std::string test, decision, note, before;  ///< `before`: the revision that the page shows, "" for none
};

std::vector<Wish> wishes_of(const Request& request) {
    const Json body = serve::shallow_json(request.body);
    const auto list = body.is_object() ? body.find("decisions") : body.end();
    if (!body.is_object() || list == body.end() || !list->is_array() || list->empty())
        throw Refusal{400, "the body is {\"decisions\": [{\"case\", \"decision\", \"note\", \"before\"}]}"};
    std::vector<Wish> wishes;
    for (const Json& one : *list) {
        if (!one.is_object()) throw Refusal{400, "a decision is an object"};
        Wish wish{text_of(one, "case"), text_of(one, "decision"), text_of(one, "note"),
                  text_of(one, "before")};
        if (wish.decision != "approve" && wish.decision != "reject" && wish.decision != "none")
            throw Refusal{400, "'decision' is approve, reject or none"};
        if (wish.note.size() > kMostNoteBytes)
            throw Refusal{400, "the note has more than " + std::to_string(kMostNoteBytes) + " bytes"};
        // A note is one line, whatever a field of a page takes.
        std::ranges::replace_if(
            wish.note, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
        wishes.push_back(std::move(wish));
    }
    return wishes;
}

auto find_case(std::vector<GoldenDecision>& decisions, const std::string& test) {
    return std::ranges::find(decisions, test, &GoldenDecision::test);
}

/// "": the wish may replace what is there. A decision that is not current is about another report's images.
std::string conflict_of(const Wish& wish, const GoldenDecision* now, bool is_current) {
    if (now && now->is_written && is_current)
        return wish.test + ": its images are in the suite already; `git restore` takes them back";
    if ((now ? revision_of(*now) : "") == wish.before) return "";
    if (!now) return wish.test + ": someone has taken the decision back meanwhile";
    return wish.test + ": " + (now->by.empty() ? "someone" : now->by) + " has " +
           (now->approves ? "approved" : "rejected") + " it meanwhile" +
           (now->note.empty() ? "" : ": " + now->note);
}

}  // namespace

std::map<std::string, ReviewedCase> ReviewServer::cases_of(const Json& report) {
    std::map<std::string, ReviewedCase> cases;
    for (const Json& test : report.at("cases")) {
        if (test.at("verdict") == "same" || test.at("skipped").is_string()) continue;
        ReviewedCase& reviewed = cases[test.at("name").get<std::string>()];
        reviewed.can_approve = test.at("approve").is_string();
        for (const Json& image : test.at("images")) {
            const Json hashes = image.value("hashes", Json::object());
            reviewed.images.push_back(
                {image.at("name").get<std::string>(), text_of(hashes, "test"), text_of(hashes, "reference")});
            // A report of an earlier version has no hashes, so that nothing says what was seen.
            reviewed.can_approve &= !reviewed.images.back().test.empty();
            reviewed.adds |= image.at("verdict") != "same" && image.at("only_machine_changed") == true;
        }
        check_names(test.at("name").get<std::string>(), reviewed.images);
    }
    return cases;
}

std::filesystem::file_time_type ReviewServer::written_at() const {
    std::error_code absent;  // the least time
    return std::filesystem::last_write_time(setup_.report / "report.json", absent);
}

ReviewServer::ReviewServer(ReviewSetup setup)
    : setup_(std::move(setup)), file_(setup_.report), read_of_(written_at()) {
    Json data = report_page_data(setup_.report, setup_.page);
    try {
        cases_ = cases_of(data["report"]);
    } catch (const Json::exception& error) {
        throw Error(ErrorKind::capture, (setup_.report / "report.json").string() +
                                            ": is not a report of a golden suite: " + error.what());
    }
    data["review"] = {{"reviewer", setup_.reviewer}, {"suite", setup_.suite}};
    report_json_ = data.dump(-1, ' ', false, Json::error_handler_t::replace);
    (void)file_.read();  // for its faults, before a page is there
}

bool ReviewServer::is_current(const GoldenDecision& decision) const {
    const auto reviewed = cases_.find(decision.test);
    return reviewed != cases_.end() && reviewed->second.images == decision.images;
}

Json ReviewServer::state() const {
    Json list = Json::array();
    for (const GoldenDecision& decision : file_.read()) {
        Json one = json_of(decision);
        one["revision"] = revision_of(decision);
        one["current"] = is_current(decision);
        list.push_back(std::move(one));
    }
    const std::lock_guard lock(mutex_);
    const Json writing =
        in_writing_.empty() ? Json(nullptr) : Json{{"done", done_.load()}, {"all", all_.load()}};
    return {{"decisions", std::move(list)}, {"writing", writing}};
}

Response ReviewServer::decide(const Request& request) {
    const std::vector<Wish> wishes = wishes_of(request);
    for (const Wish& wish : wishes) {
        const auto reviewed = cases_.find(wish.test);
        if (reviewed == cases_.end())
            throw Refusal{400, "'" + wish.test + "' is not a case of this report that differs"};
        if (wish.decision == "approve" && !reviewed->second.can_approve)
            throw Refusal{400, wish.test + ": drew no image that can be approved"};
        const std::lock_guard lock(mutex_);
        if (in_writing_.contains(wish.test)) throw Refusal{409, wish.test + ": its images are being written"};
    }
    std::vector<std::string> conflicts;
    file_.update([&](std::vector<GoldenDecision>& decisions) {
        conflicts.clear();
        for (const Wish& wish : wishes) {
            const auto now = find_case(decisions, wish.test);
            const bool is_there = now != decisions.end();
            const std::string conflict =
                conflict_of(wish, is_there ? &*now : nullptr, is_there && is_current(*now));
            if (!conflict.empty()) conflicts.push_back(conflict);
        }
        // All or none: a cause that is approved as a whole was looked at as a whole.
        if (!conflicts.empty()) return false;
        for (const Wish& wish : wishes) {
            std::erase_if(decisions, [&](const GoldenDecision& one) { return one.test == wish.test; });
            const ReviewedCase& reviewed = cases_.at(wish.test);
            if (wish.decision != "none")
                decisions.push_back({wish.test, wish.decision == "approve",
                                     wish.decision == "approve" && reviewed.adds, wish.note, setup_.reviewer,
                                     reviewed.images});
        }
        return true;
    });
    Json answer = state();
    if (conflicts.empty()) return serve::json_response(answer);
    answer["error"] = conflicts.front();
    answer["conflicts"] = conflicts;
    Response response = serve::json_response(answer);
    response.status = 409;
    return response;
}

void ReviewServer::mark_written(const std::vector<GoldenDecision>& written, Json& answer) {
    file_.update([&](std::vector<GoldenDecision>& decisions) {
        answer["warnings"] = Json::array();
        for (const GoldenDecision& one : written) {
            const auto now = find_case(decisions, one.test);
            GoldenDecision as_written = one;  // also by another reviewer at the same time
            as_written.is_written = true;
            if (now != decisions.end() && (*now == one || *now == as_written)) *now = as_written;
            else
                answer["warnings"].push_back(
                    one.test +
                    ": its images were written while someone took the approval back; see `git diff`");
        }
        return true;
    });
}

Response ReviewServer::write() {
    const std::unique_lock one_at_a_time(writing_, std::try_to_lock);
    if (!one_at_a_time) throw Refusal{409, "images are being written; wait for their end"};
    std::vector<GoldenDecision> approvals;
    for (const GoldenDecision& decision : file_.read())
        if (decision.approves && !decision.is_written && is_current(decision)) approvals.push_back(decision);
    if (approvals.empty()) throw Refusal{400, "no approved case waits to be written"};
    const auto set_writing = [&](const std::vector<GoldenDecision>& decisions) {
        const std::lock_guard lock(mutex_);
        in_writing_.clear();
        for (const GoldenDecision& decision : decisions) in_writing_.insert(decision.test);
        done_ = 0;
        all_ = int(decisions.size());
    };
    set_writing(approvals);
    Json answer;
    try {
        const GoldenApplied applied = setup_.write(approvals, [&](int, int) { ++done_; });
        mark_written(applied.applied, answer);
        answer["written"] = Json::array();
        for (const auto& path : applied.approval.written) answer["written"].push_back(path.string());
        answer["kept"] = applied.kept;
    } catch (...) {
        set_writing({});
        throw;
    }
    set_writing({});
    answer.update(state());
    return serve::json_response(answer);
}

/// One that did not fit into what the page got at first.
Response ReviewServer::picture(const Request& request) const {
    return {200, "image/png", read_report_png(setup_.report, request.parameter("name"))};
}

void ReviewServer::answer(const Request& request, const serve::Connections::Reply& reply) {
    using Answer = std::function<Response()>;
    const std::map<std::string, std::pair<std::string, Answer>> answers = {
        {"/api/report",
         {"GET",
          [&] {
              return Response{200, "application/json", report_json_};
          }}},
        {"/api/decisions", {"GET", [&] { return serve::json_response(state()); }}},
        {"/api/picture", {"GET", [&] { return picture(request); }}},
        {"/api/decide", {"POST", [&] { return decide(request); }}},
        {"/api/write", {"POST", [&] { return write(); }}}};
    const auto found = answers.find(request.path);
    if (found == answers.end()) return reply(serve::error_response(404, "there is nothing at this address"));
    if (request.method != found->second.first)
        return reply(serve::error_response(405, "this address takes " + found->second.first));
    try {
        // Its pictures are no longer those that this report's figures are about.
        if (written_at() != read_of_)
            throw Refusal{409, (setup_.report / "report.json").string() +
                                   ": was written again, or removed, since `aftershade golden serve` read "
                                   "it; end the command and start it again"};
        reply(found->second.second());
    } catch (const Refusal& refusal) {
        reply(serve::error_response(refusal.status, refusal.message));
    } catch (const Error& error) {
        reply(serve::error_response(500, error.what()));
    }
}

void serve_review(ReviewSetup setup, int port, const std::function<void(const std::string&)>& ready,
                  const std::atomic<bool>& stop) {
    ReviewServer server(std::move(setup));
    serve::Connections::Limits limits;
    constexpr std::size_t kPagesAtOnce = 4;  // that load: an answer in the way of others would be cut
    limits.held_bytes += kPagesAtOnce * server.report_bytes();
    serve::Connections connections(port, limits);
    const ServedReportPage page = served_report_page();
    serve::serve_page(connections,
                      {{{"/", {200, "text/html; charset=utf-8", page.html}},
                        {"/page.css", {200, "text/css; charset=utf-8", page.style}},
                        {"/icon.svg", serve::read_page_files(data_path() / "page").at("/icon.svg")},
                        {"/page.js", {200, "text/javascript; charset=utf-8", page.script}}},
                       ready,
                       {},
                       [&](const Request& request, const serve::Connections::Reply& reply) {
                           server.answer(request, reply);
                       }},
                      stop);
}

std::string ReviewFile::text() const {
    std::string fault;
    std::string text = read_file_below(report_, kName, kMaxDocumentBytes, fault);
    if (!fault.empty() && fault != kNoSuchFile)
        throw Error(ErrorKind::capture, (report_ / kName).string() + ": " + fault);
    return text;
}

std::vector<GoldenDecision> ReviewFile::parsed(const std::string& text) const {
    if (text.empty()) return {};
    Diagnostics faults;
    std::vector<GoldenDecision> decisions = parse_decisions(text, (report_ / kName).string(), faults);
    if (!faults.has_errors()) return decisions;
    std::ostringstream words;
    faults.print(words);
    throw Error(ErrorKind::capture, words.str() + "correct the file, or remove it to begin the review again");
}

std::vector<GoldenDecision> ReviewFile::read() const {
    return parsed(text());
}

void ReviewFile::update(const std::function<bool(std::vector<GoldenDecision>&)>& change) const {
    for (;;) {
        const std::string before = text();
        std::vector<GoldenDecision> decisions = parsed(before);
        if (!change(decisions)) return;
        const std::string after = decisions_text(decisions);
        if (after.size() > kMaxDocumentBytes)
            throw Error(ErrorKind::output,
                        (report_ / kName).string() +
                            ": would have more than 1 MiB; write the approved images, and review the rest "
                            "in a report of some cases only");
        if (replace_text_file(path_below(report_, kName), before, after)) return;
    }
}

std::string revision_of(const GoldenDecision& decision) {
    return content_hash(json_of(decision).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace aftershade::review
