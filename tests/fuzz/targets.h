// What a stranger's bytes reach first: one function for each kind of input. libFuzzer feeds them bytes of its
// own (fuzz_main.cpp), the tests those that once broke something (tests/reliability).
#pragma once

#include <span>
#include <string_view>

namespace aftershade::fuzz {

struct Target {
    std::string_view name;
    std::string_view file;  ///< that the bytes stand in; seeds have its extension
    /// Returns if the input was read or refused as documented; ends the process otherwise.
    void (*run)(std::string_view bytes);
};

std::span<const Target> targets();

}  // namespace aftershade::fuzz
