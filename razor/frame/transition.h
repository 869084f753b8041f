// Over how much of an octave of target edge lengths a vertex moves from its place to its parents' mean. The
// shorter, the fewer blocks are blended; the longer, the slower what a ray sees changes. Chosen when the
// program is built, as the width of vectors is (configs/studies/showcase-transitions.toml compares some).
#pragma once

#ifndef RAZOR_TRANSITION
#define RAZOR_TRANSITION 0.25
#endif

namespace razor {

static_assert(RAZOR_TRANSITION > 0 && RAZOR_TRANSITION <= 1, "a part of one octave");

/// Where it begins, as a share of the length at which the vertex is gone: an octave is the upper half.
inline constexpr float morph_begin = 1.0F - static_cast<float>(RAZOR_TRANSITION) / 2;

} // namespace razor
