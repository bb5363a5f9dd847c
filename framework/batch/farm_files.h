// A run divided into tasks, and the files of it that farms read. Nothing here talks to a service.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "framework/batch/job_plan.h"

namespace aftershade {

/// The history of a task that begins within a shot.
enum class FarmHistory {
    none,    ///< nothing: the look has no history, or restarts it
    warmup,  ///< what a few frames rendered before the part leave
    exact    ///< all of it, from the task before, which must have ended
};

struct FarmJob {
    std::string name;  ///< a DNS label (RFC 1123), which every farm accepts
    std::string program;
    /// Arguments after the program's path: "run", the look, the capture, outputs and options, except the part
    /// of the frames, the history and the report.
    std::vector<std::string> arguments;
    std::filesystem::path working_folder;              ///< of the tasks; absolute
    std::filesystem::path folder;                      ///< of the job's files; absolute
    std::map<std::string, std::string> environment{};  ///< of the tasks
    FarmHistory history = FarmHistory::none;
    /// Tasks in the order of the frames, from 1, by row. Those of a row wait for one another, rows do not.
    std::vector<std::vector<int>> rows;

    int cpus = 1;                    ///< of each task
    std::uint64_t memory_bytes = 0;  ///< of each task; 0: the farm's default
    int minutes = 0;                 ///< that a task may take; 0: the farm's default
    int retries = 0;                 ///< of a task that failed
    // Kubernetes.
    std::string image;
    std::string volume_claim;
    std::filesystem::path mount;  ///< where the tasks find the volume; every path lies below it

    int tasks() const;
};

/// With exact history a row is the tasks of one shot, or those up to a gap in the frame numbers; else each
/// task is a row. There are at most as many tasks as frames.
std::vector<std::vector<int>> farm_rows(const JobFrames& run, int tasks, FarmHistory history);

struct FarmFile {
    std::string name;  ///< within the job's folder
    std::string text;
};

struct FarmFiles {
    std::vector<FarmFile> files;
    std::vector<std::string> submit;   ///< the command that submits the job
    std::vector<std::string> remarks;  ///< what the farm cannot do or needs, a sentence each
};

/// The number as names of reports and histories have it: "0012".
std::string task_name(int task);

/// sh, with the path of a script in the job's folder.
std::vector<std::string> farm_script(const FarmJob& job, const std::string& name);
/// In MiB, rounded up: the unit that all farms take.
std::uint64_t farm_mebibytes(const FarmJob& job);

// Each adds its files, the command and remarks.
void add_slurm_files(const FarmJob& job, FarmFiles& out);
void add_openjd_files(const FarmJob& job, FarmFiles& out);
void add_kubernetes_files(const FarmJob& job, FarmFiles& out);
void add_opencue_files(const FarmJob& job, FarmFiles& out);
void add_parallel_files(const FarmJob& job, FarmFiles& out);

/// "slurm", "openjd", "kubernetes", "opencue", "parallel"
const std::vector<std::string>& farm_names();

/// The files of one farm, with task.sh and merge.sh, which all of them start. Throws Error(usage) where the
/// farm cannot take the job, such as more tasks in a row than it has steps.
FarmFiles farm_files(std::string_view farm, const FarmJob& job);

}  // namespace aftershade
