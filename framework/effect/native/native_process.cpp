#include "framework/effect/native/native_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>
#include <string_view>

#include "framework/base/child_process.h"
#include "framework/base/error.h"
#include "framework/base/option.h"
#include "framework/base/text.h"
#include "framework/document/units.h"
#include "framework/effect/native/native_call.h"
#include "framework/effect/native/native_wire.h"
#include "framework/effect/native/thread_limit.h"

namespace aftershade {

namespace {

using Clock = std::chrono::steady_clock;

/// Of all that plug-ins print in a run.
constexpr std::size_t kMaxPrinted = 1 << 20;
/// A process that ended this often is not started again: some work would begin, and wait, again and again.
constexpr int kMostStarts = 3;
/// For what libraries do at their end.
constexpr auto kTimeToEnd = std::chrono::milliseconds(500);

/// Where libraries are, how text and threads are meant, and sanitizers' settings: the others may be secrets.
bool is_passed_on(std::string_view variable) {
    for (const std::string_view name : {"PATH", "HOME", "LANG", "TZ", "LD_LIBRARY_PATH", "OMP_NUM_THREADS"})
        if (variable == name) return true;
    return variable.starts_with("LC_") || variable.ends_with("SAN_OPTIONS");
}

std::vector<std::string> environment_of_plugins() {
    std::vector<std::string> variables;
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view text = *entry;
        if (is_passed_on(text.substr(0, text.find('=')))) variables.emplace_back(text);
    }
    return variables;
}

/// A result with what its declaration does not allow taken as a fault, as if the plug-in had set it here.
NativeResult checked(const NativeDeclaration& declaration, NativeResult&& untrusted,
                     const std::string& what) {
    NativeFaults faults;
    NativeOutput taken(declaration, faults);
    const aftershade_output* output = taken.get();
    for (const auto& [name, uniform] : untrusted.uniforms) {
        const char* const id = name.c_str();
        if (const auto* floats = std::get_if<std::vector<float>>(&uniform))
            output->set_float(output, id, floats->data(), std::uint32_t(floats->size()));
        if (const auto* ints = std::get_if<std::vector<std::int32_t>>(&uniform))
            output->set_int(output, id, ints->data(), std::uint32_t(ints->size()));
        if (const auto* uints = std::get_if<std::vector<std::uint32_t>>(&uniform))
            output->set_uint(output, id, uints->data(), std::uint32_t(uints->size()));
    }
    for (const auto& [name, table] : untrusted.tables)
        output->set_table(output, name.c_str(), aftershade_element(table.element), std::uint32_t(table.width),
                          std::uint32_t(table.height), table.bytes.data(), table.bytes.size());
    for (const auto& [pass, count] : untrusted.repeats) output->set_repeat(output, pass.c_str(), count);
    for (const auto& [pass, enabled] : untrusted.enabled) output->set_enabled(output, pass.c_str(), enabled);
    output->set_warm_up_frames(output, untrusted.warm_up_frames);
    output->set_overscan(output, untrusted.overscan_px);
    taken.require_everything();
    if (!faults.empty()) throw Error(ErrorKind::effect, what + ": " + faults.text());
    NativeResult result = taken.take();
    result.log = std::move(untrusted.log);
    return result;
}

}  // namespace

struct NativeProcess::Impl {
    /// What plug-ins print, line by line, on standard error.
    class Printed {
    public:
        void take(std::string_view bytes) {
            const std::size_t left = kMaxPrinted - std::min(kMaxPrinted, count_);
            count_ += bytes.size();
            pending_ += bytes.substr(0, left);
            for (std::size_t end; (end = pending_.find('\n')) != std::string::npos;
                 pending_.erase(0, end + 1))
                print(pending_.substr(0, end));
            if (left > 0 && count_ > kMaxPrinted)
                print("aftershade: warning: plug-ins print more than 1 MiB; the rest is left out");
        }
        void finish() {
            if (!pending_.empty()) print(std::exchange(pending_, ""));
        }

    private:
        static void print(const std::string& line) { std::fprintf(stderr, "%s\n", printable(line).c_str()); }
        std::size_t count_ = 0;
        std::string pending_;
    };

    struct Instance {
        NativeDeclaration declaration;
        WorkStatus place;
    };

    NativeProcessOptions options;
    pid_t process = -1;
    Descriptor stream, output;
    std::string received;
    Printed printed;
    Confinement held;
    std::optional<ThreadLimit> threads;
    std::map<int, Instance> instances;
    int last_instance = 0;
    int starts = 0;

