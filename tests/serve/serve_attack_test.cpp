// What the process that speaks HTTP needs in memory while others try to fill it.
#include <atomic>
#include <fstream>
#include <iostream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/serve/serve_fixture.h"

namespace aftershade::test {
namespace {

constexpr std::size_t kMiB = std::size_t(1) << 20;

class ServeAttack : public Serve {
protected:
    /// The most that was resident so far, of the process with the sockets.
    std::size_t peak_bytes() const {
        std::ifstream status("/proc/" + std::to_string(command_->process()) + "/status");
        for (std::string line; std::getline(status, line);)
            if (line.starts_with("VmHWM:")) return std::stoul(line.substr(6)) * 1024;
        return 0;
    }
    void expect_small_and_alive(const char* after) const {
        const std::size_t peak = peak_bytes();
        EXPECT_GT(peak, kMiB);
        EXPECT_LT(peak, 100'000'000u) << after;
        RecordProperty(after, int(peak / 1024));
        std::cout << after << ": " << peak / 1024 << " KiB at most\n";
        EXPECT_EQ(get("/api/state").status, 200) << after;
        EXPECT_EQ(get("/api/picture?frame=1").status, 200) << after;
    }
    std::vector<std::unique_ptr<Client>> clients(int count) const {
        std::vector<std::unique_ptr<Client>> all;
        for (int i = 0; i < count; ++i) all.push_back(std::make_unique<Client>(port_));
        return all;
    }
    std::string body_head(std::size_t bytes) const {
        return head("POST /api/edit", "Content-Length: " + std::to_string(bytes) + "\r\n") + "\r\n";
    }
};

TEST_F(ServeAttack, TakesNoHundredMegabytesWhateverIsSentToIt) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer takes memory for itself";
#endif
    start();
    expect_small_and_alive("at rest");
    {
        const auto idle = clients(1000);
        for (const auto& client : idle) client->send("GET / HTTP/1.1\r\nX: " + std::string(15'000, 'x'));
        expect_small_and_alive("1000 connections with most of a head");
    }
    {
        const Client client(port_);
        client.send(head("POST /api/edit", "Content-Length: 1073741824\r\n\r\n"));
        const std::string part(kMiB, 'x');
        for (int i = 0; i < 1024 && client.send(part); ++i) {
        }
        expect_small_and_alive("a body of 1 GiB");
    }
    {
        const auto slow = clients(1000);
        const std::string most = body_head(kMiB) + std::string(kMiB - 1, '[');
        for (const auto& client : slow) client->send(most);
        expect_small_and_alive("1000 bodies that lack a byte");
        for (const auto& client : slow) client->send("[");
        expect_small_and_alive("1000 bodies at once");
    }
    {
        const auto deaf = clients(250);
        for (const auto& client : deaf) client->send(head("GET /api/effects") + "\r\n");
        expect_small_and_alive("250 answers that nobody reads");
    }
    {
        std::string lists;
        while (lists.size() + 4 < kMiB) lists += "[],";
        const std::string bomb = body_head(lists.size() + 3) + "[" + lists + "0]";
        const auto many = clients(64);
        for (const auto& client : many) client->send(bomb);
        for (const auto& client : many) client->receive();
        expect_small_and_alive("64 bodies of 350,000 lists");
    }
    {
        std::vector<std::jthread> threads;
        std::atomic<int> answered{0};
        for (int i = 0; i < 8; ++i)
            threads.emplace_back([&] {
                for (int k = 0; k < 250; ++k)
                    if (get(k % 10 == 0 ? "/api/picture?frame=1" : "/api/state").status >= 200) ++answered;
            });
        threads.clear();
        EXPECT_EQ(answered, 2000);
        expect_small_and_alive("2000 requests");
    }
}

}  // namespace
}  // namespace aftershade::test
