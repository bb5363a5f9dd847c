#include "framework/batch/spawn.h"

#include <fcntl.h>
#include <unistd.h>

#include "framework/base/status.h"

namespace aftershade {

namespace {

constexpr int kStatusDescriptor = 3;

std::vector<std::string> child_environment(const WorkerCommand& command) {
    std::map<std::string, std::string> added = command.environment;
    added[kStatusFdVariable] = std::to_string(kStatusDescriptor);
    std::vector<std::string> all;
    for (char** entry = environ; *entry; ++entry) {
        const std::string text = *entry, name = text.substr(0, text.find('='));
        if (!added.contains(name) && !command.without.contains(name)) all.push_back(text);
    }
    for (const auto& [name, value] : added) all.push_back(name + "=" + value);
    return all;
}

}  // namespace

SpawnedWorker spawn_worker(const WorkerCommand& command) {
    Pipe out = make_pipe(), error = make_pipe(), status = make_pipe();
    const bool shares = command.shares_streams;
    ChildCommand child;
    child.arguments = command.arguments;
    child.environment = child_environment(command);
    child.descriptors = {command.input, shares ? STDOUT_FILENO : out.write.get(),
                         shares ? STDERR_FILENO : error.write.get(), status.write.get()};
    child.limits = static_cast<const ChildLimits&>(command.limits);
    child.leads_group = true;
    SpawnedWorker spawned;
    spawned.process = spawn_child(child);
    spawned.status = std::move(status.read);
    if (!shares) {
        spawned.out = std::move(out.read);
        spawned.error = std::move(error.read);
    }
    for (const Descriptor* end : {&spawned.out, &spawned.error, &spawned.status})
        if (end->get() >= 0) fcntl(end->get(), F_SETFL, O_NONBLOCK);
    return spawned;
}

}  // namespace aftershade
