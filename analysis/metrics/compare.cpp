#include "analysis/metrics/compare.h"

#include "analysis/metrics/flip.h"
#include "analysis/metrics/hdr_flip.h"

#include <fmt/format.h>

#include <limits>

namespace analysis {
namespace {

void check_alike(const NamedImage& a, const NamedImage& b) {
    if (a.image.width != b.image.width || a.image.height != b.image.height) {
        throw ImageError(fmt::format("{} has {} x {} pixels and {} has {} x {}; give pictures of one size",
                                     a.name, a.image.width, a.image.height, b.name, b.image.width,
                                     b.image.height));
    }
    if (is_display_referred(a.image) != is_display_referred(b.image)) {
        throw ImageError(
            fmt::format("{} and {}: one holds radiance and the other values for a display; give two "
                        "OpenEXR or two PNG pictures",
                        a.name, b.name));
    }
}

Exposures chosen_exposures(const LinearImage& reference, const FlipOptions& options) {
    Exposures out = exposures_of(reference, options.tone_mapper);
    if (options.start_exposure || options.stop_exposure) {
        out.start = options.start_exposure.value_or(out.start);
        out.stop = options.stop_exposure.value_or(out.stop);
        if (out.start > out.stop) {
            throw ImageError(
                fmt::format("the exposures start at {:.3f} and stop at {:.3f}; give a stop that is "
                            "not less than the start",
                            out.start, out.stop));
        }
        out.count = exposure_count(out.start, out.stop);
    }
    out.count = options.exposures.value_or(out.count);
    return out;
}

} // namespace

Comparison compare(const NamedImage& picture, const NamedImage& reference, const FlipOptions& options) {
    check_alike(picture, reference);
    Comparison out;
    out.width = picture.image.width;
    out.height = picture.image.height;
    LinearImage a = linear_rgb(picture.image, picture.name);
    LinearImage b = linear_rgb(reference.image, reference.name);
    out.differences = differences(picture.image, reference.image);
    out.picture = count_not_finite(a);
    out.reference = count_not_finite(b);
    const std::vector<bool> compared = finite_in_both(a, b);
    out.errors = errors(a, b, compared);

    equate_outside(compared, a, b);
    out.high_dynamic_range = !is_display_referred(picture.image);
    if (out.high_dynamic_range) {
        out.exposures = chosen_exposures(b, options);
        out.flip_map = hdr_flip(a, b, options.pixels_per_degree, options.tone_mapper, out.exposures);
    } else {
        out.flip_map = ldr_flip(a, b, options.pixels_per_degree);
    }
    out.flip = pool(out.flip_map, compared);
    for (std::size_t i = 0; i < compared.size(); ++i) {
        if (!compared[i]) {
            out.flip_map[i] = std::numeric_limits<float>::quiet_NaN();
        }
    }
    return out;
}

} // namespace analysis
