// Tone mapping and the range of exposures of HDR-FLIP (Andersson, Nilsson, Shirley, Akenine-Moeller,
// "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics 2021).
#pragma once

#include "analysis/images/linear_image.h"

#include <array>
#include <string_view>

namespace analysis {

/// `aces` is Narkowicz's fit of the ACES curve (2015) on 0.6 times the light, `hable` Hable's filmic curve
/// (2010), `reinhard` x / (1 + luminance) (Reinhard et al. 2002).
enum class ToneMapper { aces, hable, reinhard };
inline constexpr std::array<std::string_view, 3> tone_mapper_names{"aces", "hable", "reinhard"};

/// The curve at x >= 0, not clamped. For `reinhard`, that of a grey whose luminance is x.
double tone_curve(ToneMapper mapper, double x);

/// Where the curve reaches y, which it does for 0 <= y < 1.
double inverse_tone_curve(ToneMapper mapper, double y);

/// The picture times 2^exposure on a display: tone mapped, clamped to [0, 1]. Negative values count as 0.
LinearImage tone_mapped(const LinearImage& image, ToneMapper mapper, double exposure);

/// Exposures in stops: `count` of them, evenly from `start` to `stop`.
struct Exposures {
    double start = 0, stop = 0;
    int count = 1;

    double at(int i) const;
};

/// The paper's range: at `start` the brightest pixel of the reference reaches 0.85 on the
/// display, at `stop` the pixel of median luminance does; as many exposures as stops between, and at least 2.
/// Where more than half of the pixels are black, the median is that of the others (the paper defines none);
/// where all are, the only exposure is 0.
Exposures exposures_of(const LinearImage& reference, ToneMapper mapper);

/// At least 2, and one for each stop begun.
int exposure_count(double start, double stop);

} // namespace analysis
