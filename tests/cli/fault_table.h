// One row per fault: what was done wrong, the exit code, and the whole of what the user is told.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ostream>
#include <regex>
#include <string>
#include <vector>

#include "framework/batch/process_codes.h"
#include "tests/cli/command.h"
#include "tests/synthetic_capture.h"

namespace aftershade::test {

inline const char* const kViewLook = R"({ "aftershade": 1, "steps": [ { "effect": "view_transform" } ] })";
inline const char* const kBokehLook = R"({ "aftershade": 1, "steps": [ { "effect": "bokeh" } ] })";

/// A folder with what a sound run needs: view.json, bokeh.json, frame.exr with every role, and seq_0001.exr
/// .. seq_0003.exr.
class Workplace {
public:
    Workplace() {
        write_text(folder_ / "view.json", kViewLook);
        write_text(folder_ / "bokeh.json", kBokehLook);
        SyntheticScene scene{
            .width = 16, .height = 9, .background = {0.2f, 0.4f, 0.6f}, .background_depth_m = 4};
        write_capture(make_capture(scene), folder_ / "frame.exr");
        for (int frame = 1; frame <= 3; ++frame)
            std::filesystem::copy_file(folder_ / "frame.exr",
                                       folder_ / ("seq_000" + std::to_string(frame) + ".exr"));
    }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
    const std::filesystem::path& path() const { return folder_.path(); }

private:
    TemporaryFolder folder_;
};

struct Fault {
    std::string what;  ///< a sentence, as the test's name
    std::vector<std::string> arguments;
    ExitCode exit_code = ExitCode::usage;
    std::vector<std::string> messages;  ///< regular expressions, one per line that the user reads, in order
    std::function<void(const Workplace&)> prepare{};
    bool broken_gl = false;
};

inline void PrintTo(const Fault& fault, std::ostream* out) {
    *out << fault.what;
}
inline std::string fault_name(const testing::TestParamInfo<Fault>& info) {
    return info.param.what;
}

/// The lines of stderr without what sums them up.
inline std::vector<std::string> told(const CommandResult& result) {
    std::vector<std::string> lines;
    for (const std::string& line : lines_of_text(result.err))
        if (!line.ends_with("; nothing was run") && line != "Run with --help for more information.")
            lines.push_back(line);
    return lines;
}

class FaultTest : public testing::TestWithParam<Fault> {
protected:
    void check() const {
        const Fault& fault = GetParam();
        const Workplace work;
        if (fault.prepare) fault.prepare(work);
        Environment environment;
        if (fault.broken_gl) environment = without_gl(work / "no_gl");
        std::vector<std::string> arguments = fault.arguments;
        arguments.insert(arguments.begin(), "run");
        arguments.insert(arguments.end(), {"--progress", "none"});
        const auto before = contents(work.path());
        const CommandResult result = run_aftershade(arguments, work.path(), environment);
        EXPECT_EQ(result.exit_code, int(fault.exit_code)) << result.err;
        EXPECT_EQ(result.out, "") << "a path was printed for a file that was not made";
        const std::vector<std::string> lines = told(result);
        EXPECT_EQ(lines.size(), fault.messages.size()) << result.err;
        for (std::size_t i = 0; i < std::min(lines.size(), fault.messages.size()); ++i)
            EXPECT_TRUE(std::regex_match(lines[i], std::regex(fault.messages[i])))
                << "  told:     " << lines[i] << "\n  expected: " << fault.messages[i];
        const auto after = contents(work.path());
        for (const auto& [name, bytes] : after) EXPECT_TRUE(before.contains(name)) << name << " was written";
        for (const auto& [name, bytes] : before)
            EXPECT_TRUE(after.contains(name) && after.at(name) == bytes) << name;
    }
};

}  // namespace aftershade::test
