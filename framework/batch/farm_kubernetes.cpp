#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "framework/base/error.h"
#include "framework/base/text.h"
#include "framework/batch/farm_files.h"

namespace aftershade {

namespace {

// https://kubernetes.io/docs/reference/kubernetes-api/workload-resources/job-v1/
using Json = nlohmann::ordered_json;

constexpr const char* kContainer = "aftershade";

Json kubernetes_pod(const FarmJob& job, const std::string& command, bool renders) {
    Json container = {
        {"name", kContainer},
        {"image", job.image},
        {"command", Json::array({"sh", "-c", command})},
        {"volumeMounts", Json::array({{{"name", "files"}, {"mountPath", job.mount.string()}}})}};
    if (renders) {
        Json resources = {{"cpu", std::to_string(job.cpus)}};
        if (job.memory_bytes > 0) resources["memory"] = std::to_string(farm_mebibytes(job)) + "Mi";
        container["resources"] = {{"requests", resources}, {"limits", resources}};
    }
    Json spec = {
        {"restartPolicy", "Never"},
        {"containers", Json::array({container})},
        {"volumes",
         Json::array({{{"name", "files"}, {"persistentVolumeClaim", {{"claimName", job.volume_claim}}}}})}};
    if (renders && job.minutes > 0) spec["activeDeadlineSeconds"] = job.minutes * 60;
    return {{"spec", spec}};
}

Json kubernetes_job(const std::string& name, const Json& spec) {
    return {{"apiVersion", "batch/v1"}, {"kind", "Job"}, {"metadata", {{"name", name}}}, {"spec", spec}};
}

/// Index I is task I + 1; with exact history it is a row of tasks, for Kubernetes orders no indexes.
std::string kubernetes_command(const FarmJob& job) {
    if (job.history != FarmHistory::exact)
        return "exec " + shell_line(farm_script(job, "task.sh")) + " $((JOB_COMPLETION_INDEX + 1))";
    std::string command = "case $JOB_COMPLETION_INDEX in\n";
    for (std::size_t row = 0; row < job.rows.size(); ++row) {
        command += std::to_string(row) + ") set --";
        for (const int task : job.rows[row]) command += " " + std::to_string(task);
        command += " ;;\n";
    }
    return command + "esac\nexec " + shell_line(farm_script(job, "row.sh")) + " \"$@\"";
}

Json kubernetes_tasks(const FarmJob& job) {
    // A pod that Kubernetes itself took away does not count as a failure; frames that cannot be read and
    // wrong usage (docs/exit-codes.md) would fail again.
    const Json policy = Json::array(
        {{{"action", "Ignore"},
          {"onPodConditions", Json::array({{{"type", "DisruptionTarget"}, {"status", "True"}}})}},
         {{"action", "FailIndex"},
          {"onExitCodes",
           {{"containerName", kContainer}, {"operator", "In"}, {"values", Json::array({1, 2})}}}}});
    return {{"completionMode", "Indexed"},
            {"completions", job.rows.size()},
            {"parallelism", job.rows.size()},
            {"backoffLimitPerIndex", job.retries},
            {"podFailurePolicy", {{"rules", policy}}},
            {"template", kubernetes_pod(job, kubernetes_command(job), true)}};
}

std::string kubernetes_submit_script(const FarmJob& job) {
    return fmt::format(
        "#!/bin/sh\n"
        "# Creates the job, waits for its end, and creates the one that merges the reports: Kubernetes has "
        "no\n"
        "# dependencies between jobs. Interrupt it once the job is there, if you like, and create "
        "report.json\n"
        "# later. Arguments go to kubectl: --namespace=film\n"
        "set -eu\n"
        "cd {}\n"
        "kubectl create \"$@\" -f job.json\n"
        "state() {{ kubectl get \"$@\" -o 'jsonpath={{.status.conditions[?(@.status==\"True\")].type}}' "
        "job/{}; }}\n"
        "until case $(state \"$@\") in *Complete* | *Failed) true ;; *) false ;; esac; do sleep 10; done\n"
        "kubectl create \"$@\" -f report-job.json\n",
        shell_line({job.folder.string()}), job.name);
}

}  // namespace

void add_kubernetes_files(const FarmJob& job, FarmFiles& out) {
    constexpr int kMostIndexes = 100000;  // with backoffLimitPerIndex; the API refuses more
    if (job.tasks() > kMostIndexes)
        throw Error(ErrorKind::usage,
                    fmt::format("--tasks: an Indexed Job of Kubernetes has at most {} tasks, not {}",
                                kMostIndexes, job.tasks()));
    out.files.push_back({"job.json", kubernetes_job(job.name, kubernetes_tasks(job)).dump(2) + "\n"});
    const Json report = {
        {"backoffLimit", 0},
        {"template", kubernetes_pod(job, "exec " + shell_line(farm_script(job, "merge.sh")), false)}};
    out.files.push_back({"report-job.json", kubernetes_job(job.name + "-report", report).dump(2) + "\n"});
    out.files.push_back({"submit.sh", kubernetes_submit_script(job)});
    out.submit = farm_script(job, "submit.sh");
}

}  // namespace aftershade
