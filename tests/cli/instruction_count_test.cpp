// Work that must not grow unnoticed: instructions of commands that take no GL, as Valgrind counts them. A
// time would hang on the machine; these counts repeat to the last digits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/cli/command.h"

namespace aftershade::test {
namespace {

const std::string kCounts = AFTERSHADE_SOURCE_DIR "/tests/cli/instruction_counts.json";
const std::string kValgrind = "/usr/bin/valgrind";
constexpr double kTolerance = 0.03;  // relative

struct CountedCase {
    std::string name;
    std::vector<std::string> words;
};

const std::vector<CountedCase>& counted_cases() {
    static const std::string source = AFTERSHADE_SOURCE_DIR;
    static const std::vector<CountedCase> cases = {
        {"list", {"list"}},
        {"check", {"check", source + "/scenes/looks/film.json"}},
        {"inspect", {"inspect", source + "/scenes/suzanne/gbuffer_0003.exr", "--json"}},
        {"compare",
         {"compare", source + "/effects/bloom/cases/lamps.color.0001.exr",
          source + "/effects/bloom/cases/threshold.color.0001.exr"}},
    };
    return cases;
}

/// Counts of another compiler or of other libraries do not compare.
std::string toolchain() {
    std::string valgrind = Command({kValgrind, "--version"}, ".").wait().out;
    valgrind.erase(std::remove(valgrind.begin(), valgrind.end(), '\n'), valgrind.end());
    return "GCC " __VERSION__ ", glibc " + std::to_string(__GLIBC__) + "." + std::to_string(__GLIBC_MINOR__) +
           ", " + valgrind;
}

double instructions_of(const CountedCase& counted) {
    std::vector<std::string> words{kValgrind, "--tool=cachegrind", "--cache-sim=no",
                                   "--cachegrind-out-file=/dev/null", AFTERSHADE_EXECUTABLE};
    words.insert(words.end(), counted.words.begin(), counted.words.end());
    const TemporaryFolder folder;
    const CommandResult result = Command(words, folder.path(), {{"AFTERSHADE_CACHE", "off"}}).wait();
    const std::string label = "refs:";
    const std::size_t at = result.err.find(label);
    if (at == std::string::npos) throw std::runtime_error("no count in: " + result.err);
    std::string digits = result.err.substr(at + label.size(), result.err.find('\n', at) - at - label.size());
    std::erase_if(digits, [](char c) { return c < '0' || c > '9'; });
    return std::stod(digits);
}

/// AFTERSHADE_RENEW_COUNTS=1 writes the counts of this tree.
TEST(InstructionCounts, AreNotMoreThanThreePercentAboveThoseOnRecord) {
    if (!std::filesystem::exists(kValgrind)) GTEST_SKIP() << "needs valgrind";
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer's instructions are not counted";
#endif
    const bool renews = std::getenv("AFTERSHADE_RENEW_COUNTS") != nullptr;
    nlohmann::ordered_json counts = nlohmann::ordered_json::parse(std::ifstream(kCounts));
    const std::string tools = toolchain();
    if (!renews && counts.at("toolchain") != tools)
        GTEST_SKIP() << "on record is " << counts.at("toolchain") << ", here is " << tools;
    counts["toolchain"] = tools;
    for (const CountedCase& counted : counted_cases()) {
        const double now = instructions_of(counted);
        if (!renews) {
            const double before = counts.at("instructions").at(counted.name);
            EXPECT_LE(now, (1 + kTolerance) * before)
                << counted.name << ": " << now / before
                << " times the count on record. Fix it, or give the reason in the commit, "
                << "and renew the record with AFTERSHADE_RENEW_COUNTS=1";
        }
        counts["instructions"][counted.name] = std::uint64_t(now);
    }
    if (renews) std::ofstream(kCounts) << counts.dump(2) << "\n";
}

TEST(InstructionCounts, RepeatWithinATenthOfThatTolerance) {
    if (!std::filesystem::exists(kValgrind)) GTEST_SKIP() << "needs valgrind";
    const CountedCase& check = counted_cases()[1];
    const double first = instructions_of(check), second = instructions_of(check);
    EXPECT_NEAR(second / first, 1, 0.1 * kTolerance);
    EXPECT_GT(first, 1e6) << "the command itself was counted";
}

}  // namespace
}  // namespace aftershade::test
