// Images and tables that parameters and masks read from files.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "framework/effect/param_reader.h"
#include "framework/effect/param_resources.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// Files that a pipeline's steps name, each read once. [one thread at a time]
class StepFiles {
public:
    /// The content of a step's file parameters. Throws Error(ErrorKind::usage) with every fault of the files.
    const std::map<std::string, ParamFile>& of_step(int index, const PipelineStep& step,
                                                    const ParamReader& params);
    /// The content of a file parameter as of_step() has last given it; null where it has given none.
    const ParamFile* loaded(int index, const std::string& param) const;
    /// The mask of a step: one channel, r32f. Throws Error(ErrorKind::usage).
    const Image& mask_of(const std::filesystem::path& path);

private:
    struct Loaded {
        std::map<std::string, ParamValue> values;  ///< that the files depend on
        std::map<std::string, ParamFile> files;
    };
    std::map<int, Loaded> steps_;
    std::map<std::filesystem::path, Image> masks_;
};

}  // namespace aftershade
