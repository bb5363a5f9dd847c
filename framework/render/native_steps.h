// The native code of a pipeline's steps: prepared before each frame.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "framework/base/status.h"
#include "framework/effect/native/native_effect.h"
#include "framework/effect/native/native_library.h"
#include "framework/gpu/texture.h"
#include "framework/look/pipeline.h"

namespace aftershade {

/// Where native code comes from. `registry` nullptr: only what is linked into the program.
struct NativeSources {
    NativeRegistry* registry = nullptr;
    StatusWriter* status = nullptr;
};

/// One native effect for each step whose manifest declares some. [the context's thread]
class NativeSteps {
public:
    explicit NativeSteps(NativeSources sources) : sources_(sources) {}

    /// Calls each step's code with this frame. `params` are the steps'. Throws Error(ErrorKind::effect)
    /// naming step, library and frame.
    void prepare(const Pipeline& pipeline, const FrameInputs& frame, const std::vector<ParamSet>& params,
                 bool history_valid);
    /// Notifies every instance that history was dropped.
    void reset();

    /// nullptr for a step without native code.
    const NativeResult* result(int step) const;
    /// "blur: gain is 2", by step; what was logged since the last call.
    std::vector<std::string> take_messages();

private:
    NativeRegistry& registry();
    NativeEffect& effect(int index, const PipelineStep& step);

    NativeSources sources_;
    std::unique_ptr<NativeRegistry> linked_;
    std::map<int, NativeEffect> effects_;  // by step
    std::map<int, NativeResult> results_;
    std::vector<std::string> messages_;
};

/// The texture that holds a table of width x height elements.
gpu::TextureDesc table_desc(NativeElement element, int width, int height);
void upload_table(const NativeTable& table, gpu::Texture& texture);
/// The step's uniforms as its block takes them.
std::map<std::string, std::vector<double>> native_values(const NativeResult& result);

}  // namespace aftershade
