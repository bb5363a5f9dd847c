// The process that draws for the page: the only one of `serve` that touches GL.
#pragma once

namespace aftershade::serve {

struct ServeOptions;

/// Draws what comes over `socket` until its other end is closed. A context that cannot be made is an answer,
/// too: see DrawingProcess.
void draw_for(const ServeOptions& options, int socket);

}  // namespace aftershade::serve
