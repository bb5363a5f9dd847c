// A deep pixel put together as OpenEXR's document says, in double precision.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace aftershade::test {

struct OneSample {
    double front = 1, back = 1, alpha = 1, value = 0;
};

/// Kainz's own way: cut every sample at every depth where another begins or ends, mix the pieces that share
/// an interval two at a time, and put the results over one another (Interpreting OpenEXR Deep Pixels, 2013,
/// splitting and merging).
struct Kainz {
    static double value_in_front(std::vector<OneSample> samples, double& alpha) {
        std::vector<double> cuts;
        for (const OneSample& s : samples) cuts.insert(cuts.end(), {s.front, s.back});
        std::sort(cuts.begin(), cuts.end());
        cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
        double value = 0, left = 1;
        const auto put = [&](const std::vector<OneSample>& pieces) {
            if (pieces.empty()) return;
            double a = pieces[0].alpha, c = pieces[0].value;
            for (std::size_t i = 1; i < pieces.size(); ++i) merge(a, c, pieces[i].alpha, pieces[i].value);
            value += left * c;
            left *= 1 - a;
        };
        for (std::size_t i = 0; i < cuts.size(); ++i) {
            std::vector<OneSample> points, pieces;
            for (const OneSample& s : samples) {
                if (s.front == cuts[i] && s.back == cuts[i]) points.push_back(s);
                if (i + 1 < cuts.size() && s.front <= cuts[i] && s.back >= cuts[i + 1])
                    pieces.push_back(piece(s, (cuts[i + 1] - cuts[i]) / (s.back - s.front)));
            }
            put(points);
            put(pieces);
        }
        alpha = 1 - left;
        return value;
    }

private:
    static OneSample piece(const OneSample& s, double length) {
        const double alpha = s.alpha < 1 ? 1 - std::pow(1 - s.alpha, length) : 1;
        return {0, 0, alpha, s.alpha > 0 ? s.value * alpha / s.alpha : s.value * length};
    }
    static void merge(double& a1, double& c1, double a2, double c2) {
        if (a1 == 1 || a2 == 1) {
            if (a1 == 1 && a2 == 1) c1 = (c1 + c2) / 2;
            else if (a2 == 1) c1 = c2;
            a1 = 1;
            return;
        }
        const double u1 = -std::log1p(-a1), v1 = a1 > 0 ? u1 / a1 : 1;
        const double u2 = -std::log1p(-a2), v2 = a2 > 0 ? u2 / a2 : 1;
        const double u = u1 + u2, a = a1 + a2 - a1 * a2, w = u > 0 ? a / u : 1;
        c1 = (c1 * v1 + c2 * v2) * w;
        a1 = a;
    }
};

}  // namespace aftershade::test
