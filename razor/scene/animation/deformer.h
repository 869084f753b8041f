// Deformations by formula, of points in a cage's own coordinates.
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace razor {

/// With s, a point's way along the axis from the origin:
///   wave   moves it along `direction` by amount * sin(2 pi (s / wavelength - t / period + phase));
///   twist  turns it about the axis by amount * s * swing degrees;
///   bend   bends the axis, where s > 0, towards `direction` into an arc of amount * swing degrees a unit;
///   what
///          is beside it follows as a stiff beam's cross sections do, and lengths along the axis stay.
/// swing = sin(2 pi (t / period + phase)), or 1 without a period: what then is still is a wave, too.
enum class DeformerKind : std::uint8_t { wave, twist, bend };

struct Deformer {
    DeformerKind kind = DeformerKind::wave;
    glm::dvec3 origin{0};          // all lengths in units of the cage's file or shape
    glm::dvec3 axis{0, 1, 0};      // of any length but 0
    glm::dvec3 direction{1, 0, 0}; // likewise; bend: what of it is across the axis, which must be something
    double amount = 0;             // a length; degrees a unit of length
    double wavelength = 1;         // of a wave, positive
    double period = 0;             // seconds; 0: nothing changes in time
    double phase = 0;              // turns

    bool operator==(const Deformer&) const = default;
};

/// The points as they are `seconds` after the beginning.
void deform(const Deformer& deformer, double seconds, std::vector<glm::dvec3>& points);

} // namespace razor
