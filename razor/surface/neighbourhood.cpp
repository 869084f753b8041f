#include "razor/surface/neighbourhood.h"

#include <algorithm>
#include <bit>
#include <iterator>

namespace razor {

Sharpness gather_sharpness(const Mesh& mesh, const Adjacency& adjacency) {
    Sharpness s;
    s.edge.assign(adjacency.edge_points.size(), 0.0F);
    s.point.assign(mesh.points.size(), 0.0F);
    for (const Crease& crease : mesh.creases) {
        s.edge[static_cast<std::size_t>(adjacency.find_edge(crease.v0, crease.v1))] =
            std::min(crease.sharpness, infinite_sharpness);
    }
    for (const Corner& corner : mesh.corners) {
        s.point[static_cast<std::size_t>(corner.vertex)] = std::min(corner.sharpness, infinite_sharpness);
    }
    return s;
}

NeighbourhoodWalker::NeighbourhoodWalker(const Adjacency& adjacency, const Sharpness& sharpness)
    : adjacency_(adjacency), sharpness_(sharpness), stamp_(sharpness.point.size(), -1),
      local_(sharpness.point.size()), corner_stamp_(adjacency.corner_face.size(), 0) {}

void NeighbourhoodWalker::gather_fan(int corner) {
    fan_.corners.assign(1, corner);
    fan_.counter_clockwise = fan_.clockwise = 0;
    fan_.closed = false;
    for (int c = adjacency_.counter_clockwise(corner); c >= 0; c = adjacency_.counter_clockwise(c)) {
        if (c == corner) {
            fan_.closed = true;
            break;
        }
        fan_.corners.push_back(c);
        ++fan_.counter_clockwise;
    }
    if (!fan_.closed) {
        for (int c = adjacency_.clockwise(corner); c >= 0; c = adjacency_.clockwise(c)) {
            fan_.corners.push_back(c);
            ++fan_.clockwise;
        }
    }
    const std::span<const int> all = adjacency_.corners_at_point(adjacency_.point(corner));
    if (fan_.corners.size() < all.size()) {
        ++fan_number_;
        for (const int c : fan_.corners) {
            corner_stamp_[static_cast<std::size_t>(c)] = fan_number_;
        }
        std::copy_if(all.begin(), all.end(), std::back_inserter(fan_.corners),
                     [&](int c) { return corner_stamp_[static_cast<std::size_t>(c)] != fan_number_; });
    }
}

bool NeighbourhoodWalker::gather_regular(int face) {
    if (adjacency_.size(face) != 4) {
        return false;
    }
    const int first = adjacency_.first(face);
    result_.controls.clear();
    for (int i = 0; i < 4; ++i) {
        result_.controls.push_back(adjacency_.point(first + i));
    }
    for (int i = 0; i < 4; ++i) {
        const int corner = first + i;
        if (sharpness_.point[static_cast<std::size_t>(adjacency_.point(corner))] != 0.0F ||
            adjacency_.corners_at_point(adjacency_.point(corner)).size() != 4) {
            return false;
        }
        gather_fan(corner);
        if (!fan_.closed || fan_.corners.size() != 4 || fan_.counter_clockwise != 3) {
            return false;
        }
        for (const int c : fan_.corners) {
            if (adjacency_.size(adjacency_.face(c)) != 4 ||
                sharpness_.edge[static_cast<std::size_t>(adjacency_.leading_edge(c))] != 0.0F) {
                return false;
            }
        }
        int c = fan_.corners[2];
        for (int k = 0; k < 3; ++k) {
            c = adjacency_.next_corner(c);
            result_.controls.push_back(adjacency_.point(c));
        }
    }
    return true;
}

int NeighbourhoodWalker::local_number(int point) {
    const auto p = static_cast<std::size_t>(point);
    if (stamp_[p] != face_) {
        stamp_[p] = face_;
        local_[p] = static_cast<int>(result_.controls.size());
        result_.controls.push_back(point);
    }
    return local_[p];
}

void NeighbourhoodWalker::append_sharpness(float sharpness) {
    result_.signature.push_back(std::bit_cast<std::int32_t>(sharpness));
    result_.fading = result_.fading || (sharpness > 0 && sharpness < infinite_sharpness);
}

void NeighbourhoodWalker::append_fan(int corner) {
    gather_fan(corner);
    std::vector<std::int32_t>& out = result_.signature;
    out.push_back(static_cast<std::int32_t>(fan_.corners.size()));
    out.push_back(fan_.closed ? 1 : 0);
    result_.folded = result_.folded || (fan_.closed && fan_.counter_clockwise == 1);
    out.push_back(fan_.counter_clockwise);
    out.push_back(fan_.clockwise);
    append_sharpness(sharpness_.point[static_cast<std::size_t>(adjacency_.point(corner))]);
    for (const int c : fan_.corners) {
        const int size = adjacency_.size(adjacency_.face(c));
        out.push_back(size);
        append_sharpness(sharpness_.edge[static_cast<std::size_t>(adjacency_.leading_edge(c))]);
        append_sharpness(sharpness_.edge[static_cast<std::size_t>(adjacency_.trailing_edge(c))]);
        for (int k = 1, other = adjacency_.next_corner(c); k < size;
             ++k, other = adjacency_.next_corner(other)) {
            out.push_back(local_number(adjacency_.point(other)));
        }
    }
}

const Neighbourhood& NeighbourhoodWalker::visit(int face, int control_cap) {
    face_ = face;
    result_.signature.clear();
    result_.folded = result_.fading = false;
    result_.regular = gather_regular(face);
    if (result_.regular) {
        return result_;
    }
    result_.controls.clear();
    const int first = adjacency_.first(face), size = adjacency_.size(face);
    for (int i = 0; i < size; ++i) {
        local_number(adjacency_.point(first + i));
    }
    result_.signature.push_back(size);
    for (int i = 0; i < size && static_cast<int>(result_.controls.size()) <= control_cap; ++i) {
        append_fan(first + i);
    }
    return result_;
}

} // namespace razor
