// A peer of the server that sends the bytes that a test wants it to send.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <string>

#include <nlohmann/json.hpp>

namespace aftershade::test {

using Json = nlohmann::ordered_json;

/// A connection that says what the test wants it to say.
class Client {
public:
    explicit Client(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const timeval patience{60, 0};
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(std::uint16_t(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        is_open_ = ::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;
    ~Client() { ::close(socket_); }

    bool is_open() const { return is_open_; }
    bool send(const std::string& bytes) const {
        std::size_t sent = 0;
        while (sent < bytes.size()) {
            const ssize_t count = ::send(socket_, &bytes[sent], bytes.size() - sent, MSG_NOSIGNAL);
            if (count <= 0) return false;
            sent += std::size_t(count);
        }
        return true;
    }
    /// What is there of an answer, once something is.
    std::string receive_some() const {
        char buffer[65536];
        const ssize_t got = ::recv(socket_, buffer, sizeof buffer, 0);
        return got > 0 ? std::string(buffer, std::size_t(got)) : "";
    }
    std::string receive() const {
        std::string bytes;
        char buffer[65536];
        for (ssize_t got; (got = ::recv(socket_, buffer, sizeof buffer, 0)) > 0;)
            bytes.append(buffer, std::size_t(got));
        return bytes;
    }

private:
    int socket_;
    bool is_open_ = false;
};

struct Answer {
    int status = 0;
    std::string head;
    std::string body;
    Json json() const { return Json::parse(body); }
    std::string header(const std::string& name) const {
        const std::size_t at = head.find("\r\n" + name + ": ");
        if (at == std::string::npos) return "";
        const std::size_t begin = at + name.size() + 4;
        return head.substr(begin, head.find("\r\n", begin) - begin);
    }
};

inline Answer parsed(const std::string& bytes) {
    if (!bytes.starts_with("HTTP/1.1 ")) return {};
    const std::size_t end = bytes.find("\r\n\r\n");
    return {std::stoi(bytes.substr(9, 3)), bytes.substr(0, end + 2), bytes.substr(end + 4)};
}

}  // namespace aftershade::test
