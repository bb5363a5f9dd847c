// Farms' jobs over a small sequence with history, and what reads their files.
#pragma once

#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/cli/batch_work.h"

namespace aftershade::test {

class FarmWork : public BatchWork {
protected:
    FarmWork() { write_frames(1, 12); }

    /// Exit 0: the folder `job` has the files.
    CommandResult submit(const std::string& farm, std::vector<std::string> more = {}, int exit_code = 0,
                         const std::vector<std::string>& run_options = {}) const {
        std::vector<std::string> arguments{
            "submit", "--to", farm, "trail.json", "in_####.exr", "-o", "out/f_####.exr", "--folder", "job"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        for (const char* word :
             {"--", "--effect-path", "effects", "--backend", "osmesa", "--pixel-type", "float"})
            arguments.push_back(word);
        arguments.insert(arguments.end(), run_options.begin(), run_options.end());
        CommandResult result = run_aftershade(arguments, folder_.path());
        EXPECT_EQ(result.exit_code, exit_code) << result.err;
        return result;
    }
    /// What a shell line gives, in the test's folder.
    CommandResult shell(const std::string& line, const Environment& environment = {}) const {
        return Command({"/bin/sh", "-c", line}, folder_.path(), environment).wait();
    }
    bool has(const std::string& program) const { return shell("command -v " + program).exit_code == 0; }
    std::string job_file(const std::string& name) const { return read_text(folder_ / ("job/" + name)); }
    nlohmann::json job_json(const std::string& name) const { return nlohmann::json::parse(job_file(name)); }
    std::string absolute(const std::string& name) const { return (folder_ / name).string(); }

    /// Bytes of out/f_####.exr by name, but for the time of writing, which they do not hold.
    std::map<std::string, std::string> outputs() const { return contents(folder_ / "out"); }
    /// Those of one run over all frames; the files are removed. The path of the look is one of their
    /// attributes.
    std::map<std::string, std::string> uncut() const {
        run({absolute("trail.json"), "in_####.exr", "-o", "out/f_####.exr"}, 0);
        auto files = outputs();
        std::filesystem::remove_all(folder_ / "out");
        return files;
    }
    /// Every shell script of the job, as bash and sh read it.
    void expect_readable_scripts() const {
        for (const auto& [name, bytes] : contents(folder_ / "job"))
            if (name.ends_with(".sh") || name.ends_with(".sbatch"))
                for (const char* shell_name : {"bash", "sh"}) {
                    const CommandResult read = shell(std::string(shell_name) + " -n 'job/" + name + "'");
                    EXPECT_EQ(read.exit_code, 0) << name << ": " << read.err;
                }
    }
};

}  // namespace aftershade::test
