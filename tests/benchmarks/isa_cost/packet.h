// What the two versions of the kernel share: 32 rays against one triangle (Moeller & Trumbore 1997).
#pragma once

namespace isa_cost {

struct rays {
    alignas(64) float origin[3][32];
    alignas(64) float direction[3][32];
    alignas(64) float far_t[32]; // shortened by hits
    alignas(64) float u[32], v[32];
};
struct triangle {
    float corner[3];
    float edge[2][3]; // to the second and third corner
};

/// The rays from number `at` on, as many as the logical width: whether any is hit; t, u and v are written
/// where one is.
using kernel = bool (*)(const triangle&, rays&, int at);

} // namespace isa_cost
