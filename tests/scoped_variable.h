// An environment variable that a test changes and puts back.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace aftershade::test {

class ScopedVariable {
public:
    /// Unset until set().
    explicit ScopedVariable(const char* name) : name_(name) {
        if (const char* value = std::getenv(name)) before_ = value;
        unsetenv(name);
    }
    ~ScopedVariable() {
        if (before_) setenv(name_, before_->c_str(), 1);
        else unsetenv(name_);
    }
    ScopedVariable(const ScopedVariable&) = delete;
    ScopedVariable& operator=(const ScopedVariable&) = delete;

    void set(const std::string& value) { setenv(name_, value.c_str(), 1); }

private:
    const char* name_;
    std::optional<std::string> before_;
};

}  // namespace aftershade::test
