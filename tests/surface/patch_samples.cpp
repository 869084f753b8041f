#include "patch_samples.h"

#include <glm/vec3.hpp>

namespace razor::test {
namespace {
std::size_t block_row(std::size_t vertices) {
    return (vertices + RAZOR_WIDTH - 1) / RAZOR_WIDTH * RAZOR_WIDTH;
}
} // namespace

PagePool::PagePool(const Mesh& mesh, const Topology& topology, int level)
    : mesh_(mesh), topology_(topology), maker_(mesh, topology, PageMaker::Options{level}) {}

const std::vector<float>& PagePool::page(const PageKey& key) {
    const std::vector<int> id{key.face_class, static_cast<int>(key.kind),
                              key.local,      key.reversed,
                              key.exponent_u, key.strip_u,
                              key.exponent_v, key.strip_v};
    const auto [entry, is_new] = pages_.try_emplace(id);
    if (is_new) {
        const int controls = topology_.classes[static_cast<std::size_t>(key.face_class)].control_count;
        entry->second.assign(page_floats(key, controls), -1.0F);
        maker_.make(key, entry->second.data());
    }
    return entry->second;
}

std::vector<glm::dvec3> PagePool::apply(const PageKey& key, int face, std::size_t count, std::size_t row,
                                        std::size_t rows_a_point, std::size_t which, bool single) const {
    const std::vector<float>& weights = const_cast<PagePool*>(this)->page(key);
    const FaceRecord& record = topology_.faces[static_cast<std::size_t>(face)];
    const glm::dvec3 origin = mesh_.points[0];
    std::vector<glm::dvec3> result;
    for (std::size_t i = 0; i < count; ++i) {
        glm::dvec3 sum(0);
        glm::vec3 single_sum(0);
        for (int c = 0; c < record.control_count; ++c) {
            const auto point = static_cast<std::size_t>(
                topology_.controls[static_cast<std::size_t>(record.control_first + c)]);
            const float w = weights[(static_cast<std::size_t>(c) * rows_a_point + which) * row + i];
            const glm::dvec3 p = mesh_.points[point] - origin;
            sum += static_cast<double>(w) * p;
            single_sum += w * glm::vec3(p);
        }
        const bool is_position = rows_a_point == 1;
        result.push_back((single ? glm::dvec3(single_sum) : sum) + (is_position ? origin : glm::dvec3(0)));
    }
    return result;
}

Samples PagePool::block(const PatchRecord& patch, int n, bool single) {
    PageKey key;
    key.face_class = topology_.faces[static_cast<std::size_t>(patch.face)].face_class;
    key.local = patch.sub;
    key.exponent_u = key.exponent_v = n;
    const auto side = static_cast<std::size_t>(1 << n) + 1;
    const std::size_t row = block_row(side * side);
    Samples s;
    s.position = apply(key, patch.face, side * side, row, 1, 0, single);
    key.kind = PageKind::derivative;
    s.du = apply(key, patch.face, side * side, row, 2, 0, single);
    s.dv = apply(key, patch.face, side * side, row, 2, 1, single);
    return s;
}

std::vector<glm::dvec3> PagePool::curve(int curve, int n) {
    const CurveRecord& record = topology_.curves[static_cast<std::size_t>(curve)];
    PageKey key;
    key.kind = PageKind::curve;
    key.face_class = topology_.faces[static_cast<std::size_t>(record.owner_face)].face_class;
    key.local = record.owner_local;
    key.reversed = (record.flags & curve_owner_reversed) != 0;
    key.exponent_u = n;
    return apply(key, record.owner_face, static_cast<std::size_t>(1 << n) + 1, curve_row, 1, 0, false);
}

glm::dvec3 PagePool::vertex(int point) {
    const VertexRecord& record = topology_.points[static_cast<std::size_t>(point)];
    PageKey key;
    key.kind = PageKind::vertex;
    key.face_class = topology_.faces[static_cast<std::size_t>(record.owner_face)].face_class;
    key.local = record.owner_corner;
    return apply(key, record.owner_face, 1, 1, 1, 0, false)[0];
}

double curve_parameter(int side_flags, double s) {
    const double t = (side_flags & side_half) != 0 ? s / 2 : s;
    return (side_flags & side_reversed) != 0 ? 1 - t : t;
}

} // namespace razor::test
