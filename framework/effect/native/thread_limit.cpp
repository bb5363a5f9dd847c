#include "framework/effect/native/thread_limit.h"

#include <linux/seccomp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

namespace aftershade {

namespace {

/// The threads that it has; a great many where /proc does not say.
std::uint64_t thread_count(const std::string& folder) {
    struct stat status {};
    return stat(folder.c_str(), &status) == 0 ? status.st_nlink - 2 : ~0ull;  // "." and ".."
}

void answer(const Descriptor& notices, const Descriptor& stop, const std::string& folder, unsigned most) {
    seccomp_notif_sizes sizes{};
    if (syscall(SYS_seccomp, SECCOMP_GET_NOTIF_SIZES, 0, &sizes) != 0) return;
    // Of 64-bit words, for their alignment; the kernel's structures may be longer than the header's.
    std::vector<std::uint64_t> request(std::max<std::size_t>(sizes.seccomp_notif, sizeof(seccomp_notif)) / 8 +
                                       1);
    std::vector<std::uint64_t> reply(
        std::max<std::size_t>(sizes.seccomp_notif_resp, sizeof(seccomp_notif_resp)) / 8 + 1);
    for (;;) {
        std::array<pollfd, 2> wanted = {{{notices.get(), POLLIN, 0}, {stop.get(), POLLIN, 0}}};
        if (poll(wanted.data(), wanted.size(), -1) < 0 && errno != EINTR) return;
        if (wanted[1].revents != 0 || (wanted[0].revents & (POLLHUP | POLLERR))) return;
        if (!(wanted[0].revents & POLLIN)) continue;
        std::fill(request.begin(), request.end(), 0);
        if (ioctl(notices.get(), SECCOMP_IOCTL_NOTIF_RECV, request.data()) != 0) continue;  // it has ended
        seccomp_notif_resp says{};
        std::memcpy(&says.id, request.data(), sizeof says.id);
        if (thread_count(folder) < most) says.flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE;
        else says.error = -EAGAIN;
        std::memcpy(reply.data(), &says, sizeof says);
        ioctl(notices.get(), SECCOMP_IOCTL_NOTIF_SEND, reply.data());
    }
}

/// A message of one byte, with room for one descriptor.
struct Message {
    char byte = 0;
    iovec bytes{&byte, 1};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> room{};
    msghdr header{nullptr, 0, &bytes, 1, room.data(), room.size(), 0};
};

}  // namespace

unsigned most_plugin_threads() {
    return std::max(512u, 4 * std::thread::hardware_concurrency());
}

bool send_thread_notices(int stream, int notices) {
    Message message;
    if (notices < 0) message.header.msg_controllen = 0;
    if (cmsghdr* const sent = CMSG_FIRSTHDR(&message.header)) {
        sent->cmsg_level = SOL_SOCKET;
        sent->cmsg_type = SCM_RIGHTS;
        sent->cmsg_len = CMSG_LEN(sizeof notices);
        std::memcpy(CMSG_DATA(sent), &notices, sizeof notices);
    }
    return sendmsg(stream, &message.header, MSG_NOSIGNAL) == 1;
}

bool receive_thread_notices(int stream, Descriptor& notices) {
    Message message;
    const ssize_t got = recvmsg(stream, &message.header, MSG_CMSG_CLOEXEC);
    if (got == 0) errno = 0;
    if (got != 1) return false;
    const cmsghdr* const sent = CMSG_FIRSTHDR(&message.header);
    int number = -1;
    if (sent && sent->cmsg_type == SCM_RIGHTS) std::memcpy(&number, CMSG_DATA(sent), sizeof number);
    notices = Descriptor(number);
    return true;
}

ThreadLimit::ThreadLimit(Descriptor notices, pid_t process, unsigned most) : stop_(make_pipe()) {
    const std::string folder = "/proc/" + std::to_string(process) + "/task";
    // Signals are for the threads that expect them.
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    thread_ = std::thread([notices = std::move(notices), &stop = stop_.read, folder, most] {
        answer(notices, stop, folder, most);
    });
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

ThreadLimit::~ThreadLimit() {
    stop_.write.reset();
    thread_.join();
}

}  // namespace aftershade
