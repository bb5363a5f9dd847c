#include "framework/visibility/passes.h"

#include <cstdint>
#include <utility>

#include "framework/base/error.h"
#include "framework/base/option.h"

namespace aftershade::visibility {

graph::Pass Passes::pass(const std::string& name, std::string_view shader, int groups) {
    std::shared_ptr<const gpu::Program>& program = programs_[shader];
    if (!program)
        program = std::make_shared<gpu::Program>(gpu::Program::compute(context_, std::string(shader), name));
    graph::Pass pass;
    pass.name = name;
    pass.kind = graph::PassKind::compute;
    pass.program = program;
    pass.groups.count = {groups, 1, 1};
    return pass;
}

void Passes::run(graph::Executor& executor, graph::PassRange range) {
    for (const graph::PassTime& time : executor.run(true, {}, range))
        milliseconds_[time.pass] += time.milliseconds;
}

graph::Written add_with_loops(graph::FrameGraph& graph, graph::Pass pass) {
    constexpr int kBinding = 7;  // as loops.glsl has it
    const graph::BufferHandle unfinished =
        graph.create_buffer("unfinished", {sizeof(std::uint32_t)}, std::vector<std::uint32_t>{0});
    pass.buffers.push_back({unfinished, kBinding, gpu::Access::read_write});
    graph::Written written = graph.add_pass(std::move(pass));
    graph.keep(written.buffers.back());
    return written;
}

void check_loops(graph::Executor& executor, graph::BufferHandle unfinished, const std::string& what) {
    if (values_of<std::uint32_t>(executor, unfinished).front() == 0) return;
    throw Error(ErrorKind::effect,
                what + ": a ray needs more than the 65,535 loop turns that llvmpipe allows; choose " +
                    spelled(Option::visibility_on, "cpu"));
}

}  // namespace aftershade::visibility
