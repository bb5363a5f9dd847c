#include "framework/serve/connections.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "framework/serve/guards.h"
#include "framework/serve/http_message.h"
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
              connections_.run(
                  [](const Request& request) {
                      return Response{200, "text/plain", request.path};
                  },
                  stop_);
          }) {}
    ~Echo() {
        stop_ = true;
        thread_.join();
    }
    int port() const { return connections_.port(); }
    test::Answer ask() const {
        const Client client(port());
        client.send("GET /a HTTP/1.1\r\n\r\n");
        return test::parsed(client.receive());
    }

private:
    std::atomic<bool> stop_ = false;
    Connections connections_;
    std::thread thread_;
};

TEST(Connections, EndARequestThatComesTooSlowly) {
    const Echo echo({.request = 200ms});
    const Client slow(echo.port());
    slow.send("POST / HTTP/1.1\r\nContent-Length: 10\r\n\r\n1");
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
        deaf.back()->send("GET /b HTTP/1.1\r\n\r\n");
    }
    EXPECT_EQ(echo.ask().status, 200);
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
