// The words of `aftershade submit`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "framework/base/diagnostics.h"

namespace CLI {
class App;
}  // namespace CLI

namespace aftershade::cli {

struct SubmitArguments {
    std::string farm;
    std::string look, capture;
    std::vector<std::string> outputs;
    std::vector<std::string> run_options;  ///< behind "--"
    int tasks = 0;                         ///< 0: by frames_per_task
    int frames_per_task = 0;               ///< 0: by the look
    std::string history = "auto";
    std::string folder = "aftershade-job";
    std::string name;     ///< "" for one after the look
    std::string program;  ///< "" for this one, or the image's
    int cpus = 1;
    std::uint64_t memory_bytes = 0;
    int minutes = 0;
    int retries = 2;
    std::string image, volume_claim, mount;
};

void add_submit_options(CLI::App& app, SubmitArguments& arguments);

/// The command line of `aftershade run` that the tasks divide among themselves, behind the program's name.
/// Looks, captures and outputs are absolute.
std::vector<std::string> run_words(const SubmitArguments& arguments);

/// Absolute and normal, without a slash at its end. "" is this folder.
std::string absolute_path(const std::string& path);

/// Options that tasks have of their own, and those of one farm without that farm.
void check_submit_options(const SubmitArguments& arguments, Diagnostics& diagnostics);

}  // namespace aftershade::cli
