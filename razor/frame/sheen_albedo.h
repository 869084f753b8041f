// How much of the light that comes evenly from everywhere a sheen lobe reflects towards each direction.
#pragma once

#include <vector>

namespace razor {

/// Places of a table, at cosines (k / (sheen_steps - 1))^2: what changes fast lies at grazing angles.
inline constexpr int sheen_steps = 64;
/// Rougher than a lobe that is all spike.
inline constexpr float least_sheen_roughness = 0.1F;
/// Cosines below count as this.
inline constexpr float least_sheen_cosine = 1.0e-4F;

/// Of a lobe of that width (the square of its roughness), by its definition (razor/kernels/sheen.h) but for
/// the bound that keeps it from giving more than it gets; entries may be above 1.
std::vector<float> sheen_albedo(double alpha);

/// The same of all roughnesses from the least on to the most, both within the model's range: rows of
/// sheen_steps, between which albedos are straight over the root of the roughness to 0.003 of what is
/// reflected (over the roughness itself narrow lobes would need three times as many).
struct SheenRows {
    std::vector<float> albedo;
    float first_root = 0, per_root = 0; // row (root - first_root) * per_root
    int last = 0;
};
SheenRows sheen_albedo_rows(float least, float most);

} // namespace razor
