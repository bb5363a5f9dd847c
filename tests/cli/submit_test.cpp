// The jobs that `submit` writes, read and run by what reads and runs them; scripts/check farms has a real
// Slurm.
#include <filesystem>

#include "tests/cli/farm_work.h"

namespace aftershade::test {
namespace {

namespace fs = std::filesystem;

class Submit : public FarmWork {
protected:
    /// A Slurm that starts each task at once, in the order of submission, and notes its command lines.
    Environment slurm_here() const {
        fs::create_directories(folder_ / "bin");
        write_text(folder_ / "bin/sbatch", R"(#!/bin/sh
echo "$*" >>"$SBATCH_NOTES"
number=$(wc -l <"$SBATCH_NOTES")
array=$(sed -n 's/^#SBATCH --array=//p' "job.sbatch")
for word; do
    script=$word
    case $word in --array=*) array=${word#--array=} ;; esac
done
case $script in merge*) array=1 ;; esac
case $array in *-*) array=$(seq "${array%-*}" "${array#*-}") ;; esac
for task in $array; do SLURM_ARRAY_TASK_ID=$task SLURM_JOB_ID=$number sh "$script" >/dev/null 2>>errors; done
echo "$number;here"
)");
        write_text(folder_ / "bin/scontrol", "#!/bin/sh\necho \"$*\" >>\"$SBATCH_NOTES\"\n");
        for (const char* name : {"bin/sbatch", "bin/scontrol"})
            fs::permissions(folder_ / name, fs::perms::owner_all);
        return {{"PATH", absolute("bin") + ":" + std::getenv("PATH")}, {"SBATCH_NOTES", absolute("notes")}};
    }
};

TEST_F(Submit, WritesNothingWhereTheRunOrTheJobHasFaultsAndListsThemAll) {
    const CommandResult run_faults = submit("slurm", {}, 2, {"--frames", "1-x", "--set", "trail.size=2"});
    for (const char* fault : {"--frames 1-x", "trail.size"})
        EXPECT_NE(run_faults.err.find(fault), std::string::npos) << run_faults.err;
    const CommandResult job_faults = submit("kubernetes", {"--mount", "/elsewhere"}, 2, {"--chunk", "1/2"});
    for (const char* fault :
         {"needs --image", "needs --volume-claim", "does not lie below /elsewhere", "-- --chunk"})
        EXPECT_NE(job_faults.err.find(fault), std::string::npos) << job_faults.err;
    const CommandResult no_warmup = submit("slurm", {"--history", "warmup"}, 2);
    EXPECT_NE(no_warmup.err.find("declares no warm-up"), std::string::npos) << no_warmup.err;
    EXPECT_FALSE(fs::exists(folder_ / "job"));
}

TEST_F(Submit, RefusesNamesThatTheFarmsJsonCannotHold) {
    const CommandResult result = run_aftershade(
        {"submit", "--to", "openjd", "nothing.json", "in_####.exr", "-o", "f_####.exr", "--folder", "\xff"},
        folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find("not UTF-8"), std::string::npos) << result.err;
    EXPECT_FALSE(fs::exists(folder_ / "\xff"));
}

TEST_F(Submit, RefusesAFolderThatHoldsAnotherJob) {
    submit("parallel", {"--history", "exact"});
    const CommandResult again = submit("parallel", {"--history", "exact"}, 2);
    EXPECT_NE(again.err.find("--folder job: error: is not empty"), std::string::npos) << again.err;
}

TEST_F(Submit, DividesIntoTasksOfTenFramesAndOfFourTimesTheWarmupUnlessToldOtherwise) {
    write_frames(13, 40);
    const auto tasks = [&](const std::vector<std::string>& more,
                           const std::vector<std::string>& run_options) {
        fs::remove_all(folder_ / "job");
        return submit("slurm", more, 0, run_options).err;
    };
    EXPECT_NE(tasks({}, {"--warmup", "2"}).find("40 frames in 4 tasks of about 10 "), std::string::npos);
    EXPECT_NE(tasks({}, {"--warmup", "5"}).find("40 frames in 2 tasks of about 20 "), std::string::npos);
    EXPECT_NE(tasks({"--tasks", "7"}, {"--warmup", "5"}).find("in 7 tasks of about 6;"), std::string::npos);
    EXPECT_NE(tasks({"--frames-per-task", "16"}, {"--warmup", "5"}).find("in 3 tasks"), std::string::npos);
}

