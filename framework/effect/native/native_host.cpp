#include "framework/effect/native/native_host.h"

#include <utility>

namespace aftershade {

namespace {

// A plug-in that logs in a loop must not fill the memory.
constexpr std::size_t kMaxLogLines = 1000;

NativeHost& self(const aftershade_host* host) {
    return *static_cast<NativeHost*>(host->host_data);
}

}  // namespace

NativeHost::NativeHost() {
    host_.struct_size = sizeof host_;
    host_.abi_major = AFTERSHADE_ABI_MAJOR;
    host_.abi_minor = AFTERSHADE_ABI_MINOR;
    host_.name = "aftershade";
    host_.version = AFTERSHADE_VERSION;
    host_.host_data = this;
    host_.log = log;
    host_.set_error = set_error;
    host_.get_extension = get_extension;
}

std::string NativeHost::take_error() {
    const std::lock_guard lock(mutex_);
    return std::exchange(error_, {});
}

std::vector<NativeLogLine> NativeHost::take_log() {
    const std::lock_guard lock(mutex_);
    return std::exchange(lines_, {});
}

void NativeHost::log(const aftershade_host* host, aftershade_log_level level, const char* message) noexcept
    try {
    NativeHost& owner = self(host);
    const std::lock_guard lock(owner.mutex_);
    const auto known = level >= AFTERSHADE_LOG_DEBUG && level <= AFTERSHADE_LOG_ERROR;
    if (owner.lines_.size() < kMaxLogLines)
        owner.lines_.push_back(
            {known ? NativeLogLevel(level) : NativeLogLevel::info, message ? message : ""});
    else if (owner.lines_.size() == kMaxLogLines)
        owner.lines_.push_back({NativeLogLevel::warning, "further lines are dropped"});
} catch (...) {  // no memory for a line: the work goes on without it
}

void NativeHost::set_error(const aftershade_host* host, const char* message) noexcept try {
    NativeHost& owner = self(host);
    const std::lock_guard lock(owner.mutex_);
    owner.error_ = message ? message : "";
} catch (...) {  // no memory for the text: the failure itself is still reported
}

const void* NativeHost::get_extension(const aftershade_host*, const char*) noexcept {
    return nullptr;  // "aftershade.image/1" is reserved, and no other is defined
}

}  // namespace aftershade
