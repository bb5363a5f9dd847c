// A worker's process and its pipes: internal to framework/batch.
#pragma once

#include <sys/types.h>

#include "framework/base/child_process.h"
#include "framework/batch/worker_command.h"

namespace aftershade {

struct SpawnedWorker {
    pid_t process = -1;             ///< also the id of its process group
    Descriptor out, error, status;  ///< reading ends, not blocking; of its own streams there are none
};

/// Throws Error(ErrorKind::effect) where the program cannot be started.
SpawnedWorker spawn_worker(const WorkerCommand& command);

}  // namespace aftershade
