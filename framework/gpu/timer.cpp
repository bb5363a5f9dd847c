#include "framework/gpu/timer.h"

#include "framework/gpu/context_internal.h"

namespace aftershade::gpu {

Timer::Timer(Context& context) : context_(context) {
    if (context_.info().software) return;
    context_.make_current();
    context_.gl().CreateQueries(GL_TIMESTAMP, 2, queries_);
}

Timer::~Timer() {
    if (queries_[0] == 0 || !context_.impl().try_make_current()) return;
    context_.gl().DeleteQueries(2, queries_);
}

void Timer::start() {
    context_.make_current();
    if (queries_[0] != 0) {
        context_.gl().QueryCounter(queries_[0], GL_TIMESTAMP);
        return;
    }
    context_.finish();
    start_ = std::chrono::steady_clock::now();
}

double Timer::stop_ms() {
    context_.make_current();
    if (queries_[0] == 0) {
        context_.finish();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }
    const GladGLContext& gl = context_.gl();
    gl.QueryCounter(queries_[1], GL_TIMESTAMP);
    GLuint64 begin_ns = 0;
    GLuint64 end_ns = 0;
    gl.GetQueryObjectui64v(queries_[1], GL_QUERY_RESULT, &end_ns);
    gl.GetQueryObjectui64v(queries_[0], GL_QUERY_RESULT, &begin_ns);
    return static_cast<double>(end_ns - begin_ns) * 1e-6;
}

const char* Timer::clock_name(const Context& context) {
    return context.info().software ? "wall" : "gpu";
}

}  // namespace aftershade::gpu
