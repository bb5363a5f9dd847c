#include "framework/batch/worker.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <thread>

#include "framework/base/error.h"

namespace aftershade {
namespace {

using namespace std::chrono_literals;
const std::string kCases = AFTERSHADE_CASES;

WorkerCommand worker(std::vector<std::string> arguments) {
    WorkerCommand command;
    command.arguments = {AFTERSHADE_PLUGIN_WORKER};
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    return command;
}

/// All children are waited for: none is left as a zombie.
void expect_no_children() {
    EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
    EXPECT_EQ(errno, ECHILD);
}

TEST(Worker, NamesThePluginThatCrashed) {
    const WorkerResult result = run_worker(worker({kCases, "crashes"}));
    EXPECT_EQ(describe(result),
              "plug-in " + kCases +
                  "/crashes.so crashed (signal 11, SIGSEGV) in prepare of step 'grade', frame 12");
    expect_no_children();
}

TEST(Worker, NamesThePluginThatHangs) {
    WorkerCommand command = worker({kCases, "hangs"});
    command.limits.wall_time = 500ms;
    const WorkerResult result = run_worker(command);
    EXPECT_EQ(describe(result), "plug-in " + kCases +
                                    "/hangs.so did not finish within 0.5 s and was killed in "
                                    "prepare of step 'grade', frame 12");
    EXPECT_LT(result.seconds, 10);
    expect_no_children();
}

TEST(Worker, NamesThePluginThatEndsTheProcess) {
    EXPECT_EQ(
        describe(run_worker(worker({kCases, "exits"}))),
        "plug-in " + kCases + "/exits.so ended the process with code 3 in prepare of step 'grade', frame 12");
}

TEST(Worker, AnExceptionOfAPluginIsTheHostsErrorAndNoCrash) {
    std::string errors;
    WorkerListener listener;
    listener.on_stderr = [&](std::string_view line) { errors += line; };
    const WorkerResult result = run_worker(worker({kCases, "throws"}), listener);
    EXPECT_EQ(describe(result), "the worker ended with code 5");
    EXPECT_NE(errors.find("no luck today"), std::string::npos) << errors;
}

TEST(Worker, APluginThatWorksLeavesNoTrace) {
    std::vector<WorkStatus> statuses;
    WorkerListener listener;
    listener.on_status = [&](const WorkStatus& status) { statuses.push_back(status); };
    const WorkerResult result = run_worker(worker({kCases, "older"}), listener);
    EXPECT_TRUE(result.succeeded()) << describe(result);
    EXPECT_EQ(result.status, WorkStatus{});
    const WorkStatus prepare{"grade", kCases + "/older.so", "prepare", 12};
    EXPECT_NE(std::find(statuses.begin(), statuses.end(), prepare), statuses.end());
}

TEST(Worker, DeliversLinesOfBothStreams) {
    std::vector<std::string> out, error;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { out.emplace_back(line); };
    listener.on_stderr = [&](std::string_view line) { error.emplace_back(line); };
    EXPECT_EQ(run_worker(worker({"--talk"}), listener).exit_code, 7);
    EXPECT_EQ(out, (std::vector<std::string>{"one", "", "no line end"}));
    EXPECT_EQ(error, std::vector<std::string>{"to stderr"});
}

TEST(Worker, ReadsTheDescriptorThatIsItsInput) {
    std::vector<std::string> out;
    WorkerListener listener;
    listener.on_stdout = [&](std::string_view line) { out.emplace_back(line); };
    WorkerCommand command;
    command.arguments = {"/bin/cat"};
    EXPECT_TRUE(run_worker(command, listener).succeeded());
    EXPECT_TRUE(out.empty()) << "without a descriptor its input is empty";
    Pipe input = make_pipe();
    ASSERT_EQ(write(input.write.get(), "one\ntwo", 7), 7);
    input.write.reset();
    command.input = input.read.get();
    EXPECT_TRUE(run_worker(command, listener).succeeded());
    EXPECT_EQ(out, (std::vector<std::string>{"one", "two"}));
    expect_no_children();
}

TEST(Worker, EndsWhatUsesUpItsProcessorTime) {
    WorkerCommand command = worker({"--spin"});
    command.limits.cpu_seconds = 1;
    EXPECT_EQ(describe(run_worker(command)),
              "the worker used up its 1 s of processor time (signal 24, SIGXCPU)");
}

TEST(Worker, LimitsMemory) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
    GTEST_SKIP() << "a sanitizer reserves more address space than any limit";
#endif
    WorkerCommand command = worker({"--allocate"});
    command.limits.memory_bytes = std::uint64_t(1) << 30;
    EXPECT_EQ(describe(run_worker(command)), "the worker ended with code 5");
}

TEST(Worker, LimitsTheMemoryThatIsReallyUsed) {
    WorkerCommand command = worker({"--allocate"});
    command.limits.resident_bytes = std::uint64_t(256) << 20;
    const WorkerResult result = run_worker(command);
    EXPECT_EQ(result.end, WorkerEnd::out_of_memory);
    EXPECT_EQ(describe(result), "the worker took more memory than its limit of 256 MiB and was killed");
}

TEST(Worker, HasEndedInOrderOnlyWithItsLastWord) {
    WorkerCommand command;
    const auto ends = [&](const std::string& script) {
        command.arguments = {"/bin/sh", "-c", script};
        return run_worker(command).ended_in_order();
    };
    const std::string say = "echo '{\"event\":\"end\",\"code\":3}' >&$AFTERSHADE_STATUS_FD; ";
    EXPECT_TRUE(ends(say + "exit 3"));
    EXPECT_FALSE(ends("exit 3")) << "it said nothing";
    EXPECT_FALSE(ends(say + "exit 0")) << "it said something else";
    EXPECT_FALSE(ends(say + "kill -KILL $$"));
}

TEST(Worker, DoesNotWaitForWhatTheWorkerLeftBehind) {
    const WorkerResult result = run_worker(worker({"--orphan"}));
    EXPECT_TRUE(result.succeeded()) << describe(result);
    EXPECT_LT(result.seconds, 10) << "the child of the child sleeps for 60 s with our pipes open";
}

TEST(Worker, EndsWhenThisProcessIsInterrupted) {
    std::atomic<bool> interrupt{false};
    std::jthread later([&] {
        std::this_thread::sleep_for(200ms);
        interrupt = true;
    });
    const WorkerResult result = run_worker(worker({"--sleep"}), {}, &interrupt);
    EXPECT_EQ(result.end, WorkerEnd::interrupted);
    EXPECT_LT(result.seconds, 10);
    expect_no_children();
}

TEST(Worker, AProgramThatIsNotThereIsNamed) {
    WorkerCommand command;
    command.arguments = {"/no/such/program"};
    try {
        run_worker(command);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_STREQ(error.what(), "/no/such/program: cannot be run as a worker: No such file or directory");
    }
    expect_no_children();
}

TEST(Status, NamesThePassThatIsCompiledOrDrawn) {
    WorkStatus status{"grade", "", "compile", 12, "tint", "main", true};
    EXPECT_EQ(parse_status(status_line(status)), status);
    EXPECT_EQ(place_text(status), " while compiling pass 'main' of step 'grade' (effect 'tint'), frame 12");
    status.phase = "draw";
    EXPECT_EQ(place_text(status), " while drawing pass 'main' of step 'grade' (effect 'tint'), frame 12");
    EXPECT_EQ(parse_last_word(last_word_line(5)), 5);
    EXPECT_EQ(parse_last_word(status_line(status)), std::nullopt);
    EXPECT_EQ(parse_last_word("{\"event\":\"end\",\"code\":\"5\"}"), std::nullopt);
}

TEST(Status, HasWhichObjectsOfALookFramesHad) {
    const ObjectSighting sighting{70000, true, 0.0625};
    EXPECT_EQ(parse_sighting(sighting_line(sighting)), sighting);
    EXPECT_EQ(parse_status(sighting_line(sighting)), WorkStatus{})
        << "an older program reads nothing from it";
    EXPECT_EQ(parse_event(sighting_line(sighting)), std::nullopt);
    EXPECT_EQ(parse_sighting(last_word_line(5)), std::nullopt);
    EXPECT_EQ(parse_sighting(R"({"event":"object","index":"3","found":true})"), std::nullopt);
    EXPECT_EQ(parse_sighting(R"({"event":"object","index":3,"found":1})"), std::nullopt);
}

TEST(Status, HasWhatAProcessDrawsWith) {
    const DrawnBy gl{"egl: NVIDIA H100, 4.6.0", "/dev/dri/card0", "egl: \"x\"\n"};
    EXPECT_EQ(parse_drawn_by(drawn_by_line(gl)), gl);
    EXPECT_EQ(parse_status(drawn_by_line(gl)), WorkStatus{}) << "an older program reads nothing from it";
    EXPECT_EQ(parse_drawn_by(last_word_line(5)), std::nullopt);
    const DrawnBy longer{"r", "d", std::string(9000, '\1')};  // six bytes each in JSON
    EXPECT_LE(drawn_by_line(longer).size(), std::size_t(PIPE_BUF));
    const std::string kept = parse_drawn_by(drawn_by_line(longer))->hardware_fault;
    EXPECT_GT(kept.size(), 400U);
    EXPECT_EQ(kept, longer.hardware_fault.substr(0, kept.size()));
}

TEST(Status, AnyTextComesBackAndALineFitsOneWrite) {
    const WorkStatus status{"a \"step\"\n", "/x/libfoo.so", "prepare", -3};
    EXPECT_EQ(parse_status(status_line(status)), status);
    EXPECT_EQ(status_line({"grade", "/x/libfoo.so", "prepare", 12}),
              "{\"step\":\"grade\",\"plugin\":\"/x/libfoo.so\",\"phase\":\"prepare\",\"frame\":12}\n");
    const std::string longest(5000, '\x01');
    EXPECT_LE(status_line({longest, longest, longest, 1, longest, longest, true}).size(), 4096U);
    for (const char* line : {"", "[]", "{\"step\":1}", "{\"frame\":\"x\"}", "{\"step\":\"a\""})
        EXPECT_EQ(parse_status(line), std::nullopt) << line;
}

}  // namespace
}  // namespace aftershade
