// What serve leaves behind, and what it tells others of.
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class ServeSecrets : public Serve {
protected:
    TemporaryFolder home_;
};

TEST_F(ServeSecrets, WritesNothingAnywhereWithReadOnlyNotEvenACache) {
    const std::string home = home_.path().string();
    for (const std::string& cache : {std::string(), home + "/cache"}) {
        environment_ = {{"HOME", home},
                        {"TMPDIR", home},
                        {"XDG_CACHE_HOME", home + "/xdg"},
                        {"AFTERSHADE_CACHE", cache},
                        {"XDG_RUNTIME_DIR", home}};
        start({"--read-only"});
        const auto before = contents(folder_.path());
        EXPECT_EQ(get("/api/picture?frame=1").status, 200);
        EXPECT_EQ(set(2).status, 200);
        EXPECT_EQ(get("/api/picture?frame=1").status, 200);
        EXPECT_EQ(post("/api/save").status, 403);
        EXPECT_EQ(ended_by(SIGINT), 130);
        EXPECT_EQ(contents(folder_.path()), before);
        EXPECT_TRUE(fs::is_empty(home_.path())) << contents(home_.path()).begin()->first;
    }
}

TEST_F(ServeSecrets, TellsTheTokenToTheBrowserAloneAndForAMoment) {
    const fs::path said = home_ / "said", runtime = home_ / "runtime";
    fs::create_directories(runtime);
    write_text(home_ / "xdg-open", "#!/bin/sh\necho \"$@\" > said && mv said '" + said.string() + "'\n");
    fs::permissions(home_ / "xdg-open", fs::perms::owner_all);
    environment_ = {{"PATH", home_.path().string() + ":" + std::getenv("PATH")},
                    {"XDG_RUNTIME_DIR", runtime.string()}};
    start({"--open"});
    for (int i = 0; i < 500 && !fs::exists(said); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::string words = read_text(said);
    EXPECT_EQ(words.find(token_), std::string::npos) << "every user sees the words of a command";
    ASSERT_TRUE(words.starts_with("file://" + runtime.string())) << words;
    const fs::path page = words.substr(7, words.size() - 8);
    EXPECT_EQ(fs::status(page).permissions(), fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_NE(read_text(page).find("0;url=http://" + host() + "/#token=" + token_ + "\""), std::string::npos);
    EXPECT_EQ(get("/").status, 200);
    EXPECT_TRUE(fs::exists(page)) << "no page with the token has asked yet";
    EXPECT_EQ(get("/api/state").status, 200);
    EXPECT_TRUE(fs::is_empty(runtime));
}

}  // namespace
}  // namespace aftershade::test
