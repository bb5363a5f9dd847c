#include "framework/gpu/timer.h"

#include <utility>

#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {
namespace {

/// A query that asks for the GPU's time now.
unsigned int stamped(Context& context) {
    std::vector<unsigned int>& free = context.impl().free_queries;
    const GladGLContext& gl = context.gl();
    unsigned int query = 0;
    if (free.empty()) {
        gl.CreateQueries(GL_TIMESTAMP, 1, &query);
        free.reserve(++context.impl().queries_made);  // so that giving it back takes no memory
    } else {
        query = free.back();
        free.pop_back();
    }
    gl.QueryCounter(query, GL_TIMESTAMP);
    return query;
}

}  // namespace

Duration::Duration(Duration&& other) noexcept
    : context_(std::exchange(other.context_, nullptr)), queries_(other.queries_), ms_(other.ms_) {}

Duration& Duration::operator=(Duration&& other) noexcept {
    std::swap(context_, other.context_);
    std::swap(queries_, other.queries_);
    std::swap(ms_, other.ms_);
    return *this;
}

void Duration::give_back() noexcept {
    if (!context_) return;
    std::vector<unsigned int>& free = std::exchange(context_, nullptr)->impl().free_queries;
    free.insert(free.end(), queries_.begin(), queries_.end());
}

double Duration::ms() {
    if (!context_) return ms_;
    context_->make_current();
    GLuint64 begin_ns = 0, end_ns = 0;
    context_->gl().GetQueryObjectui64v(queries_[1], GL_QUERY_RESULT, &end_ns);
    context_->gl().GetQueryObjectui64v(queries_[0], GL_QUERY_RESULT, &begin_ns);
    ms_ = static_cast<double>(end_ns - begin_ns) * 1e-6;
    give_back();
    return ms_;
}

Timer::~Timer() {
    if (begun_ != 0) context_.impl().free_queries.push_back(begun_);
}

void Timer::start() {
    context_.make_current();
    if (!context_.info().software) {
        if (begun_ != 0) context_.impl().free_queries.push_back(begun_);
        begun_ = stamped(context_);
        return;
    }
    context_.finish();
    start_ = std::chrono::steady_clock::now();
}

Duration Timer::stop() {
    context_.make_current();
    if (!context_.info().software) return {context_, {std::exchange(begun_, 0U), stamped(context_)}};
    context_.finish();
    return Duration(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count());
}

const char* Timer::clock_name(const Context& context) {
    return context.info().software ? "wall" : "gpu";
}

}  // namespace aftershade::gpu
