// Frames that never leave the GPU: textures of the caller's EGL context, read and written by looks.
//
// Contexts. HostOptions::share names the display and context that the Host's own context shares objects with.
// Both must be of desktop OpenGL, and the caller's must outlive the Host. Every call of a Host leaves current
// in its thread the EGL context, surfaces and API that it found. A context of another window system (GLX,
// WGL) is not restored: make it current again, or call from another thread.
//
// Fences. GL orders the commands of two contexts only where fences say so:
// - Input. After the commands that write the textures, the caller calls glFenceSync and glFlush and gives the
//   fence as RenderOptions::wait. The Host waits for it on the GPU and does not delete it; the caller may
//   delete it when the call has returned. Without one, those commands must have finished (glFinish).
// - Output. With RenderOptions::wants_fence, Result::fence() is a fence behind the Host's last write: the
//   caller waits for it (glWaitSync, or glClientWaitSync) before it reads a target or writes an input again,
//   and deletes it. Without, the call returns when the GPU has finished.
#pragma once

#include <cstdint>

namespace aftershade::host {

/// An EGLDisplay and an EGLContext, as EGL gives them; neither may be null.
struct SharedEgl {
    void* display = nullptr;
    void* context = nullptr;
};

/// A two-dimensional texture of the shared context, of which level 0 is used.
///
/// Formats: 1, 2 or 4 channels of 8 or 16 bits normalised, 16 or 32 bits of float; for roles of ids one
/// channel of 32 bits unsigned. A format with fewer bits than the role's float32 rounds. A texture has at
/// least as many channels as its role, but where the role has three: that needs four, and the fourth is
/// neither read nor meant. Anything else is Error(usage).
struct GlTexture {
    std::uint32_t name = 0;  ///< glGenTextures' or glCreateTextures'; not 0
    int width = 0;           ///< px; of level 0
    int height = 0;          ///< px
    /// Texel row 0 is the image's bottom row, as GL draws it; false: its top row, as Image has it.
    bool bottom_up = true;
};

}  // namespace aftershade::host
