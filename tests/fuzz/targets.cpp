#include "tests/fuzz/targets.h"

#include <vector>

#include "tests/fuzz/target_checks.h"

namespace aftershade::fuzz {

std::span<const Target> targets() {
    static const std::vector<Target> all = [] {
        std::vector<Target> list;
        for (const auto& some : {picture_targets(), document_targets(), message_targets()})
            list.insert(list.end(), some.begin(), some.end());
        return list;
    }();
    return all;
}

}  // namespace aftershade::fuzz
