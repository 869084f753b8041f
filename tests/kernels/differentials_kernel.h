// razor/kernels/differentials.h and concentric_disk() over arrays, once a target, for its tests.
#pragma once

namespace razor::test {

/// Arrays of `count` floats, a multiple of the width; vectors as three of them, x, y, z.
struct DifferentialArrays {
    int count = 0;
    float *d = nullptr, *film_x = nullptr, *film_y = nullptr; // a ray through a point of the film
    float* t = nullptr;
    float* normal = nullptr;
    float *lens_x = nullptr, *lens_y = nullptr;
    float *base = nullptr, *spacing = nullptr, *cosine = nullptr, *inverse_distance = nullptr;
    float *square_u = nullptr, *square_v = nullptr; // of a sample
    // Results.
    float *direction_x = nullptr, *direction_y = nullptr; // of the pinhole's ray
    float *origin_x = nullptr, *origin_y = nullptr;       // moved to the surface
    float *across = nullptr, *moved_across = nullptr;     // footprints of these two
    float* lens_across = nullptr;
    float* parallel_across = nullptr; // of an orthographic camera with these steps
    float *disk_x = nullptr, *disk_y = nullptr;
    float *growth_to_area = nullptr, *growth_to_sky = nullptr;
};

} // namespace razor::test
