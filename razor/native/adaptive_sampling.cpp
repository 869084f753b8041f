#include "razor/native/adaptive_sampling.h"

#include <algorithm>
#include <cmath>

namespace razor {
namespace {

double squared(double x) {
    return x * x;
}

} // namespace

AdaptiveSampling::AdaptiveSampling(std::vector<TilePlace> tiles, const Crop& part, double threshold, int most)
    : SamplePlan(tiles.size()), noise_(tiles.size()), neighbours_(tiles), part_(part), threshold_(threshold),
      most_(most), mean_(static_cast<std::size_t>(part.width) * static_cast<std::size_t>(part.height)) {
    for (const TilePlace& place : tiles) {
        tiles_.push_back({.place = place});
        each_pixel(place, part, [&](std::size_t) { ++tiles_.back().pixels; });
    }
}

double AdaptiveSampling::deciding(std::size_t tile) const {
    return std::max(noise_[tile], neighbours_.mean(tiles_[tile].place, noise_));
}

bool AdaptiveSampling::next() {
    added_ = 0;
    double after = 0, in_all = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const int had = samples_[t];
        const double needed = had * deciding(t) / squared(threshold_); // as the error of random samples falls
        int wanted = next_step(had);
        if (had >= pilot_samples && needed >= 2 * had)
            wanted = 2 * had;
        if (had < pilot_samples || needed > had)
            samples_[t] = std::min(wanted, most_);
        const auto pixels = static_cast<double>(tiles_[t].pixels);
        added_ += (samples_[t] - had) * static_cast<std::int64_t>(tiles_[t].pixels);
        after += samples_[t] * pixels;
        in_all += (had < pilot_samples ? most_ : std::clamp<double>(needed, samples_[t], most_)) * pixels;
    }
    tell_progress(after, in_all);
    return added_ > 0;
}

void AdaptiveSampling::add(const Film& film) {
    const auto plane = [&](const char* name) { return film.find(name)->values.data(); };
    const float *red = plane("R"), *green = plane("G"), *blue = plane("B");
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        Tile& tile = tiles_[t];
        const int had = tile.samples, have = samples_[t];
        if (have == had)
            continue;
        const double share = static_cast<double>(had) / have;
        double variance = 0, luminance = 0;
        each_pixel(tile.place, part_, [&](std::size_t i) {
            const double mean = razor::luminance(double{red[i]}, double{green[i]}, double{blue[i]});
            // batch - before = (mean - before) / (1 - share)
            const double off = had == 0 ? 0 : share / (1 - share) * squared(mean - mean_[i]);
            mean_[i] = mean;
            if (std::isfinite(mean) && std::isfinite(off)) {
                variance += off;
                luminance += mean;
            }
        });
        const auto pixels = static_cast<double>(std::max<std::size_t>(tile.pixels, 1));
        constexpr double black = 1e-12; // there is noise of nothing else
        noise_[t] = variance / std::max(luminance, black * pixels);
        tile.variance = variance;
        tile.luminance = luminance;
        tile.samples = have;
    }
}

PassFigures AdaptiveSampling::figures() const {
    PassFigures f;
    double pixels = 0, samples = 0, variance = 0, luminance = 0, quiet = 0;
    for (std::size_t t = 0; t < tiles_.size(); ++t) {
        const Tile& tile = tiles_[t];
        const auto own = static_cast<double>(tile.pixels);
        f.samples = std::max(f.samples, tile.samples);
        pixels += own;
        samples += own * tile.samples;
        variance += tile.variance;
        luminance += tile.luminance;
        if (tile.samples >= pilot_samples && deciding(t) <= squared(threshold_))
            quiet += own;
    }
    f.mean_samples = samples / pixels;
    f.error = std::sqrt(variance / pixels);
    f.relative_error = luminance > 0 ? f.error * pixels / luminance : 0;
    f.threshold = threshold_;
    f.within_threshold = quiet / pixels;
    return f;
}

} // namespace razor
