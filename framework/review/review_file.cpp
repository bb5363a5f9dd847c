#include "framework/review/review_file.h"

#include <nlohmann/json.hpp>
#include <sstream>

#include "framework/base/atomic_file.h"
#include "framework/base/content_hash.h"
#include "framework/base/error.h"
#include "framework/base/side_file.h"
#include "framework/document/document.h"

namespace aftershade::review {

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
