#include "razor/survey/sight.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace razor {
namespace {

/// Column and row of a quad's vertices that triangle `which` has, after its first at (0, 0).
constexpr std::array<std::array<std::array<int, 2>, 2>, 2> triangle_vertices{
    {{{{1, 0}, {1, 1}}}, {{{1, 1}, {0, 1}}}}};

} // namespace

Sight sight_of(Frame& frame, const NamedHit& hit) {
    const FrameHeader& h = frame.header();
    const auto& block = *reinterpret_cast<const BlockHeader*>(h.grids.get() + hit.block);
    const InstanceRecord& instance = h.instances.get()[block.instance];
    const std::int32_t number = hit.patch - instance.first_patch;
    const PatchRecord& patch = h.patches.get()[instance.first_record + number];
    Sight s;
    s.mesh = instance.mesh;
    s.instance = block.instance;
    s.face = patch.face - frame.first_face(instance.mesh);
    s.part = patch.sub;
    s.patch = number;
    s.block = block.number;
    s.level = block.level;
    s.absolute = block.absolute;
    const int quad = hit.triangle >> 1 & (block_quads * block_quads - 1);
    const auto& second = triangle_vertices[static_cast<std::size_t>(hit.triangle & 1)];
    std::array<double, 2> place{static_cast<double>(block.column * block_quads + quad % block_quads),
                                static_cast<double>(block.row * block_quads + quad / block_quads)};
    for (std::size_t k = 0; k < 2; ++k)
        place[k] = std::ldexp(place[k] + double{hit.u} * second[0][k] + double{hit.v} * second[1][k],
                              -block.exponent[k]);
    s.u = place[0];
    s.v = place[1];
    return s;
}

double asked_edge(const FrameHeader& frame, const glm::dvec3& point) {
    if (frame.fixed_target > 0)
        return 0;
    const auto vec = [](const float* p) { return glm::dvec3(p[0], p[1], p[2]); };
    const glm::dvec3 way = point - vec(frame.field_origin);
    const double blur = std::abs(frame.camera_base + glm::dot(vec(frame.camera_slope), way));
    return (blur + frame.camera_growth * glm::length(way)) * level_rounding;
}

} // namespace razor