    void start() {
        if (++starts > kMostStarts)
            throw Error(ErrorKind::effect, "plug-ins ended their process " + std::to_string(kMostStarts) +
                                               " times; it is not started again");
        auto [mine, theirs] = make_socket_pair();
        Pipe prints = make_pipe();
        ChildCommand command;
        command.arguments = options.command;
        command.environment = environment_of_plugins();
        command.descriptors = {-1, prints.write.get(), prints.write.get(), theirs.get()};
        command.limits.memory_bytes = options.memory_bytes;
        process = spawn_child(command);
        // While this process holds the child's ends, it cannot see that the child has ended.
        theirs.reset();
        prints.write.reset();
        stream = std::move(mine);
        output = std::move(prints.read);
        for (const Descriptor* end : {&stream, &output}) fcntl(end->get(), F_SETFL, O_NONBLOCK);
        received.clear();
        WorkStatus starting;
        starting.phase = "the start of its process";
        const auto deadline = Clock::now() + deadline_after();
        limit_threads(starting, deadline);
        const std::string hello = receive(starting, deadline);
        WireReader in(hello);
        held = Confinement{int(in.number()), in.flag(), in.flag(), std::uint64_t(in.number())};
        if (const auto gaps = confinement_gaps(held); !gaps.empty() && options.warns && starts == 1)
            std::fprintf(stderr,
                         "aftershade: warning: this kernel does not keep plug-ins from being able to %s\n",
                         joined(gaps, " and to ", ", to ").c_str());
    }

    void limit_threads(const WorkStatus& place, Clock::time_point deadline) {
        Descriptor notices;
        while (!receive_thread_notices(stream.get(), notices)) {
            if (errno != EAGAIN && errno != EINTR) ended(place);
            wait(POLLIN, place, deadline);
        }
        if (notices.get() >= 0) threads.emplace(std::move(notices), process, most_plugin_threads());
    }

    /// Gives it time to leave in order; then it is killed. Its status as waitpid(2) has it.
    int finish(bool at_once) {
        stream.reset();
        const auto give_up = Clock::now() + kTimeToEnd;
        siginfo_t ended{};
        while (!at_once && ended.si_pid == 0 && Clock::now() < give_up) {
            waitid(P_PID, id_t(process), &ended, WEXITED | WNOHANG | WNOWAIT);
            pollfd none{output.get(), POLLIN, 0};
            if (ended.si_pid == 0) poll(&none, 1, 5);
            read_output();
        }
        if (ended.si_pid == 0) kill(process, SIGKILL);
        threads.reset();
        const int status = reap(std::exchange(process, -1));
        read_output();
        printed.finish();
        output.reset();
        instances.clear();
        return status;
    }

    std::string call(const WireWriter& request, const WorkStatus& place) {
        if (process < 0) start();
        const auto deadline = Clock::now() + deadline_after();
        std::string bytes;
        const std::uint64_t size = request.bytes().size();
        bytes.append(reinterpret_cast<const char*>(&size), sizeof size);
        send(bytes + request.bytes(), place, deadline);
        const std::string reply = receive(place, deadline);
        read_output();
        return reply;
    }

    Clock::duration deadline_after() const {
        return std::chrono::duration_cast<Clock::duration>(options.timeout);
    }

    void send(std::string_view bytes, const WorkStatus& place, Clock::time_point deadline) {
        while (!bytes.empty()) {
            const ssize_t sent = ::send(stream.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (sent > 0) bytes.remove_prefix(std::size_t(sent));
            else if (sent < 0 && errno != EAGAIN && errno != EINTR) ended(place);
            else wait(POLLOUT, place, deadline);
        }
    }

    std::string receive(const WorkStatus& place, Clock::time_point deadline) {
        std::uint64_t size = 0;
        for (;;) {
            if (received.size() >= sizeof size) {
                std::memcpy(&size, received.data(), sizeof size);
                if (size > kMaxNativeMessage) refuse(place, "sent a message that is too long");
                if (received.size() - sizeof size >= size) break;
            }
            std::array<char, 65536> buffer;
            const ssize_t got = recv(stream.get(), buffer.data(), buffer.size(), 0);
            if (got > 0) received.append(buffer.data(), std::size_t(got));
            else if (got == 0 || (errno != EAGAIN && errno != EINTR)) ended(place);
            else wait(POLLIN, place, deadline);
        }
        std::string message = received.substr(sizeof size, std::size_t(size));
        received.erase(0, sizeof size + std::size_t(size));
        return message;
    }

    void wait(short what, const WorkStatus& place, Clock::time_point deadline) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
        if (left <= 0)
            refuse(place,
                   "did not finish within " + format_number(options.timeout.count()) + " s and was killed",
                   advice("; give it longer with ", Option::plugin_timeout, "", ""));
        std::array<pollfd, 2> wanted = {{{stream.get(), what, 0}, {output.get(), POLLIN, 0}}};
        poll(wanted.data(), wanted.size(), int(std::min<std::int64_t>(left, 1000)));
        if (wanted[1].revents) read_output();
    }

