// ci/golden, which every recipe for CI runs; scripts/check ci-recipes runs the recipes in bare systems.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tests/cli/golden_suite.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class CiScript : public GoldenCommand {
protected:
    CiScript() {
        fs::create_directory(folder_ / "bin");
        fs::create_symlink(AFTERSHADE_EXECUTABLE, folder_ / "bin/aftershade");
        fs::create_directory(folder_ / "packages");
    }
    void SetUp() override {
        if (!fs::exists("/usr/bin/dpkg")) GTEST_SKIP() << "the script installs Debian's packages alone";
    }

    CommandResult ci(Environment environment) {
        environment.try_emplace("GOLDEN_SUITE", "golden.json");
        // Of the service that runs this test.
        for (const char* name : {"GITHUB_ACTIONS", "GITHUB_RUN_ID", "GITHUB_STEP_SUMMARY", "CI_JOB_URL"})
            environment.try_emplace(name, "");
        environment["PATH"] = (folder_ / "bin").string() + ":" + std::getenv("PATH");
        return Command({"/bin/bash", AFTERSHADE_SOURCE_DIR "/ci/golden"}, folder_.path(), environment).wait();
    }
    std::string shell(const std::string& command) {
        return Command({"/bin/bash", "-c", command}, folder_ / "packages").wait().out;
    }
    /// A source whose one package is text: what is refused is never given to apt.
    void write_packages(const std::string& text) {
        const std::string system =
            shell(R"sh(. /etc/os-release; printf %s "$ID-${VERSION_ID:-}_$(dpkg --print-architecture)")sh");
        package_ = "aftershade_9_" + system + ".deb";
        sums_ = "aftershade_" + system + ".sha256";
        write_text(folder_ / "packages" / package_, text);
        write_text(folder_ / "packages" / sums_, shell("sha256sum " + package_));
    }
    void expect_refusal(const std::string& message, Environment environment = {}) {
        environment.try_emplace("GOLDEN_SOURCE", (folder_ / "packages").string());
        const CommandResult result = ci(environment);
        EXPECT_EQ(result.exit_code, 69) << result.err;
        EXPECT_NE(result.err.find(message), std::string::npos) << result.err;
        EXPECT_FALSE(fs::exists(folder_ / "report"));
    }

    std::string package_, sums_;
};

TEST_F(CiScript, EndsWithTheVerdictAndLetsWarningsPass) {
    approve();
    EXPECT_EQ(ci({}).exit_code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "report/junit.xml"));
    write_frame(1, 90);
    EXPECT_EQ(ci({}).exit_code, 2);
    write_suite(R"("fail": 10000, "warn": 0.001)");
    const CommandResult warned = ci({});
    EXPECT_EQ(warned.exit_code, 0);
    EXPECT_NE(warned.err.find("golden: warnings only"), std::string::npos) << warned.err;
}

TEST_F(CiScript, RefusesPackagesThatAreChangedCutOrAbsent) {
    expect_refusal("no such file (the source needs the packages for");
    write_packages("a package");
    const fs::path package = folder_ / "packages" / package_;
    for (const char* text : {"a packagE", "a pack"}) {
        write_text(package, text);
        expect_refusal(package_ + ": its SHA-256 is");
    }
    fs::remove(package);
    expect_refusal(package_ + ": no such file (" + sums_ + " names it");
    expect_refusal("and GOLDEN_SHA256 is " + std::string(64, '0'), {{"GOLDEN_SHA256", std::string(64, '0')}});
    write_text(folder_ / "packages" / sums_, std::string(64, '0') + "  ../../etc/" + package_ + "\n");
    expect_refusal(sums_ + ": names no package");
    expect_refusal("http:// does not protect the packages (set GOLDEN_SHA256",
                   {{"GOLDEN_SOURCE", "http://127.0.0.1:1/packages"}});
}

TEST_F(CiScript, RunsNothingThatANameSays) {
    approve();
    const std::string name = "-go \"$(touch PWNED)\" 'x`touch PWNED`;touch PWNED\n::error::y";
    fs::create_directory(folder_ / name);
    for (const char* part : {"lens.json", "golden.json", "goldens", "in_0001.exr", "in_0002.exr"})
        fs::rename(folder_ / part, folder_ / name / part);
    const CommandResult result = ci({{"GOLDEN_SUITE", name},
                                     {"GITHUB_ACTIONS", "true"},
                                     {"GITHUB_HEAD_REF", "a$(touch${IFS}PWNED);touch${IFS}PWNED"}});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path()))
        EXPECT_NE(entry.path().filename(), "PWNED");
    EXPECT_TRUE(result.out.starts_with("::stop-commands::")) << result.out;
    for (const std::string& line : lines_of_text(result.out + result.err))
        EXPECT_FALSE(line.starts_with("::error::y")) << line;
    fs::remove_all(folder_ / "report");
    expect_refusal("no such file", {{"GOLDEN_SOURCE", name}});
}

}  // namespace
}  // namespace aftershade::test