TEST_F(Submit, TasksKeepTheirFramesAndPathsWhateverTheyMeetLater) {
    submit("parallel", {"--history", "exact", "--tasks", "2"});
    write_frames(13, 14);
    const auto expected = uncut();
    EXPECT_EQ(shell("cd / && sh '" + absolute("job/row.sh") + "' 1 2").exit_code, 0);
    EXPECT_EQ(outputs(), expected);
}

TEST_F(Submit, PathsWithBlanksQuotesAndDollarsReachTheTasksUnharmed) {
    const std::string name = "a 'b' $c";
    fs::copy_file(folder_ / "trail.json", folder_ / (name + ".json"));
    const CommandResult result =
        run_aftershade({"submit", "--to", "parallel", name + ".json", "in_####.exr", "-o",
                        name + "/f_####.exr", "--folder", "job " + name, "--history", "exact", "--tasks", "1",
                        "--", "--effect-path", "effects", "--backend", "software"},
                       folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_NE(read_text(folder_ / ("job " + name + "/task.sh")).find("aftershade"), std::string::npos);
    EXPECT_EQ(Command({"/bin/sh", absolute("job " + name + "/task.sh"), "1"}, "/").wait().exit_code, 0);
    EXPECT_TRUE(fs::exists(folder_ / name / "f_0012.exr"));
}

TEST_F(Submit, ARowThatIsTriedAgainGoesOnBehindItsLastCompleteTask) {
    const auto whole = uncut();
    submit("parallel", {"--history", "exact", "--tasks", "4"});
    ASSERT_EQ(shell("sh job/task.sh 1 && sh job/task.sh 2").exit_code, 0);
    const auto first = fs::last_write_time(folder_ / "out/f_0001.exr");
    EXPECT_EQ(shell("sh job/row.sh 1 2 3 4").exit_code, 0);
    EXPECT_EQ(fs::last_write_time(folder_ / "out/f_0001.exr"), first);
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Submit, RowsOfExactHistoryBeginAtCutsAndAtGapsInTheFrames) {
    write_text(folder_ / "cut.json",
               R"({ "aftershade": 1, "frames": "in_####.exr", "range": "1-3,5-12", "cuts": [9] })");
    const CommandResult result = run_aftershade(
        {"submit", "--to", "parallel", "trail.json", "cut.json", "-o", "out/f_####.exr", "--folder", "job",
         "--history", "exact", "--tasks", "11", "--", "--effect-path", "effects"},
        folder_.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string row = "sh " + absolute("job/row.sh");
    EXPECT_EQ(job_file("commands.txt"), row + " 1 2 3\n" + row + " 4 5 6 7\n" + row + " 8 9 10 11\n");
}

TEST_F(Submit, SlurmsTasksFormAnArrayAndTheReportWaitsForIt) {
    const auto whole = uncut();
    const CommandResult result = submit(
        "slurm", {"--tasks", "4", "--cpus", "2", "--memory", "4GB", "--time", "90"}, 0, {"--warmup", "12"});
    EXPECT_EQ(result.out, "sh " + absolute("job/submit.sh") + "\n");
    expect_readable_scripts();
    const CommandResult ran = shell("sh job/submit.sh --partition=night", slurm_here());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(ran.out, "tasks: 1; report: job 2\n");
    EXPECT_EQ(read_text(folder_ / "notes"),
              "--parsable --partition=night job.sbatch\n"
              "--parsable --dependency=afterany:1 --partition=night merge.sbatch\n");
    for (const char* line : {"--array=1-4", "--cpus-per-task=2", "--mem=4096M", "--time=90", "--requeue"})
        EXPECT_NE(job_file("job.sbatch").find("\n#SBATCH " + std::string(line) + "\n"), std::string::npos)
            << line;
    // A warm-up from the first frame on is exact.
    EXPECT_EQ(outputs(), whole);
    EXPECT_EQ(job_json("report.json")["done"], 12);
}

TEST_F(Submit, SlurmsTasksWithExactHistoryWaitForOneAnotherAndAreBitIdentical) {
    const auto whole = uncut();
    submit("slurm", {"--tasks", "3", "--history", "exact"});
    expect_readable_scripts();
    const CommandResult ran = shell("sh job/submit.sh", slurm_here());
    EXPECT_EQ(ran.exit_code, 0) << ran.err;
    EXPECT_EQ(read_text(folder_ / "notes"),
              "--parsable --array=1 job.sbatch\n"
              "--parsable --array=2 --dependency=afterany:1 job.sbatch\n"
              "--parsable --array=3 --dependency=afterany:2 job.sbatch\n"
              "--parsable --dependency=afterany:1:2:3 merge.sbatch\n");
    EXPECT_EQ(outputs(), whole);
}

TEST_F(Submit, SlurmTriesATaskAgainUnlessItWouldEndTheSame) {
    submit("slurm", {"--tasks", "1", "--history", "exact", "--retries", "1"});
    const Environment slurm = slurm_here();
    const auto requeued = [&](int code, int restarts) {
        fs::remove(folder_ / "notes");
        write_text(folder_ / "job/task.sh", "exit " + std::to_string(code) + "\n");
        Environment environment = slurm;
        environment["SLURM_ARRAY_TASK_ID"] = "1";
        environment["SLURM_JOB_ID"] = "77";
        environment["SLURM_RESTART_COUNT"] = std::to_string(restarts);
        EXPECT_EQ(shell("sh job/job.sbatch", environment).exit_code, code);
        return fs::exists(folder_ / "notes") && read_text(folder_ / "notes") == "requeue 77\n";
    };
    for (const int code : {3, 4, 5, 6, 7, 139}) EXPECT_TRUE(requeued(code, 0)) << code;
    for (const int code : {0, 1, 2, 130}) EXPECT_FALSE(requeued(code, 0)) << code;
    EXPECT_FALSE(requeued(5, 1));
}

TEST_F(Submit, OpenJdsTemplatePassesItsCheckRunsAndReportsProgress) {
    if (!has("openjd")) GTEST_SKIP() << "no openjd (pip install openjd-cli)";
    const auto whole = uncut();
    const CommandResult result = submit("openjd", {"--tasks", "3", "--history", "exact", "--time", "5"});
    EXPECT_EQ(result.out, "openjd run " + absolute("job/job.json") + " --run-dependencies\n");
    const CommandResult checked = shell("openjd check job/job.json");
    EXPECT_EQ(checked.exit_code, 0) << checked.out << checked.err;
    const CommandResult ran = shell("openjd run job/job.json");
    EXPECT_EQ(ran.exit_code, 0) << ran.out << ran.err;
    EXPECT_NE(ran.out.find("openjd_progress: 100"), std::string::npos) << ran.out;
    EXPECT_EQ(outputs(), whole);
    EXPECT_EQ(job_json("report.json")["done"], 12);
}

TEST_F(Submit, OpenJdHoldsTheTasksInOneStepOrInAStepForEachWithExactHistory) {
    submit("openjd", {"--tasks", "3"}, 0, {"--warmup", "2"});
    nlohmann::json steps = job_json("job.json")["steps"];
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(steps[0]["parameterSpace"]["taskParameterDefinitions"][0]["range"], "1-3");
    EXPECT_EQ(steps[1]["dependencies"], nlohmann::json::parse(R"([{ "dependsOn": "frames" }])"));
    EXPECT_NE(job_file("task.sh").find("--progress openjd"), std::string::npos);
    fs::remove_all(folder_ / "job");
    submit("openjd", {"--tasks", "3", "--history", "exact"});
    steps = job_json("job.json")["steps"];
    ASSERT_EQ(steps.size(), 4u);
    for (const int i : {1, 2, 3})
        EXPECT_EQ(steps[std::size_t(i)]["dependencies"][0]["dependsOn"], "part-000" + std::to_string(i));
    fs::remove_all(folder_ / "job");
    write_frames(13, 120);
    EXPECT_NE(submit("openjd", {"--tasks", "100", "--history", "exact"}, 2).err.find("write --tasks 99"),
              std::string::npos);
}

TEST_F(Submit, KubernetesGetsAnIndexedJobThatFitsItsSchema) {
    const std::vector<std::string> options{"--image",        "film/aftershade:1",
                                           "--volume-claim", "shots",
                                           "--memory",       "4GB",
                                           "--time",         "60",
                                           "--tasks",        "3"};
    submit("kubernetes", options, 0, {"--warmup", "2"});
    expect_readable_scripts();
    const nlohmann::json spec = job_json("job.json")["spec"];
    EXPECT_EQ(spec["completionMode"], "Indexed");
    EXPECT_EQ(spec["completions"], 3);
    EXPECT_EQ(spec["backoffLimitPerIndex"], 2);
    const nlohmann::json pod = spec["template"]["spec"], container = pod["containers"][0];
    EXPECT_EQ(pod["activeDeadlineSeconds"], 3600);
    EXPECT_EQ(container["image"], "film/aftershade:1");
    EXPECT_EQ(container["volumeMounts"][0]["mountPath"], folder_.path().string());
    EXPECT_EQ(container["resources"]["limits"]["memory"], "4096Mi");
    EXPECT_NE(job_file("task.sh").find("\nexec aftershade run "), std::string::npos);
    if (!has("kubernetes-validate"))
        GTEST_SKIP() << "no kubernetes-validate (pip install kubernetes-validate)";
    const CommandResult valid = shell("kubernetes-validate --strict job/job.json job/report-job.json");
    EXPECT_EQ(valid.exit_code, 0) << valid.out << valid.err;
}

TEST_F(Submit, KubernetesIndexesAreTasksOrRowsOfThem) {
    const auto whole = uncut();
    for (const std::string history : {"warmup", "exact"}) {
        fs::remove_all(folder_ / "job");
        fs::remove_all(folder_ / "out");
        std::vector<std::string> run_options;
        if (history == "warmup") run_options = {"--warmup", "12"};
        submit("kubernetes",
               {"--image", "x", "--volume-claim", "y", "--program", AFTERSHADE_EXECUTABLE, "--tasks", "3",
                "--history", history},
               0, run_options);
        const nlohmann::json spec = job_json("job.json")["spec"];
        const std::string command = spec["template"]["spec"]["containers"][0]["command"][2];
        for (int index = 0; index < spec["completions"]; ++index) {
            const CommandResult ran = shell(command, {{"JOB_COMPLETION_INDEX", std::to_string(index)}});
            EXPECT_EQ(ran.exit_code, 0) << ran.err;
        }
        EXPECT_EQ(outputs(), whole) << history;
    }
}

TEST_F(Submit, OpenCuesScriptGivesALayerOfTasksOrAChainOfLayers) {
    submit("opencue", {"--tasks", "3", "--history", "exact", "--cpus", "2", "--memory", "4GB"});
    const CommandResult compiled = shell("python3 -m py_compile job/job.py");
    EXPECT_EQ(compiled.exit_code, 0) << compiled.err;
    // An Outline as OpenCue's own library turns it into the specification that Cuebot takes.
    if (shell("$(dirname $(command -v pycuerun))/python -c 'import outline'").exit_code != 0)
        GTEST_SKIP() << "no PyOutline (pip install opencue-pyoutline)";
    const CommandResult made = shell(
        "cd job && HOME=. $(dirname $(command -v pycuerun))/python -c "
        "'import job; print(job.launcher().serialize(use_pycuerun=False))'");
    ASSERT_EQ(made.exit_code, 0) << made.err;
    for (const std::string& text :
         {"<cmd>sh " + absolute("job/task.sh") + " 2</cmd>", std::string("<maxretries>2</maxretries>"),
          std::string("<cores>2.0</cores><memory>4096m</memory>"),
          std::string("<deplayer>part_0003</deplayer>"), std::string("<onlayer>part_0002</onlayer>"),
          std::string("<layer name=\"report\" type=\"Post\">")})
        EXPECT_NE(made.out.find(text), std::string::npos) << text << "\n" << made.out;
}

TEST_F(Submit, GnuParallelRunsTheTasksAndThenOnlyThoseThatFailed) {
    if (!has("parallel")) GTEST_SKIP() << "no GNU parallel";
    const auto whole = uncut();
    submit("parallel", {"--tasks", "3", "--retries", "0"}, 0, {"--warmup", "12"});
    expect_readable_scripts();
    // In the last task: history runs from a frame into the tasks behind it.
    const std::string held = read_text(frame_path(12));
    fs::remove(frame_path(12));
    EXPECT_EQ(shell("sh job/run.sh").exit_code, 1);
    EXPECT_EQ(job_json("report.json")["failed"], 1);
    write_text(frame_path(12), held);
    const auto first = fs::last_write_time(folder_ / "out/f_0001.exr");
    EXPECT_EQ(shell("sh job/run.sh").exit_code, 0);
    EXPECT_EQ(fs::last_write_time(folder_ / "out/f_0001.exr"), first);
    EXPECT_EQ(outputs(), whole);
}

}  // namespace
}  // namespace aftershade::test
