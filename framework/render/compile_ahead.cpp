#include "framework/render/compile_ahead.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "framework/base/memory_limit.h"
#include "framework/gpu/driver_cache.h"

namespace aftershade {

int CompileAhead::useful_threads(const gpu::Context& context, int threads) {
    const bool useful =
        context.info().software && !address_space_left() && is_safe_on_threads(context.info().version);
    return useful ? std::max(0, threads) : 0;
}

bool CompileAhead::is_safe_on_threads(std::string_view gl_version) {
    constexpr std::string_view kMesa = "Mesa ";
    const std::size_t found = gl_version.find(kMesa);
    if (found == std::string_view::npos) return true;
    const char* const end = gl_version.data() + gl_version.size();
    std::pair<int, int> version;
    const auto major = std::from_chars(gl_version.data() + found + kMesa.size(), end, version.first);
    if (major.ptr < end) std::from_chars(major.ptr + 1, end, version.second);
    return version < std::pair(25, 2) || version > std::pair(26, 1);
}

CompileAhead::CompileAhead(gpu::Context& context, ProgramCache& programs, std::vector<PassToCompile> passes,
                           int threads)
    : context_(context),
      programs_(programs),
      glsl_folder_(programs.glsl_folder()),
      store_(programs.store()),
      passes_(std::move(passes)),
      states_(passes_.size(), State::open),
      binary_bytes_(passes_.size()) {
    try {
        for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
        // Without threads the caller compiles everything.
    }
}

CompileAhead::~CompileAhead() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
        changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
}

int CompileAhead::index_of(const std::string& pass) const {
    const auto found = std::ranges::find(passes_, pass, &PassToCompile::pass);
    return found == passes_.end() ? -1 : int(found - passes_.begin());
}

CompileAhead::LinkScope::LinkScope(CompileAhead* ahead, const std::string& pass)
    : ahead_(ahead), index_(ahead ? ahead->begin_link(ahead->index_of(pass)) : -1) {}

CompileAhead::LinkScope::~LinkScope() {
    if (index_ < 0) return;
    const auto at = std::size_t(index_);
    const std::size_t bytes = ahead_->programs_.binary_bytes(*ahead_->passes_[at].sources);
    const std::lock_guard lock(ahead_->mutex_);
    ahead_->states_[at] = State::linked;
    ahead_->binary_bytes_[at] = bytes;
    ahead_->changed_.notify_all();
}

/// -1 where a thread was quicker.
int CompileAhead::begin_link(int index) {
    if (index < 0) return -1;
    std::unique_lock lock(mutex_);
    State& state = states_[std::size_t(index)];
    changed_.wait(lock, [&] { return state != State::linking; });
    if (state != State::open) return -1;
    state = State::linking_here;
    return index;
}

void CompileAhead::take(const std::string& pass) {
    const int index = index_of(pass);
    if (index < 0) return;
    std::unique_lock lock(mutex_);
    State& state = states_[std::size_t(index)];
    while (state == State::linking || state == State::drawing) {
        const int other = longest_linked();
        if (other < 0) {
            changed_.wait(lock);
            continue;
        }
        states_[std::size_t(other)] = State::drawing_here;
        lock.unlock();
        draw_here(other);
        lock.lock();
        states_[std::size_t(other)] = State::finished;
    }
    state = State::finished;
}

/// Of the passes that only wait to be drawn the one with the most code: at the end short ones are left, and
/// no core waits long. -1: there is none.
int CompileAhead::longest_linked() const {
    int longest = -1;
    for (int i = 0; i < int(states_.size()); ++i) {
        const auto at = std::size_t(i);
        if (states_[at] != State::linked || !passes_[at].is_drawn) continue;
        if (longest < 0 || binary_bytes_[at] > binary_bytes_[std::size_t(longest)]) longest = i;
    }
    return longest;
}

/// The last pass that nobody has linked; those that are not drawn come after all others. -1: there is none.
int CompileAhead::last_open() const {
    int undrawn = -1;
    for (int i = int(states_.size()) - 1; i >= 0; --i) {
        if (states_[std::size_t(i)] != State::open) continue;
        if (passes_[std::size_t(i)].is_drawn) return i;
        undrawn = std::max(undrawn, i);
    }
    return undrawn;
}

/// With the caller's own program, which keeps the machine code.
void CompileAhead::draw_here(int index) {
    const PassToCompile& pass = passes_[std::size_t(index)];
    try {
        graph::rehearse(context_, *programs_.get(*pass.sources), pass.shape);
        ++passes_drawn_here_;
    } catch (const std::exception&) {
        // The caller meets the fault at that pass.
    }
}

int CompileAhead::programs_made() const {
    const std::lock_guard lock(mutex_);
    return programs_made_;
}

int CompileAhead::passes_drawn() const {
    const std::lock_guard lock(mutex_);
    return passes_drawn_;
}

/// A pass that nobody works on, from now on this thread's; -1: there is none.
int CompileAhead::begin_any() {
    int index = longest_linked();
    if (index >= 0) {
        states_[std::size_t(index)] = State::drawing;
        return index;
    }
    index = last_open();
    if (index >= 0) states_[std::size_t(index)] = State::linking;
    return index;
}

/// Waits for what the caller is linking; -1 where nothing is left to do.
int CompileAhead::next() {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (stops_) return -1;
        if (const int index = begin_any(); index >= 0) return index;
        if (std::ranges::find(states_, State::linking_here) == states_.end()) return -1;
        changed_.wait(lock);
    }
}

void CompileAhead::work() {
    try {
        gpu::Context context(gpu::SiblingOf{context_});
        ProgramCache programs(context, glsl_folder_, store_);
        for (int index = next(); index >= 0; index = next()) work_on(programs, context, index);
    } catch (const std::exception&) {
        // No context, or no memory: the caller does the rest.
    }
}

void CompileAhead::work_on(ProgramCache& programs, gpu::Context& context, int index) {
    const PassToCompile& pass = passes_[std::size_t(index)];
    const auto set = [&](State state, int& count) {
        const std::lock_guard lock(mutex_);
        states_[std::size_t(index)] = state;
        ++count;
        changed_.notify_all();
    };
    int failures = 0;
    try {
        const std::shared_ptr<const gpu::Program> program = programs.get(*pass.sources);
        set(pass.is_drawn ? State::drawing : State::finished, programs_made_);
        if (!pass.is_drawn) return;
        graph::rehearse(context, *program, pass.shape);
        context.finish();
        gpu::wait_for_driver_cache();
        set(State::finished, passes_drawn_);
    } catch (const std::exception&) {
        set(State::finished, failures);
    }
}

}  // namespace aftershade
