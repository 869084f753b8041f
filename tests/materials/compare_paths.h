// Pictures of the renderer against those of the plain path tracer, by what chance leaves open.
#pragma once

#include "razor/scene/scene.h"
#include "tests/materials/plain_paths.h"

#include <string>
#include <vector>

namespace razor::test {

/// What paths followed one by one give of a scene.
struct PlainPicture {
    std::string name;
    std::vector<BlockMean> blocks;
};

/// That the scene's picture is the one that paths followed one by one give, as far as the noise of both
/// tells: each block of 4 x 4 pixels, and the whole. Prints how they differ. The scene has room_size pixels
/// both ways and a room's noise. `alike`: rendered instead, if not null. Returns what it was compared with.
PlainPicture expect_same_picture(const Scene& scene, int samples_a_pixel, const Scene* alike = nullptr);

/// That the comparison sees a difference where the other scene is rendered instead: else it says nothing.
void expect_other_picture(const PlainPicture& plain, const Scene& other);

} // namespace razor::test
