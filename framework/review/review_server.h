// The answers of the page that a golden suite's report is reviewed with.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <vector>

#include "framework/batch/golden_apply.h"
#include "framework/batch/report_page.h"
#include "framework/review/review_file.h"
#include "framework/serve/connections.h"
#include "framework/serve/http_message.h"

namespace aftershade::review {

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
    /// Reads the report once. Throws Error(ErrorKind::capture).
    explicit ReviewServer(ReviewSetup setup);

    /// Answers a request to an address below /api/ that the guards let through.
    void answer(const serve::Request& request, const serve::Connections::Reply& reply);

    std::size_t report_bytes() const { return report_json_.size(); }
    /// By name, as the report has them.
    static std::map<std::string, ReviewedCase> cases_of(const nlohmann::ordered_json& report);

private:
    serve::Response decide(const serve::Request& request);
    serve::Response write();
    serve::Response picture(const serve::Request& request) const;
    nlohmann::ordered_json state() const;
    /// Whether a decision is about the images that this report shows.
    bool is_current(const GoldenDecision& decision) const;
    void mark_written(const std::vector<GoldenDecision>& written, nlohmann::ordered_json& answer);

    ReviewSetup setup_;
    ReviewFile file_;
    std::map<std::string, ReviewedCase> cases_;
    std::string report_json_;  // what the page requests first
    std::mutex writing_;       // held while images are drawn and written
    std::atomic<int> done_ = 0, all_ = 0;
    mutable std::mutex mutex_;          // of what follows
    std::set<std::string> in_writing_;  // cases whose images are being written
};

/// The page of the report, from a server at `port` of 127.0.0.1 (0: a free one), until `stop`.
void serve_review(ReviewSetup setup, int port, const std::function<void(const std::string& address)>& ready,
                  const std::atomic<bool>& stop);

}  // namespace aftershade::review
