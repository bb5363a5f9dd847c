// Coverage of regular polygons, by counting sub-samples: what a bokeh of constant radius must look like.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "framework/image/image.h"

namespace aftershade::test {

struct Vertex {
    double x = 0, y = 0;
};

/// Circumradius `radius_px`, the middle of a straight edge at +x turned by `rotation_deg` towards +y.
inline std::vector<Vertex> regular_polygon(int sides, double radius_px, double rotation_deg) {
    std::vector<Vertex> vertices;
    for (int i = 0; i < sides; ++i) {
        const double angle = (rotation_deg + 180.0 / sides * (2 * i + 1)) * std::numbers::pi / 180;
        vertices.push_back({radius_px * std::cos(angle), radius_px * std::sin(angle)});
    }
    return vertices;
}

inline bool inside_convex(const std::vector<Vertex>& polygon, double x, double y) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vertex& a = polygon[i];
        const Vertex& b = polygon[(i + 1) % polygon.size()];
        if ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x) < 0) return false;
    }
    return true;
}

/// Coverage of each pixel by the polygon around the middle of pixel (center_x, center_y).
inline Image coverage(const std::vector<Vertex>& polygon, int width, int height, int center_x, int center_y) {
    constexpr int kSamples = 32;  // a side; 8 is too few: an edge at 0.47 of a pixel would round to one half
    Image image(width, height, 1);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            int hits = 0;
            for (int j = 0; j < kSamples; ++j)
                for (int i = 0; i < kSamples; ++i)
                    hits += inside_convex(polygon, x - center_x + (i + 0.5) / kSamples - 0.5,
                                          y - center_y + (j + 0.5) / kSamples - 0.5);
            image.at(x, y, 0) = float(hits) / float(kSamples * kSamples);
        }
    return image;
}

/// IoU of {pixel >= half the plateau} and {coverage >= 0.5}.
inline double shape_iou(const Image& image, double plateau, const Image& coverage) {
    int both = 0, either = 0;
    for (int y = 0; y < image.height(); ++y)
        for (int x = 0; x < image.width(); ++x) {
            const bool bright = image.at(x, y, 0) >= 0.5 * plateau;
            const bool covered = coverage.at(x, y, 0) >= 0.5f;
            both += bright && covered;
            either += bright || covered;
        }
    return double(both) / either;
}

}  // namespace aftershade::test
