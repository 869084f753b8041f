// How many camera samples each screen tile takes, pass by pass: what plans by noise or by error have in
// common.
#pragma once

#include "razor/frame/tile_place.h"
#include "razor/image/image.h"
#include "razor/native/pass_figures.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace razor {

/// What every pixel has at least, in two batches.
inline constexpr int pilot_samples = 16;

/// The next of 8, 16, 24, 32, 48, 64, 96, ...: parts of the sample sequence that begin there are whole ones.
int next_step(int samples);

/// Rec. 709 luminance.
constexpr double luminance(double red, double green, double blue) {
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue;
}

/// The tiles of a film by where they are.
class TileNeighbours {
public:
    explicit TileNeighbours(std::span<const TilePlace> places);
    /// The mean of what each of the 3 x 3 tiles about that one has, of those that there are.
    double mean(const TilePlace& middle, std::span<const double> values) const;

private:
    std::map<std::pair<int, int>, std::size_t> numbers_; // by column and row
};

class SamplePlan {
public:
    virtual ~SamplePlan() = default;

    /// How many samples each tile is to have after the next pass; false: all rest, or have the most.
    virtual bool next() = 0;
    /// As next() said, by the tiles' numbers.
    std::span<const int> samples() const { return samples_; }
    /// How many samples, of pixels in the part, next() added.
    std::int64_t added() const { return added_; }
    /// The film with those samples. What is no finite number is left out.
    virtual void add(const Film& film) = 0;
    /// All but times; samples are the most that a pixel has.
    virtual PassFigures figures() const = 0;
    /// Of all that will be taken, as far as noise tells, what next() counted has been taken before and with
    /// it.
    std::pair<double, double> progress() const { return {done_before_, done_after_}; }

protected:
    explicit SamplePlan(std::size_t tiles) : samples_(tiles) {}
    /// Of samples times pixels: what there will be after the pass, and at the end.
    void tell_progress(double after, double in_all);

    std::vector<int> samples_;
    std::int64_t added_ = 0;

private:
    double done_before_ = 0, done_after_ = 0;
};

} // namespace razor