    /// One piece of what was printed: more would keep this process from looking at the clock.
    void read_output() {
        std::array<char, 65536> buffer;
        const ssize_t got = output.get() < 0 ? 0 : read(output.get(), buffer.data(), buffer.size());
        if (got > 0) printed.take({buffer.data(), std::size_t(got)});
        if (got == 0) output.reset();
    }

    [[noreturn]] void refuse(const WorkStatus& place, const std::string& why,
                             const std::string& remedy = "") {
        finish(true);
        throw Error(ErrorKind::effect, subject(place) + " " + why + place_text(place) + remedy);
    }

    [[noreturn]] void ended(const WorkStatus& place) {
        const int status = finish(false);
        std::string why;
        if (WIFEXITED(status)) why = "ended the process with code " + std::to_string(WEXITSTATUS(status));
        else if (WTERMSIG(status) == SIGKILL) why = "was killed " + signal_text(SIGKILL);
        else why = "crashed " + signal_text(WTERMSIG(status));
        const bool lacks_memory = place.plugin.empty() && options.memory_bytes;
        throw Error(
            ErrorKind::effect,
            subject(place) + " " + why + place_text(place) +
                (lacks_memory ? advice("; give it more memory with ", Option::plugin_memory, "", "") : ""));
    }

    static std::string subject(const WorkStatus& place) {
        return place.plugin.empty() ? "the process of the plug-ins" : "plug-in " + place.plugin;
    }

    /// What `take` reads of the reply; what failed over there fails here. A process that does not keep to the
    /// protocol is ended.
    template <class Take>
    auto answer(const WireWriter& request, const WorkStatus& place, const Take& take) {
        const std::string reply = call(request, place);
        WireReader in(reply);
        std::optional<std::string> fault;
        try {
            if (in.flag()) {
                auto taken = take(in);
                in.expect_end();
                return taken;
            }
            fault = in.text();
        } catch (const Error&) {
            refuse(place, "broke into the host's own talk with its process");
        }
        throw Error(ErrorKind::effect, printable(*fault));
    }
    void answer(const WireWriter& request, const WorkStatus& place) {
        answer(request, place, [](WireReader&) { return true; });
    }

    const Instance& instance(int number) const {
        const auto found = instances.find(number);
        if (found == instances.end())
            throw Error(ErrorKind::effect, "the process of the plug-ins has ended with an earlier fault");
        return found->second;
    }
};

NativeProcess::NativeProcess(NativeProcessOptions options) : impl_(std::make_unique<Impl>()) {
    impl_->options = std::move(options);
}

NativeProcess::~NativeProcess() {
    if (impl_->process > 0) impl_->finish(false);
}

const Confinement& NativeProcess::held() {
    if (impl_->process < 0) impl_->start();
    return impl_->held;
}

NativeProcess::Offer NativeProcess::open(const std::filesystem::path& library) {
    WireWriter request;
    request.number(std::int64_t(NativeRequest::open));
    request.text(library.string());
    WorkStatus place;
    place.plugin = library.string();
    place.phase = "load";
    return impl_->answer(request, place, [](WireReader& in) {
        Offer offer;
        offer.contact = in.text();
        for (std::size_t left = in.count(); left > 0; --left) {
            std::string id = in.text();
            offer.effects.emplace_back(std::move(id), in.text());
        }
        return offer;
    });
}

int NativeProcess::create(const std::filesystem::path& library, const NativeDeclaration& declaration,
                          const std::string& step) {
    WireWriter request;
    request.number(std::int64_t(NativeRequest::create));
    request.number(++impl_->last_instance);
    request.text(library.string());
    request.text(step);
    put(request, declaration);
    const WorkStatus place{step, library.string(), "create", {}};
    impl_->answer(request, place);
    impl_->instances[impl_->last_instance] = {declaration, place};
    return impl_->last_instance;
}

NativeResult NativeProcess::prepare(int number, const NativeFrame& frame) {
    const Impl::Instance instance = impl_->instance(number);
    WireWriter request;
    request.number(std::int64_t(NativeRequest::prepare));
    request.number(number);
    put(request, frame);
    WorkStatus place = instance.place;
    place.phase = "prepare";
    place.frame = frame.number;
    NativeResult result = impl_->answer(request, place, take_result);
    return checked(instance.declaration, std::move(result),
                   "step '" + place.step + "': " + place.plugin + ": prepare");
}

void NativeProcess::reset(int number) {
    WorkStatus place = impl_->instance(number).place;
    place.phase = "reset";
    WireWriter request;
    request.number(std::int64_t(NativeRequest::reset));
    request.number(number);
    impl_->answer(request, place);
}

void NativeProcess::destroy(int number) {
    const auto found = impl_->instances.find(number);
    if (found == impl_->instances.end()) return;
    WorkStatus place = found->second.place;
    place.phase = "destroy";
    WireWriter request;
    request.number(std::int64_t(NativeRequest::destroy));
    request.number(number);
    impl_->instances.erase(found);
    impl_->answer(request, place);
}

}  // namespace aftershade
