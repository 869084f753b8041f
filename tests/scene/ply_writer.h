// Small PLY files for tests, of any encoding.
#pragma once

#include "razor/scene/models/ply_header.h"
#include "razor/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace razor {

class PlyWriter {
public:
    explicit PlyWriter(PlyEncoding encoding, std::string_view line_end = "\n")
        : encoding_(encoding), line_end_(line_end) {
        constexpr const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        line("ply");
        line(fmt::format("format {} 1.0", names[static_cast<std::size_t>(encoding)]));
    }
    /// Of the header.
    void line(std::string_view text) { header_ += std::string(text) + line_end_; }

    /// The next value of the body; an integer's must be one.
    void put(PlyType type, double value) {
        if (encoding_ == PlyEncoding::ascii) {
            body_ += type == PlyType::float32 ? fmt::format("{} ", static_cast<float>(value))
                                              : fmt::format("{} ", value);
            return;
        }
        const std::uint64_t bits = type == PlyType::float64 ? std::bit_cast<std::uint64_t>(value)
                                   : type == PlyType::float32
                                       ? std::bit_cast<std::uint32_t>(static_cast<float>(value))
                                       : static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
        const std::size_t size = size_of(type);
        for (std::size_t i = 0; i < size; ++i) {
            const std::size_t byte = encoding_ == PlyEncoding::little_endian ? i : size - 1 - i;
            body_ += static_cast<char>(bits >> (8 * byte) & 255);
        }
    }
    /// After the last value of an element.
    void end() {
        if (encoding_ == PlyEncoding::ascii) {
            body_ += line_end_;
        }
    }
    std::string bytes() const { return header_ + "end_header" + line_end_ + body_; }

private:
    PlyEncoding encoding_;
    std::string line_end_, header_, body_;
};

/// A vertex for each corner of the mesh that is other than those before it, in texture coordinates too;
/// points are stored as doubles, indices as integers.
inline std::string write_ply(const Mesh& mesh, PlyEncoding encoding, std::string_view line_end = "\n") {
    const auto at = [](int i) { return static_cast<std::size_t>(i); };
    std::vector<std::pair<int, int>> vertices; // points and texture coordinates, -1: none
    std::vector<int> corners;
    const bool textured = !mesh.face_texcoords.empty();
    for (std::size_t p = 0; p < (textured ? 0 : mesh.points.size()); ++p) {
        vertices.emplace_back(static_cast<int>(p), -1);
    }
    for (std::size_t c = 0; c < mesh.face_vertices.size(); ++c) {
        const std::pair vertex(mesh.face_vertices[c], textured ? mesh.face_texcoords[c] : -1);
        const auto found = std::find(vertices.begin(), vertices.end(), vertex);
        corners.push_back(static_cast<int>(found - vertices.begin()));
        if (found == vertices.end()) {
            vertices.push_back(vertex);
        }
    }
    PlyWriter w(encoding, line_end);
    w.line(fmt::format("element vertex {}", vertices.size()));
    for (const char* name : {"x", "y", "z"}) {
        w.line(fmt::format("property double {}", name));
    }
    if (textured) {
        w.line("property float s");
        w.line("property float t");
    }
    w.line(fmt::format("element face {}", mesh.face_sizes.size()));
    w.line("property list uchar int vertex_indices");
    for (const auto& [point, texcoord] : vertices) {
        for (int axis = 0; axis < 3; ++axis) {
            w.put(PlyType::float64, mesh.points[at(point)][axis]);
        }
        for (int axis = 0; axis < (textured ? 2 : 0); ++axis) {
            w.put(PlyType::float32, double{mesh.texcoords[at(texcoord)][axis]});
        }
        w.end();
    }
    std::size_t c = 0;
    for (const int size : mesh.face_sizes) {
        w.put(PlyType::uint8, size);
        for (int i = 0; i < size; ++i) {
            w.put(PlyType::int32, corners[c++]);
        }
        w.end();
    }
    return w.bytes();
}

} // namespace razor
