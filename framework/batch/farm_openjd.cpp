#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/batch/farm_files.h"

namespace aftershade {

namespace {

// https://github.com/OpenJobDescription/openjd-specifications/wiki/2023-09-Template-Schemas
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostSteps = 100;

Json openjd_script(const FarmJob& job, const std::string& name, const std::string& argument) {
    std::vector<std::string> words = farm_script(job, name);
    words.erase(words.begin());
    if (!argument.empty()) words.push_back(argument);
    Json run = {{"command", "sh"}, {"args", words}};
    if (job.minutes > 0) run["timeout"] = job.minutes * 60;
    // A first SIGTERM lets the frame at hand end whole.
    run["cancelation"] = {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", 30}};
    return {{"actions", {{"onRun", run}}}};
}

Json openjd_tasks(const FarmJob& job, const std::string& name, int first, int last) {
    Json amounts = Json::array({{{"name", "amount.worker.vcpu"}, {"min", job.cpus}}});
    if (job.memory_bytes > 0)
        amounts.push_back({{"name", "amount.worker.memory"}, {"min", farm_mebibytes(job)}});
    const Json task = {{"name", "Task"}, {"type", "INT"}, {"range", fmt::format("{}-{}", first, last)}};
    return {{"name", name},
            {"parameterSpace", {{"taskParameterDefinitions", Json::array({task})}}},
            {"hostRequirements", {{"amounts", amounts}}},
            {"script", openjd_script(job, "task.sh", "{{Task.Param.Task}}")}};
}

Json depends_on(const std::vector<std::string>& steps) {
    Json all = Json::array();
    for (const std::string& step : steps) all.push_back({{"dependsOn", step}});
    return all;
}

/// One step whose tasks run in any order; or, with exact history, a step for each task.
Json openjd_steps(const FarmJob& job) {
    Json steps = Json::array();
    std::vector<std::string> ends;
    if (job.history != FarmHistory::exact) {
        steps.push_back(openjd_tasks(job, "frames", 1, job.tasks()));
        ends = {"frames"};
    } else {
        for (const std::vector<int>& row : job.rows) {
            for (const int task : row) {
                Json step = openjd_tasks(job, "part-" + task_name(task), task, task);
                if (task != row.front()) step["dependencies"] = depends_on({"part-" + task_name(task - 1)});
                steps.push_back(std::move(step));
            }
            ends.push_back("part-" + task_name(row.back()));
        }
    }
    steps.push_back({{"name", "report"},
                     {"dependencies", depends_on(ends)},
                     {"script", openjd_script(job, "merge.sh", "")}});
    return steps;
}

}  // namespace

void add_openjd_files(const FarmJob& job, FarmFiles& out) {
    // The format has no way to write a brace pair that is text.
    if (job.folder.string().find("{{") != std::string::npos)
        throw Error(ErrorKind::usage, "--folder " + job.folder.string() +
                                          ": Open Job Description reads {{ as the beginning of a variable; "
                                          "choose a folder without it");
    const Json steps = openjd_steps(job);
    if (steps.size() > kMostSteps)
        throw Error(
            ErrorKind::usage,
            fmt::format("--history exact: a template of Open Job Description holds {} steps, and {} tasks "
                        "in a row need {}; write --tasks {}",
                        kMostSteps, job.tasks(), steps.size(), kMostSteps - 1));
    const Json job_template = {
        {"specificationVersion", "jobtemplate-2023-09"}, {"name", job.name}, {"steps", steps}};
    out.files.push_back({"job.json", job_template.dump(2) + "\n"});
    out.submit = {"openjd", "run", (job.folder / "job.json").string()};
    if (job.history == FarmHistory::exact || job.tasks() > 0) out.submit.push_back("--run-dependencies");
    if (job.retries > 0)
        out.remarks.push_back("Open Job Description leaves retries to the service that runs the job");
}

}  // namespace aftershade
