// The answers of the page that a golden suite's report is reviewed with.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "framework/golden/golden_apply.h"
#include "framework/golden/golden_decisions.h"
#include "framework/golden/report_page.h"
#include "framework/serve/connections.h"
#include "framework/serve/http_message.h"

namespace aftershade::review {

/// Each call reads the file: another process may have written it. A write replaces it only if it still holds
/// what was read, so that no reviewer's decision is lost. [thread-safe]
class ReviewFile {
public:
    explicit ReviewFile(std::filesystem::path report) : report_(std::move(report)) {}

    /// Throws Error(ErrorKind::capture) for a faulty file.
    std::vector<GoldenDecision> read() const;

    /// Applies `change` to what the file holds, as often as another one writes it meanwhile. `change` returns
    /// false to write nothing. Throws Error(ErrorKind::output).
    void update(const std::function<bool(std::vector<GoldenDecision>& decisions)>& change) const;

    static constexpr const char* kName = "decisions.json";

private:
    std::string text() const;
    std::vector<GoldenDecision> parsed(const std::string& text) const;

    std::filesystem::path report_;
};

/// Changes with every key of a decision: what a page shows is known by it.
std::string revision_of(const GoldenDecision& decision);

struct ReviewSetup {
    std::filesystem::path report;  ///< the folder
    std::string suite;             ///< as the user named it, for the page
    std::string reviewer;          ///< who decides on this page
    ReportPageOptions page;
    /// What the approvals among these decisions give, as apply_decisions() does it; `drawn` is called for
    /// each case. Throws Error. [called by one thread at a time]
    std::function<GoldenApplied(const std::vector<GoldenDecision>& decisions,
                                const std::function<void(int done, int all)>& drawn)>
        write;
};

/// The case of a report that can be decided about.
struct ReviewedCase {
    std::vector<SeenImage> images;
    bool can_approve = false;
    bool adds = false;  ///< only the machine differs: its image is kept beside the others
};

/// [any thread]
class ReviewServer {
public:
    /// Reads the report once: if report.json is written again, each answer is 409. Throws
    /// Error(ErrorKind::capture).
    explicit ReviewServer(ReviewSetup setup);

    /// Answers a request to an address below /api/ that refusal() lets through.
    void answer(const serve::Request& request, const serve::Connections::Reply& reply);

    std::size_t report_bytes() const { return report_json_.size(); }
    /// By name, as the report has them.
    static std::map<std::string, ReviewedCase> cases_of(const nlohmann::ordered_json& report);

private:
    serve::Response decide(const serve::Request& request);
    serve::Response write();
    serve::Response picture(const serve::Request& request) const;
    nlohmann::ordered_json state() const;
    /// When report.json was, so that a report of a later run is noticed.
    std::filesystem::file_time_type written_at() const;
    /// Whether a decision is about the images that this report shows.
    bool is_current(const GoldenDecision& decision) const;
    void mark_written(const std::vector<GoldenDecision>& written, nlohmann::ordered_json& answer);

    ReviewSetup setup_;
    ReviewFile file_;
    std::map<std::string, ReviewedCase> cases_;
    std::filesystem::file_time_type read_of_;  // what was read
    std::string report_json_;                  // what the page requests first
    std::mutex writing_;                       // held while images are drawn and written
    std::atomic<int> done_ = 0, all_ = 0;
    mutable std::mutex mutex_;          // of what follows
    std::set<std::string> in_writing_;  // cases whose images are being written
};

/// The page of the report, from a server at `port` of 127.0.0.1 (0: a free one), until `stop`.
void serve_review(ReviewSetup setup, int port, const std::function<void(const std::string& address)>& ready,
                  const std::atomic<bool>& stop);

}  // namespace aftershade::review
