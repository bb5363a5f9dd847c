// One call of prepare as the plug-in sees it: internal to framework/effect.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "framework/effect/native/native_types.h"
#include "framework/plugin/aftershade_plugin.h"

namespace aftershade {

/// Faults of one call, in the plug-in's order; "and 5 more" beyond a limit.
class NativeFaults {
public:
    /// Returns `status`, so that a callback can end with it.
    aftershade_status add(aftershade_status status, std::string text);
    bool empty() const { return texts_.empty(); }
    /// "a; b; and 5 more".
    std::string text() const;

private:
    std::vector<std::string> texts_;
    int dropped_ = 0;
};

/// The structs that prepare receives, filled from a NativeFrame that outlives them. Never moved.
class NativeInput {
public:
    NativeInput(const NativeFrame& frame, NativeFaults& faults);
    NativeInput(const NativeInput&) = delete;
    NativeInput& operator=(const NativeInput&) = delete;
    const aftershade_frame* get() const { return &c_frame_; }

private:
    friend struct ParamGetters;
    void fill_camera();
    void fill_images();
    void fill_frame();

    const NativeFrame& frame_;
    NativeFaults& faults_;
    aftershade_params params_{};
    aftershade_camera camera_{};
    aftershade_metadata metadata_{};
    std::vector<aftershade_image> images_;
    std::vector<const aftershade_image*> image_pointers_;
    aftershade_frame c_frame_{};
};

/// Takes what prepare computes. Never moved.
class NativeOutput {
public:
    NativeOutput(const NativeDeclaration& declaration, NativeFaults& faults);
    NativeOutput(const NativeOutput&) = delete;
    NativeOutput& operator=(const NativeOutput&) = delete;
    const aftershade_output* get() const { return &output_; }
    /// Adds a fault for each declared value that was not set.
    void require_everything();
    NativeResult take() { return std::move(result_); }

private:
    friend struct OutputSetters;

    const NativeDeclaration& declaration_;
    NativeFaults& faults_;
    aftershade_output output_{};
    NativeResult result_;
};

}  // namespace aftershade
