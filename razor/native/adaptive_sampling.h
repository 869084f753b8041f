// How many camera samples each screen tile takes, by how noisy it is seen to be.
//
// A pixel's samples come in batches, each as large as half of, or all that came before it. With D the
// difference between a batch's mean luminance and that of all before, and w the share of these among the
// samples then, the variance of the mean of all is estimated as w (1 - w) D^2: without bias where both parts
// are independent, and high where, as here, they are parts of one sequence that fill each other's gaps. As
// both are large parts of it, most of what the sequence gains over random samples is seen; small batches
// would not see it. Each pixel's estimate has one degree of freedom, and a tile's the mean of its 64.
//
// A region's noise is the root mean square error of its luminance over the square root of its mean
// luminance (as Dammertz, Hanika, Keller & Lensch, A Hierarchical Automatic Stopping Condition for Monte
// Carlo Global Illumination, 2010): displays show about the square root of light, so it is twice the noise
// that is seen, as much of it in the dark as in the light.
//
// A tile rests where neither its own noise nor the mean square over the 3 x 3 tiles about it is above the
// threshold, and goes on where that rises later. Stopping by what samples say prefers what by chance says
// little: bright rare light that was not met. What keeps that bias small is that no tile rests before its
// first 16 samples, that a decision is that of 576 pixels, and that D, a difference, is uncorrelated with the
// mean where the distribution of samples is symmetric. What none of all these samples met, nobody can know.
#pragma once

#include "razor/native/sample_plan.h"

#include <vector>

namespace razor {

class AdaptiveSampling : public SamplePlan {
public:
    /// Of the tiles of a film of that part of the picture; `most`: of a pixel's samples, more than
    /// pilot_samples.
    AdaptiveSampling(std::vector<TilePlace> tiles, const Crop& part, double threshold, int most);

    bool next() override;
    void add(const Film& film) override;
    PassFigures figures() const override;

private:
    struct Tile {
        TilePlace place;
        std::size_t pixels = 0;
        int samples = 0;     // those of the estimate
        double variance = 0; // of the pixels' means, summed over them; likewise:
        double luminance = 0;
    };
    /// The noise that decides, squared.
    double deciding(std::size_t tile) const;

    std::vector<Tile> tiles_;
    std::vector<double> noise_; // of each tile, squared
    TileNeighbours neighbours_;
    Crop part_;
    double threshold_;
    int most_;
    std::vector<double> mean_; // of each pixel
};

} // namespace razor
