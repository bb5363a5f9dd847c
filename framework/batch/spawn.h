// fork and exec with limits: internal to framework/batch.
#pragma once

#include <sys/types.h>

#include "framework/batch/worker.h"

namespace aftershade {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    ~Descriptor() { reset(); }
    Descriptor(Descriptor&& other) noexcept : number_(other.number_) { other.number_ = -1; }
    Descriptor& operator=(Descriptor&& other) noexcept;

    int get() const { return number_; }
    void reset();

private:
    int number_;
};

struct SpawnedWorker {
    pid_t process = -1;             ///< also the id of its process group
    Descriptor out, error, status;  ///< reading ends, not blocking
};

/// Throws Error(ExitCode::effect) where the program cannot be started.
SpawnedWorker spawn_worker(const WorkerCommand& command);

}  // namespace aftershade
