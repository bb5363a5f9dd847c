// How well one frame, warped by motion vectors, becomes another: the measure of velocity_check.cpp. Only
// this file and tests include it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "framework/image/color_space.h"
#include "framework/image/image.h"

namespace aftershade {

/// A frame as it is compared: every channel c / (c + pivot), which no highlight dominates, then blurred
/// against noise.
struct ComparedFrame {
    int width = 0;
    int height = 0;
    /// Red, green and blue in [0, 1]; 1 where the pixel was finite, 0 where its neighbours stand for it, -1
    /// where it has none.
    std::vector<std::array<float, 4>> texels;

    const std::array<float, 4>& at(int x, int y) const { return texels[std::size_t(y) * width + x]; }
};

/// The median luminance of both frames, whose colours have these primaries, where they are not black: what
/// ComparedFrame maps to 0.5.
double median_luminance(const Image& color_a, const Image& color_b, const Chromaticities& primaries);
ComparedFrame make_compared(const Image& color, double pivot);

struct Move {
    double x = 0, y = 0;  ///< px
};

/// The change of a vector: exchange its components where `swapped`, then multiply.
struct VectorMap {
    bool swapped = false;
    double x = 1;
    double y = 1;

    Move apply(double vector_x, double vector_y) const {
        return swapped ? Move{x * vector_y, y * vector_x} : Move{x * vector_x, y * vector_y};
    }
};

/// Errors of two readings at the same samples.
struct TimeDispute {
    double own = 0, other = 0;  ///< sums
    std::size_t count = 0;
    bool told = false;  ///< there are enough samples
};

/// One frame's pixels, followed along its vectors into the other frame. Samples are drawn in proportion to
/// the length of the vectors, as a slow pan of the whole picture shows less than the one object that flies
/// through it.
class WarpTest {
public:
    /// `direction` is +1 where the vectors are to point into `target` and -1 where they come from there.
    WarpTest(const ComparedFrame& source, const ComparedFrame& target, const Image& vectors,
             double direction);

    int moving_px() const { return moving_px_; }  ///< pixels with vectors of at least one pixel
    double longest_px() const { return longest_px_; }
    bool empty() const { return samples_.empty(); }
    double still_error()
        const;  ///< mean difference, 0 to 1, between the frames at the samples, without a warp
    /// 1 - error / error without a warp; what leaves the picture is left out. A rough score takes
    /// a tenth of the samples.
    double score(const VectorMap& map, bool rough = false) const;
    /// 1 - error of `better` / error of `worse` where the two land at least a pixel apart; 0 where too few
    /// samples do.
    double dispute(const VectorMap& better, const VectorMap& worse) const;
    /// `other` follows the target's pixels back into this source by its own vectors. Compares both readings
    /// at this test's samples whose surface both frames see by the other's reading, where they are at least a
    /// pixel apart: uncovered background and what leaves the picture say nothing of time.
    TimeDispute dispute_in_time(const VectorMap& map, const WarpTest& other,
                                const VectorMap& other_map) const;

private:
    struct Sample {
        float x, y, vector_x, vector_y;
        std::array<float, 3> color;
        float still_error;
    };
    /// The mapped vector of the source's pixel nearest to a place; nullopt where there is none.
    std::optional<Move> move_at(double x, double y, const VectorMap& map) const;
    std::vector<float> weigh(const ComparedFrame& source, const Image& vectors);
    void draw_samples(const ComparedFrame& source, const Image& vectors, const std::vector<float>& weights);
    float error(const Sample& sample, Move move) const;

    const ComparedFrame& target_;
    const Image& vectors_;
    double direction_ = 1;
    int moving_px_ = 0;
    double longest_px_ = 0;
    std::vector<Sample> samples_;
};

}  // namespace aftershade
