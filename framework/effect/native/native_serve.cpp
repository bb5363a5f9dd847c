// The process that native code of strangers runs in.
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <map>
#include <string>
#include <string_view>

#include "framework/base/error.h"
#include "framework/effect/native/confinement.h"
#include "framework/effect/native/native_effect.h"
#include "framework/effect/native/native_library.h"
#include "framework/effect/native/native_process.h"
#include "framework/effect/native/native_wire.h"

namespace aftershade {

namespace {

/// Ends the process where the other side is gone.
class Stream {
public:
    explicit Stream(int descriptor) : descriptor_(descriptor) {}

    /// False at the end.
    bool receive(std::string& message) const {
        std::uint64_t size = 0;
        if (!read_all(reinterpret_cast<char*>(&size), sizeof size) || size > kMaxNativeMessage) return false;
        message.resize(std::size_t(size));
        return read_all(message.data(), message.size());
    }
    bool send(const std::string& message) const {
        const std::uint64_t size = message.size();
        return write_all({reinterpret_cast<const char*>(&size), sizeof size}) && write_all(message);
    }

private:
    bool read_all(char* bytes, std::size_t count) const {
        while (count > 0) {
            const ssize_t got = read(descriptor_, bytes, count);
            if (got < 0 && errno == EINTR) continue;
            if (got <= 0) return false;
            bytes += got;
            count -= std::size_t(got);
        }
        return true;
    }
    bool write_all(std::string_view bytes) const {
        while (!bytes.empty()) {
            const ssize_t put = write(descriptor_, bytes.data(), bytes.size());
            if (put < 0 && errno == EINTR) continue;
            if (put <= 0) return false;
            bytes.remove_prefix(std::size_t(put));
        }
        return true;
    }

    int descriptor_;
};

class Server {
public:
    /// The reply's content.
    std::string answer(const std::string& request) {
        WireReader in(request);
        WireWriter out;
        out.flag(true);
        switch (NativeRequest(in.number())) {
            case NativeRequest::open: offer(in.text(), out); break;
            case NativeRequest::create: create(in); break;
            case NativeRequest::prepare: {
                NativeEffect& effect = instances_.at(int(in.number()));
                WireFrame frame;
                take_frame(in, frame);
                put(out, effect.prepare(frame.frame));
                break;
            }
            case NativeRequest::reset: instances_.at(int(in.number())).reset(); break;
            case NativeRequest::destroy: instances_.erase(int(in.number())); break;
        }
        return out.bytes();
    }

private:
    const std::shared_ptr<NativeLibrary>& library(const std::string& file) {
        auto known = libraries_.find(file);
        if (known == libraries_.end()) known = libraries_.emplace(file, NativeLibrary::open(file)).first;
        return known->second;
    }

    void offer(const std::string& file, WireWriter& out) {
        const NativeLibrary& offers = *library(file);
        out.text(offers.contact());
        out.number(std::int64_t(offers.effects().size()));
        for (const NativeLibrary::Effect& effect : offers.effects()) {
            out.text(effect.id);
            out.text(effect.version);
        }
    }

    void create(WireReader& in) {
        const int number = int(in.number());
        const auto& opened = library(in.text());
        const std::string step = in.text();
        NativeDeclaration declaration = take_declaration(in);
        for (const NativeLibrary::Effect& effect : opened->effects())
            if (effect.id == declaration.effect_id) {
                instances_.emplace(number, NativeEffect(opened, effect, std::move(declaration), step));
                return;
            }
        throw Error(ErrorKind::effect,
                    opened->place() + ": offers no native code for '" + declaration.effect_id + "'");
    }

    std::map<std::string, std::shared_ptr<NativeLibrary>> libraries_;  // by file; outlive the instances
    std::map<int, NativeEffect> instances_;
};

}  // namespace

int serve_native_code(int descriptor) {
    // An interrupt lets the run finish its frame, for which it needs this process; a terminal sends it to
    // all.
    for (const int number : {SIGINT, SIGTERM}) std::signal(number, SIG_IGN);
    const Confinement held = confine_native_code(descriptor);
    const Stream stream(descriptor);
    WireWriter hello;
    hello.number(held.landlock_abi);
    hello.flag(held.seccomp);
    hello.flag(held.counts_threads);
    hello.number(std::int64_t(held.memory_bytes));
    if (!stream.send(hello.bytes())) return 0;
    Server server;
    for (std::string request; stream.receive(request);) {
        std::string reply;
        try {
            reply = server.answer(request);
        } catch (const std::exception& error) {
            WireWriter out;
            out.flag(false);
            out.text(error.what());
            reply = out.bytes();
        }
        std::fflush(nullptr);  // what the plug-in printed comes before what follows from it
        if (!stream.send(reply)) break;
    }
    return 0;
}

}  // namespace aftershade
