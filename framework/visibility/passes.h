// The compute passes of this folder on frame graphs: their programs, the time that they take, and what goes
// into and out of buffers.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "framework/gpu/context.h"
#include "framework/gpu/program.h"
#include "framework/graph/executor.h"
#include "framework/graph/frame_graph.h"

namespace aftershade::visibility {

/// [the context's thread]
class Passes {
public:
    /// `context` must outlive this.
    explicit Passes(gpu::Context& context) : context_(context) {}

    gpu::Context& context() const { return context_; }
    /// A pass of this shader, whose text must outlive this, without buffers yet. Programs are compiled once.
    graph::Pass pass(const std::string& name, std::string_view shader, int groups);
    /// Runs these passes and adds their time to milliseconds().
    void run(graph::Executor& executor, graph::PassRange range = {});
    /// By pass, of all runs.
    const std::map<std::string, double>& milliseconds() const { return milliseconds_; }

private:
    gpu::Context& context_;
    std::map<std::string_view, std::shared_ptr<const gpu::Program>> programs_;  // by their texts
    std::map<std::string, double> milliseconds_;
};

/// Adds a pass whose shader calls check_loops() of loops.glsl. The last of what it writes is for
/// check_loops().
graph::Written add_with_loops(graph::FrameGraph& graph, graph::Pass pass);
/// After the pass has run. Throws Error(ErrorKind::effect), which begins with `what`, if GL ended its loops
/// early.
void check_loops(graph::Executor& executor, graph::BufferHandle unfinished, const std::string& what);

/// A graph on which a buffer keeps what it has from one run to the next.
inline graph::Executor executor_of(Passes& passes, graph::FrameGraph graph) {
    return {passes.context(), std::move(graph), false};
}

template <class T>
std::vector<std::byte> bytes_of(const T& values) {
    const auto bytes = std::as_bytes(std::span(&values, 1));
    return {bytes.begin(), bytes.end()};
}

/// Room for the values, and for one where there are none.
template <class T>
graph::BufferDesc room_for(const std::vector<T>& values) {
    return {std::max(values.size(), std::size_t(1)) * sizeof(T)};
}

template <class T>
void set(graph::Executor& executor, graph::BufferHandle buffer, std::span<const T> values) {
    executor.buffer(buffer)->write(std::as_bytes(values));
}
template <class T>
void set(graph::Executor& executor, graph::BufferHandle buffer, const std::vector<T>& values) {
    set(executor, buffer, std::span(values));
}

template <class T>
std::vector<T> values_of(graph::Executor& executor, graph::BufferHandle buffer) {
    const std::vector<std::byte> bytes = executor.buffer(buffer)->read();
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

}  // namespace aftershade::visibility
