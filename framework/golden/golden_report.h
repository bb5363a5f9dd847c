// The results of a golden suite: text in the manner of ctest, JUnit for CI, JSON for pages.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "framework/golden/golden_run.h"

namespace aftershade {

/// Values that the result itself lacks.
struct GoldenReportContext {
    const GoldenSuite* suite = nullptr;
    GoldenRunOptions options;
    std::string commit;        ///< of the folder of the suite; "" where git has none
    std::string with_options;  ///< " --effect-path x": added to approve commands
};

/// A command for a shell that approves these cases' images; "" for none.
std::string approve_command(const GoldenReportContext& context,
                            const std::vector<const GoldenCaseResult*>& cases);

/// Everything that the verdict of a case ignores, as allowances_of(Comparison) lists it; "" if it ignores
/// nothing.
std::string allowances_of(const GoldenCaseResult& test);
/// " 3/42 bloom/lamps ........   Passed    0.41 s"; `good` has six letters.
std::string line_of(const GoldenCaseResult& test, int done, int all, const char* good = "Passed");
/// Failures and warnings again with their reasons, what approves them, and one line of sums.
std::string summary_of(const GoldenSuiteResult& result, const GoldenReportContext& context);

/// JUnit's XML as Jenkins, GitLab and GitHub's actions read it.
std::string junit_of(const GoldenSuiteResult& result, const GoldenReportContext& context);

/// A run that ended before its cases were judged: no GL, a faulty suite.
struct GoldenEarlyEnd {
    std::string suite;  ///< as the user named it
    std::string message;
    int exit_code = 0;
};
/// The reports of such a run: JUnit with one error, report.json with `error`, and a page.
std::string early_junit_of(const GoldenEarlyEnd& end);
nlohmann::ordered_json early_json_of(const GoldenEarlyEnd& end);
std::string early_page_of(const GoldenEarlyEnd& end);

/// docs/golden.md lists every key.
nlohmann::ordered_json json_of(const GoldenSuiteResult& result, const GoldenReportContext& context);

}  // namespace aftershade
