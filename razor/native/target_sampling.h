// How many camera samples each screen tile takes for a picture whose relative error is a stated one, at the
// least cost.
//
// The error is pbrt's (imgtool, and `razor compare`): the root of the relative mean square error, the mean
// over pixels and their channels R, G and B of ((v - r) / (r + 0.01))^2, where r is what infinitely many
// samples of the same surfaces would give. Here r is what samples say so far. It is noise alone: what levels
// of detail leave out, and light that paths longer than asked for would bring, is in r too.
//
// Samples come in batches, as razor/native/adaptive_sampling.h says, and so is each pixel's variance found:
// with D the difference between a batch's mean and that of all before, and w their share of the samples then,
// w (1 - w) D^2. That is high rather than low, as both are parts of one sequence.
//
// The sum over tiles of v / n, each pixel's relative variance v by one sample over the samples n, is least
// for samples in all where n goes as the square root of v (Lagrange). v of a tile is the larger of its own
// and the mean of the 3 x 3 tiles about it. No tile that is not wholly without noise takes less than a
// quarter of the mean: where light is rare, its samples may not have met it yet. n doubles at most from pass
// to pass, and the last pass ends once the estimate is no more than the target.
//
// The estimate's own standard error: each pixel's is one random number x, whose variance is at most its mean
// square, whatever its distribution (of Gaussian noise it is two thirds of that, so that the error is told
// 1.22 times too large). Where a filter spreads samples over pixels their x are not independent; the sum of
// squared correlations of the noise, by the filter's shape, says as how many they count.
#pragma once

#include "razor/native/sample_plan.h"
#include "razor/scene/filter.h"

#include <vector>

namespace razor {

/// As how many pixels one counts whose noise is that of samples about it, weighted by the filter: 1 for the
/// box of a pixel.
double correlated_pixels(const Filter& filter);

class TargetSampling : public SamplePlan {
public:
    /// Of the tiles of a film of that part of the picture; `most`: of a pixel's samples, at least
    /// pilot_samples.
    TargetSampling(std::vector<TilePlace> tiles, const Crop& part, const Filter& filter, double target,
                   int most);

    bool next() override;
    void add(const Film& film) override;
    PassFigures figures() const override;

private:
    struct Tile {
        TilePlace place;
        std::size_t pixels = 0;
        int samples = 0; // those of the estimate
        // Sums over its pixels: of their relative square errors, of these squared, and of luminance.
        double error = 0, square = 0, variance = 0, luminance = 0;
    };
    /// The picture's relative mean square error.
    double mean_square() const;
    /// What each tile is to have in the end, not rounded.
    std::vector<double> wanted() const;

    std::vector<Tile> tiles_;
    TileNeighbours neighbours_;
    Crop part_;
    double correlation_, target_;
    int most_;
    double pixels_ = 0;
    std::vector<double> mean_; // of each pixel: red, green, blue
};

} // namespace razor
