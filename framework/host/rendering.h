// One renderer of a look, with its history and its memory on the GPU: a look's own, or a session's.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "aftershade/look.h"
#include "framework/host/host_data.h"
#include "framework/host/image_data.h"
#include "framework/host/look_data.h"
#include "framework/render/renderer.h"

namespace aftershade::host {

struct Result::Data {
    std::shared_ptr<const FrameResult> frame;
    std::shared_ptr<const aftershade::Capture> capture;  // of a texture's role the image is empty
    std::vector<std::string> roles;                      // of `frame`, or of the capture
    std::vector<NonFiniteInfo> non_finite;
    std::shared_ptr<const std::vector<std::filesystem::path>> documents;  // of the look
    std::string renderer;                                                 // GL's
    std::uint64_t gpu_bytes = 0;
    bool is_timed = false;
    bool is_pending = false;
    void* fence = nullptr;
};

/// One frame to be rendered, or one capture of it.
struct FrameTask {
    std::shared_ptr<const Capture::Data> capture, previous, next;
    bool begins_shot = false;
    int subframe = 0;
    int subframe_count = 1;
    std::shared_ptr<const Capture::Data> centre;
};

/// [the host's thread; may be destroyed on any]
class Rendering {
public:
    Rendering(std::shared_ptr<Host::Data> host, std::shared_ptr<const LookCore> look);
    ~Rendering();
    Rendering(const Rendering&) = delete;
    Rendering& operator=(const Rendering&) = delete;

    const LookCore& look() const { return *look_; }
    Host::Data& host() { return *host_; }
    /// Made with the first call; follows the look's changes.
    PipelineRenderer& renderer();
    /// Throws as Look::render.
    Result::Data render(const FrameTask& task, const RenderOptions& options);

    /// Roles that a render of this look with these options needs. Throws Error(usage), Error(capture) for
    /// those that are none or that nothing makes.
    std::vector<std::string> asked_roles(const RenderOptions& options,
                                         const std::vector<std::string>& captured) const;
    /// The steps after any frame: statistics, targets, fence.
    void finish(const RenderOptions& options, const std::vector<std::string>& roles, Result::Data& result);
    /// Sets the renderer up for these options. Throws Error(usage) for what is out of range.
    void prepare(const RenderOptions& options);

    /// Frees what lies on the GPU; the host is being closed, or history is to be forgotten.
    void drop() { renderer_.reset(); }

private:
    void check_targets(const RenderOptions& options, const aftershade::Window& window);

    std::shared_ptr<Host::Data> host_;
    std::shared_ptr<const LookCore> look_;
    std::shared_ptr<PipelineRenderer> renderer_;
    int form_ = 0;  // of the look, that the renderer has seen
};

}  // namespace aftershade::host
