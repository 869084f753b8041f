#include "razor/native/target_sampling.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace razor {
namespace {

constexpr double offset = 0.01;        // of relative errors, as pbrt's
constexpr double least_of_mean = 0.25; // of what tiles take

double squared(double x) {
    return x * x;
}

/// The sum over whole shifts of the squared autocorrelation of one axis' factor.
double correlated_along(const Filter& filter, int axis) {
    const double radius = axis == 0 ? filter.radius.x : filter.radius.y;
    constexpr int steps = 64; // a pixel
    const int reach = static_cast<int>(std::ceil(2 * radius));
    const auto overlap = [&](int shift) {
        double sum = 0;
        const int ends = static_cast<int>(std::ceil(radius * steps));
        for (int i = -ends; i < ends; ++i) {
            const double x = (i + 0.5) / steps;
            if (std::abs(x) <= radius && std::abs(x - shift) <= radius)
                sum += filter_at(filter, axis, x) * filter_at(filter, axis, x - shift);
        }
        return sum;
    };
    const double whole = overlap(0);
    double sum = 1;
    for (int shift = 1; shift <= reach; ++shift)
        sum += 2 * squared(overlap(shift) / whole);
    return sum;
}

} // namespace

double correlated_pixels(const Filter& filter) {
    return is_pixel(filter) ? 1 : correlated_along(filter, 0) * correlated_along(filter, 1);
}

TargetSampling::TargetSampling(std::vector<TilePlace> tiles, const Crop& part, const Filter& filter,
                               double target, int most)
    : SamplePlan(tiles.size()), neighbours_(tiles), part_(part), correlation_(correlated_pixels(filter)),
      target_(target), most_(most),
      mean_(3 * static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height)) {
    for (const TilePlace& place : tiles) {
        tiles_.push_back({.place = place});
        each_pixel(place, part, [&](std::size_t) { ++tiles_.back().pixels; });
        pixels_ += static_cast<double>(tiles_.back().pixels);
    }
}

double TargetSampling::mean_square() const {
    double sum = 0;
    for (const Tile& tile : tiles_)
        sum += tile.error;
    return sum / std::max(pixels_, 1.0);
}

std::vector<double> TargetSampling::wanted() const {
    std::vector<double> of_one; // sample: relative variance of a pixel
    for (const Tile& tile : tiles_)
        of_one.push_back(tile.samples * tile.error /
                         static_cast<double>(std::max<std::size_t>(tile.pixels, 1)));
    std::vector<double> n(tiles_.size());
    double roots = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        n[t] = std::sqrt(std::max(of_one[t], neighbours_.mean(tiles_[t].place, of_one)));
        roots += n[t] * static_cast<double>(tiles_[t].pixels);
    }
    const double factor = roots / (squared(target_) * std::max(pixels_, 1.0));
    const double mean = roots * factor / std::max(pixels_, 1.0);
    for (double& samples : n)
        if (samples > 0)
            samples = std::max(samples * factor, least_of_mean * mean);
    return n;
}

bool TargetSampling::next() {
    added_ = 0;
    const bool begins = std::any_of(tiles_.begin(), tiles_.end(), [this](const Tile& tile) {
        return tile.samples < std::min(pilot_samples, most_);
    });
    if (!begins && mean_square() <= squared(target_))
        return false;
    const std::vector<double> n = wanted();
    double after = 0, in_all = 0;
    const auto take = [&](std::size_t t, int samples) {
        const auto pixels = static_cast<double>(tiles_[t].pixels);
        const int had = samples_[t];
        samples_[t] = std::min(samples, most_);
        added_ += (samples_[t] - had) * static_cast<std::int64_t>(tiles_[t].pixels);
        after += samples_[t] * pixels;
        in_all += std::clamp<double>(begins ? most_ : n[t], samples_[t], most_) * pixels;
    };
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const int had = samples_[t];
        if (begins)
            take(t, next_step(had));
        else
            take(t, n[t] >= 2 * had ? 2 * had : n[t] > had ? next_step(had) : had);
    }
    // By roundings the target may be missed though no tile alone wants more: all go on that have any noise.
    if (added_ == 0) {
        after = in_all = 0;
        for (std::size_t t = 0; t < tiles_.size(); ++t)
            take(t, n[t] > 0 ? next_step(samples_[t]) : samples_[t]);
    }
    tell_progress(after, in_all);
    return added_ > 0;
}

void TargetSampling::add(const Film& film) {
    const std::array<const float*, 3> planes{film.find("R")->values.data(), film.find("G")->values.data(),
                                             film.find("B")->values.data()};
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        Tile& tile = tiles_[t];
        const int had = tile.samples, have = samples_[t];
        if (have == had)
            continue;
        const double share = static_cast<double>(had) / have;
        tile.error = tile.square = tile.variance = tile.luminance = 0;
        each_pixel(tile.place, part_, [&](std::size_t i) {
            std::array<double, 3> mean{}, off{};
            double relative = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                mean[c] = double{planes[c][i]};
                // batch - before = (mean - before) / (1 - share)
                off[c] = mean[c] - mean_[3 * i + c];
                mean_[3 * i + c] = mean[c];
                relative += squared(off[c] / (std::max(mean[c], 0.0) + offset)) / 3; // lobes may be negative
            }
            const double light = luminance(mean[0], mean[1], mean[2]);
            if (!std::isfinite(relative) || !std::isfinite(light))
                return;
            const double factor = had == 0 ? 0 : share / (1 - share);
            relative *= factor;
            tile.error += relative;
            tile.square += squared(relative);
            tile.variance += factor * squared(luminance(off[0], off[1], off[2]));
            tile.luminance += light;
        });
        tile.samples = have;
    }
}

PassFigures TargetSampling::figures() const {
    PassFigures f;
    double samples = 0, variance = 0, light = 0, squares = 0;
    for (const Tile& tile : tiles_) {
        f.samples = std::max(f.samples, tile.samples);
        samples += static_cast<double>(tile.pixels) * tile.samples;
        variance += tile.variance;
        light += tile.luminance;
        squares += tile.square;
    }
    f.mean_samples = samples / pixels_;
    f.error = std::sqrt(variance / pixels_);
    f.relative_error = light > 0 ? f.error * pixels_ / light : 0;
    f.target = target_;
    f.target_error = std::sqrt(mean_square());
    if (f.target_error > 0)
        f.target_error_uncertainty = std::sqrt(correlation_ * squares) / pixels_ / (2 * f.target_error);
    return f;
}

} // namespace razor
