// Whether a frame continues the one before, and what a run hands over to the next one.
#include <memory>
#include <string>

#include "framework/base/error.h"
#include "framework/render/built_graph.h"
#include "framework/render/history_file.h"
#include "framework/render/renderer.h"

namespace aftershade {

std::string PipelineRenderer::history_fault(const FrameInputs& frame) const {
    const CaptureHeader& header = frame.capture->header;
    if (!last_) return "the first frame";
    if (frame.begins_shot) return "a cut";
    if (is_partial_) return "frame " + std::to_string(last_->frame) + " lacks sub-frames";
    if (!(last_->window == header.data_window)) return "another data window";
    if (last_->pixel_aspect != header.pixel_aspect) return "another pixel aspect";
    if (header.frame != last_->frame + 1)
        return "it follows frame " + std::to_string(last_->frame) + ", not " +
               std::to_string(header.frame - 1);
    return "";
}

void PipelineRenderer::save_history(const std::filesystem::path& path, const std::string& fingerprint) {
    SavedHistory saved;
    saved.fingerprint = fingerprint;
    saved.look = history_identity(pipeline_);
    if (last_) {
        saved.frame = last_->frame;
        saved.window = last_->window;
        saved.camera = last_->camera;
    }
    if (built_) saved.take_from(built_->executor->history());
    write_history(path, saved);
}

void PipelineRenderer::load_history(const std::filesystem::path& path) {
    saved_ = std::make_unique<SavedHistory>(read_history(path));
    const std::string identity = history_identity(pipeline_);
    if (saved_->look == identity) return;
    throw Error(ErrorKind::usage, path.string() + ": this history is of another look or effect version\n" +
                                      difference_of_identities(saved_->look, identity));
}

void PipelineRenderer::drop_loaded_history() {
    saved_.reset();
}

void PipelineRenderer::begin_from_saved(const FrameInputs& frame) {
    const CaptureHeader& header = frame.capture->header;
    const std::string file = saved_->path.string();
    if (header.frame != saved_->frame + 1)
        throw Error(ErrorKind::usage, file + ": this history is of frame " + std::to_string(saved_->frame) +
                                          "; it continues with frame " + std::to_string(saved_->frame + 1) +
                                          ", not with " + std::to_string(header.frame));
    if (!(header.data_window == saved_->window))
        throw Error(ErrorKind::usage, file + ": this history is of another size: its window is " +
                                          window_text(saved_->window) + ", that of frame " +
                                          std::to_string(header.frame) + " is " +
                                          window_text(header.data_window));
    last_ = {saved_->frame, saved_->window, saved_->camera, header.pixel_aspect};
    camera_before_ = saved_->camera;
}

void PipelineRenderer::restore(const SavedHistory& saved) {
    const std::string missing = saved.give_to(built_->executor->history());
    if (!missing.empty())
        throw Error(ErrorKind::usage, saved.path.string() + ": this history has no '" + missing +
                                          "' of the size that this frame needs");
}

}  // namespace aftershade
