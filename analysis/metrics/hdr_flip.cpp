#include "analysis/metrics/hdr_flip.h"

#include "analysis/metrics/flip.h"

#include <algorithm>

namespace analysis {

std::vector<float> hdr_flip(const LinearImage& picture, const LinearImage& reference,
                            double pixels_per_degree, ToneMapper mapper, const Exposures& exposures) {
    std::vector<float> out(reference.size());
    for (int i = 0; i < exposures.count; ++i) {
        const double exposure = exposures.at(i);
        const std::vector<float> error =
            ldr_flip(tone_mapped(picture, mapper, exposure), tone_mapped(reference, mapper, exposure),
                     pixels_per_degree);
        std::transform(out.begin(), out.end(), error.begin(), out.begin(),
                       [](float a, float b) { return std::max(a, b); });
    }
    return out;
}

} // namespace analysis
