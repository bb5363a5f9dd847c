// Options of a renderer that are independent of the look.
#pragma once

namespace aftershade {

/// Which of a GPU's ways draws: data-centre cards draw fragments with a few of their multiprocessors, and
/// compute with all. The picture has the same bits.
enum class DrawWith { automatic, fragment, compute };

struct RendererOptions {
    bool keeps_steps = false;   ///< each texture has memory of its own, so that it lives until the next frame
    bool fuses_passes = true;   ///< passes that can run as one do, unless each is wanted by itself
    bool plain = false;         ///< nothing that is done for software GL alone: fetches stay fetches
                                ///< and programs are made one by one; the picture has the same bits
    bool audits = false;        ///< every input, and every float texture after its pass, is read back and
                                ///< searched for NaN and infinities; slow; guards loops, too
    bool guards_loops = false;  ///< a loop that llvmpipe ended before its time, without which the picture is
                                ///< wrong, is an error of its pass; other renderers end none
    bool telemetry = false;     ///< textures of the effects' telemetry share no memory and are read back
    int compile_threads = 0;    ///< beside the one that draws, where a driver compiles on the processor
    DrawWith draw_with = DrawWith::automatic;

    bool wants_each_pass() const { return keeps_steps || audits; }
};

}  // namespace aftershade
