// Double-precision twins of what sss_adaptive does over frames: how many samples a pixel takes next, and
// which part of its light a control variate explains. Pure; may be called from any thread.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>

namespace aftershade::reference {

/// Mean and variance over the last frames, each of the same weight: what a moving mean stands for.
class FrameWindow {
public:
    explicit FrameWindow(std::size_t frames) : frames_(frames) {}

    void add(double value) {
        values_.push_back(value);
        if (values_.size() > frames_) values_.pop_front();
    }
    double mean() const {
        double sum = 0;
        for (const double value : values_) sum += value;
        return sum / double(values_.size());
    }
    /// Of the values, without bias; at least two of them.
    double variance() const {
        double sum = 0;
        for (const double value : values_) sum += (value - mean()) * (value - mean());
        return sum / double(values_.size() - 1);
    }

private:
    std::size_t frames_;
    std::deque<double> values_;
};

/// Exponentially moving mean and variance (Finch 2009). Its mean has the variance of a window of 2 / weight -
/// 1 frames: weight = 2 / (k + 1) for k frames.
class MovingMoments {
public:
    MovingMoments(double weight, double mean, double variance)
        : weight_(weight), mean_(mean), variance_(variance) {}

    void add(double value) {
        const double off = value - mean_;
        mean_ += weight_ * off;
        variance_ = (1 - weight_) * (variance_ + weight_ * off * off);
    }
    double mean() const { return mean_; }
    double variance() const { return variance_; }

private:
    double weight_, mean_, variance_;
};

/// Samples so that k frames have the wanted variance together, k-frame sums as published (Xie and others
/// 2020): sum of the last k counts times variance over target, less what the frames that stay give already.
inline double next_count_of_window(const std::deque<double>& last_counts, double variance, double target) {
    double sum = 0;
    for (const double count : last_counts) sum += count;
    return (variance / target - 1) * sum + last_counts.front();
}

/// The same with a moving mean in place of the counts: sums of k are k means, and the oldest count is a mean
/// one.
inline double next_count_by_difference(double mean_count, double history_weight, double variance,
                                       double target) {
    return mean_count * (1 + (2 / history_weight - 1) * (variance / target - 1));
}

/// Moving covariance matrix of a value and its control variate (Xie and Olano 2021).
class MovingCovariance {
public:
    MovingCovariance(double weight, double value, double variate)
        : weight_(weight), mean_x_(value), mean_y_(variate) {}

    void add(double value, double variate) {
        const double x = value - mean_x_, y = variate - mean_y_;
        covariance_ = (1 - weight_) * (covariance_ + weight_ * x * y);
        variance_ = (1 - weight_) * (variance_ + weight_ * y * y);
        mean_x_ += weight_ * x;
        mean_y_ += weight_ * y;
    }
    /// What to multiply the variate by before it is subtracted; 1 while it has not varied.
    double factor() const {
        return variance_ > 1e-6 * (1 + mean_y_ * mean_y_) ? std::clamp(covariance_ / variance_, 0.0, 2.0) : 1;
    }

private:
    double weight_, mean_x_, mean_y_, covariance_ = 0, variance_ = 0;
};

}  // namespace aftershade::reference
