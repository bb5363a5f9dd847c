// Farms' jobs over a small sequence with history, and what reads their files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

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
             {"--", "--effect-path", "effects", "--backend", "software", "--pixel-type", "float"})
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

    using Pictures = std::map<std::string, std::vector<float>>;

    /// The pixels of out/f_####.exr by name.
    Pictures outputs() const {
        Pictures pictures;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "out"))
            if (const std::string name = entry.path().filename().string(); name.ends_with(".exr")) {
                const Image image = color("out/" + name);
                pictures[name].assign(image.floats().begin(), image.floats().end());
            }
        return pictures;
    }
    /// Those of one run over these frames; the files are removed.
    Pictures uncut(const std::string& frames = "1-12") const {
        run({"trail.json", "in_####.exr", "-o", "out/f_####.exr", "--frames", frames}, 0);
        Pictures pictures = outputs();
        std::filesystem::remove_all(folder_ / "out");
        return pictures;
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
