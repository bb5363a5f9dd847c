#pragma once

namespace aftershade::graph {

/// Passes begin .. end - 1 by their index in the graph; end -1: to the last.
struct PassRange {
    int begin = 0;
    int end = -1;
    bool contains(int pass) const { return pass >= begin && (end < 0 || pass < end); }
};

}  // namespace aftershade::graph
