#include "framework/visibility/passes.h"

namespace aftershade::visibility {

graph::Pass Passes::pass(const std::string& name, std::string_view shader, int groups) {
    std::shared_ptr<const gpu::Program>& program = programs_[name];
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

}  // namespace aftershade::visibility
