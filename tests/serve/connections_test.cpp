#include "framework/serve/connections.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "framework/base/error.h"
#include "framework/serve/http_message.h"
#include "framework/serve/serve_page.h"
#include "tests/serve/client.h"

namespace aftershade::serve {
namespace {

using namespace std::chrono_literals;
using test::Client;

/// A server that answers with the path, on a thread of its own.
class Echo {
public:
    explicit Echo(Connections::Limits limits)
        : connections_(0, limits), thread_([this] {
              connections_.run({[](const Request& head) -> std::optional<Response> {
                                    if (head.header("x-may-ask").empty()) return error_response(401, "no");
                                    return std::nullopt;
                                },
                                [](const Request& request, const Connections::Reply& reply) {
                                    reply({200, "text/plain", request.path + request.body});
                                }},
                               stop_);
          }) {}
    ~Echo() {
        stop_ = true;
        thread_.join();
    }
    int port() const { return connections_.port(); }
    test::Answer ask() const {
        const Client client(port());
        client.send("GET /a HTTP/1.1\r\nX-May-Ask: 1\r\n\r\n");
        return test::parsed(client.receive());
    }

private:
    std::atomic<bool> stop_ = false;
    Connections connections_;
    std::thread thread_;
};

TEST(Responses, ToAFaultSayWhetherItIsOneOfTheProgram) {
    EXPECT_NE(fault_response(std::out_of_range("map::at"))
                  .body.find("a fault of the program itself: map::at; please report it"),
              std::string::npos);
    EXPECT_EQ(fault_response(Error(ErrorKind::capture, "f.exr: no such file")).body,
              error_response(500, "f.exr: no such file").body);
}

TEST(Connections, EndARequestThatComesTooSlowly) {
    const Echo echo({.request = 200ms});
    const Client slow(echo.port());
    slow.send("POST / HTTP/1.1\r\nX-May-Ask: 1\r\nContent-Length: 10\r\n\r\n1");
    EXPECT_EQ(test::parsed(slow.receive()).status, 408);
}

TEST(Connections, CloseTheOneThatWaitedLongestWhereThereAreTooMany) {
    const Echo echo({.connections = 4});
    std::vector<std::unique_ptr<Client>> idle;
    for (int i = 0; i < 20; ++i) idle.push_back(std::make_unique<Client>(echo.port()));
    EXPECT_EQ(echo.ask().body, "/a");
    EXPECT_EQ(idle.front()->receive(), "");
}

TEST(Connections, AnswerBesideAPeerThatNeverReads) {
    const Echo echo({.workers = 1});
    std::vector<std::unique_ptr<Client>> deaf;
    for (int i = 0; i < 20; ++i) {
        deaf.push_back(std::make_unique<Client>(echo.port()));
        deaf.back()->send("GET /b HTTP/1.1\r\nX-May-Ask: 1\r\n\r\n");
    }
    EXPECT_EQ(echo.ask().status, 200);
}

TEST(Connections, CloseThoseThatMayNotAskBeforeThoseThatMay) {
    const Echo echo({.connections = 4});
    const Client asking(echo.port());
    asking.send("POST /a HTTP/1.1\r\nX-May-Ask: 1\r\nContent-Length: 2\r\n\r\nb");
    EXPECT_EQ(echo.ask().body, "/a") << "the head of the other one was read by then";
    std::vector<std::unique_ptr<Client>> idle;
    for (int i = 0; i < 20; ++i) idle.push_back(std::make_unique<Client>(echo.port()));
    EXPECT_EQ(idle.front()->receive(), "");
    asking.send("c");
    EXPECT_EQ(test::parsed(asking.receive()).body, "/abc");
}

TEST(Connections, RefuseAHeadThatMayNotAskWithoutItsBody) {
    const Echo echo({});
    const Client stranger(echo.port());
    stranger.send("POST /a HTTP/1.1\r\nContent-Length: 1000\r\n\r\n");
    EXPECT_EQ(test::parsed(stranger.receive()).status, 401);
}

TEST(Connections, AreKeptWhereThePeerAsksAndCheckEachRequest) {
    const Echo echo({});
    const Client browser(echo.port());
    const std::string asks = " HTTP/1.1\r\nConnection: Keep-Alive\r\nX-May-Ask: 1\r\n\r\n";
    for (const char* path : {"/a", "/b"}) {
        browser.send(std::string("GET ") + path + asks);
        const test::Answer answer = test::parsed(browser.receive_some());
        EXPECT_EQ(answer.body, path);
        EXPECT_EQ(answer.header("Connection"), "keep-alive");
    }
    browser.send("GET /c HTTP/1.1\r\nConnection: keep-alive\r\n\r\n");
    const test::Answer refused = test::parsed(browser.receive());
    EXPECT_EQ(refused.status, 401) << "another page's, over the same connection";
    EXPECT_EQ(refused.header("Connection"), "close");
}

TEST(Incoming, IsTheSameRequestHoweverItsBytesAreDivided) {
    const std::string bytes = "POST /a HTTP/1.1\r\nA: b\r\nContent-Length: 5\r\n\r\n12345GET";
    for (std::size_t piece = 1; piece <= bytes.size(); ++piece) {
        Incoming incoming;
        for (std::size_t at = 0; at < bytes.size() && !incoming.is_whole(); at += piece)
            EXPECT_FALSE(incoming.add(bytes.substr(at, piece)));
        ASSERT_TRUE(incoming.is_whole()) << piece;
        const Request request = incoming.take();
        EXPECT_EQ(request.path + " " + request.header("a") + " " + request.body, "/a b 12345") << piece;
    }
}

TEST(Incoming, LooksAtNoByteTwice) {
    std::string head = "POST /a HTTP/1.1\r\nContent-Length: 1000000\r\n";
    for (int i = 0; i < 50; ++i) head += "X-" + std::to_string(i) + ": " + std::string(200, 'x') + "\r\n";
    const std::string bytes = head + "\r\n" + std::string(1'000'000, ' ');
    const auto start = std::chrono::steady_clock::now();
    Incoming incoming;
    for (const char& byte : bytes) ASSERT_FALSE(incoming.add({&byte, 1}));
    EXPECT_TRUE(incoming.is_whole());
    EXPECT_LT(std::chrono::steady_clock::now() - start, 1s) << "reading the head a million times takes 20 s";
}

TEST(Incoming, IsRefusedAtItsLimits) {
    const auto status = [](const std::string& bytes) {
        const auto refusal = Incoming().add(bytes);
        return refusal ? refusal->status : 0;
    };
    const auto lines = [](std::size_t count) {
        std::string head = "GET / HTTP/1.1\r\n";
        for (std::size_t i = 2; i < count; ++i) head += "X-" + std::to_string(i) + ": y\r\n";
        return head + "\r\n";
    };
    EXPECT_EQ(status(lines(kMaxHeadLines)), 0);
    EXPECT_EQ(status(lines(kMaxHeadLines + 1)), 431);
    const std::string start = "GET / HTTP/1.1\r\nX: ";
    const auto head = [&](std::size_t bytes) { return start + std::string(bytes - start.size(), 'x'); };
    EXPECT_EQ(status(head(kMaxHeadBytes) + "\r\n\r\n"), 0);
    EXPECT_EQ(status(head(kMaxHeadBytes + 1) + "\r\n\r\n"), 431);
    EXPECT_EQ(status(head(kMaxHeadBytes)), 0) << "its end may come";
    EXPECT_EQ(status("GET / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\n"), 411);
    EXPECT_EQ(status("GET / HTTP/1.1\r\nContent-Length: 1048577\r\n\r\n"), 413);
    EXPECT_EQ(status("GET / HTTP/1.1\r\nContent-Length: -1\r\n\r\n"), 400);
}

TEST(HttpMessage, IsReadStrictly) {
    const auto request = parse_request("GET /a?x=1%2B2&y=a+b HTTP/1.1\r\nHost:  h \r\n\r\n");
    ASSERT_TRUE(request);
    EXPECT_EQ(request->path, "/a");
    EXPECT_EQ(request->parameter("x"), "1+2");
    EXPECT_EQ(request->parameter("y"), "a b");
    EXPECT_EQ(request->header("host"), "h");
    for (const char* bytes :
         {"GET /a HTTP/1.0\r\n\r\n", "GET a HTTP/1.1\r\n\r\n", "GET http://h/ HTTP/1.1\r\n\r\n",
          "G@T / HTTP/1.1\r\n\r\n", "GET /?x=%2 HTTP/1.1\r\n\r\n", "GET /?x=%zz HTTP/1.1\r\n\r\n",
          "GET /?x=1&x=2 HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nHost: a\r\nhost: b\r\n\r\n",
          "GET / HTTP/1.1\r\n folded: x\r\n\r\n", "GET / HTTP/1.1\r\nA\r\n\r\n", "\r\n\r\n"})
        EXPECT_FALSE(parse_request(bytes)) << bytes;
}

TEST(HttpMessage, OfAnErrorIsWholeJsonWhateverItsText) {
    const Response response = error_response(400, "\"</script>\n\xff");
    EXPECT_TRUE(nlohmann::json::parse(response.body).contains("error"));
}

TEST(Guards, MakeATokenThatIsNeverTheSame) {
    const std::string token = random_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_NE(token, random_token());
    EXPECT_TRUE(equal_in_constant_time(token, std::string(token)));
    EXPECT_FALSE(equal_in_constant_time(token, token.substr(1)));
    EXPECT_FALSE(equal_in_constant_time(token, std::string(32, 'x')));
}

}  // namespace
}  // namespace aftershade::serve
