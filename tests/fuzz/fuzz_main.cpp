// libFuzzer's way in. AFTERSHADE_FUZZ_TARGET names one of the targets; scripts/check fuzz sets it.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "framework/base/diagnostics.h"
#include "tests/fuzz/targets.h"

namespace {

const aftershade::fuzz::Target* chosen = nullptr;

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
    const char* name = std::getenv("AFTERSHADE_FUZZ_TARGET");
    for (const aftershade::fuzz::Target& target : aftershade::fuzz::targets()) {
        if (name && target.name == name) chosen = &target;
        // Without a name: what there is, for scripts/check fuzz.
        if (!name) std::printf("%s\n", std::string_view(target.name).data());
    }
    if (chosen) return 0;
    std::fflush(stdout);
    std::_Exit(name ? 2 : 0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    chosen->run({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
