// libFuzzer target for the PLY reader: any bytes give a mesh with sound indices or a one-line UserError. A
// run without a corpus starts from the seeds below, through the custom mutator.
#include "razor/scene/error.h"
#include "razor/scene/models/ply_reader.h"
#include "tests/scene/ply_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

razor::Mesh two_quads() {
    razor::Mesh mesh;
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}, {2, 1, 0.5}};
    mesh.face_sizes = {4, 4};
    mesh.face_vertices = {0, 1, 2, 3, 1, 4, 5, 2};
    mesh.texcoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0.5F, 0.25F}};
    mesh.face_texcoords = {0, 1, 2, 3, 4, 1, 2, 3};
    return mesh;
}

const std::array<std::string, 4> seeds{
    razor::write_ply(two_quads(), razor::PlyEncoding::ascii),
    razor::write_ply(two_quads(), razor::PlyEncoding::little_endian, "\r\n"),
    razor::write_ply(two_quads(), razor::PlyEncoding::big_endian),
    "ply\nformat ascii 1.0\ncomment c\nelement e 1\nproperty list char double a\nelement vertex 3\nproperty "
    "float32 nx\nproperty short x\nproperty uint z\nproperty uchar y\nelement face 1\nproperty int8 "
    "f\nproperty list ushort uint32 vertex_index\nend_header\n2 .5 1\n1 -1 2 3\n1 4 5 6\n1 7 8 9\n0 3 0 1 "
    "2\n",
};

void require(bool condition) {
    if (!condition) {
        std::abort();
    }
}

void check(const razor::Mesh& mesh) {
    std::size_t corners = 0;
    for (const int size : mesh.face_sizes) {
        require(size >= 3);
        corners += static_cast<std::size_t>(size);
    }
    require(!mesh.face_sizes.empty() && corners == mesh.face_vertices.size());
    require(mesh.face_texcoords.empty() || mesh.face_texcoords.size() == corners);
    const auto below = [](std::size_t count) {
        return [count](int index) { return index >= 0 && static_cast<std::size_t>(index) < count; };
    };
    require(std::all_of(mesh.face_vertices.begin(), mesh.face_vertices.end(), below(mesh.points.size())));
    require(
        std::all_of(mesh.face_texcoords.begin(), mesh.face_texcoords.end(), below(mesh.texcoords.size())));
    std::size_t begin = 0;
    for (const int size : mesh.face_sizes) {
        for (std::size_t c = begin; c < begin + static_cast<std::size_t>(size); ++c) {
            const std::size_t next = c + 1 == begin + static_cast<std::size_t>(size) ? begin : c + 1;
            require(mesh.face_vertices[c] != mesh.face_vertices[next]);
        }
        begin += static_cast<std::size_t>(size);
    }
    for (const auto& p : mesh.points) {
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
    for (const auto& uv : mesh.texcoords) {
        require(std::isfinite(uv.x) && std::isfinite(uv.y));
    }
}

} // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    if (size <= 1 || seed % 512 == 0) {
        const std::string_view text = seeds[seed / 512 % seeds.size()];
        size = std::min(text.size(), max_size);
        std::memcpy(data, text.data(), size);
    }
    return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        check(razor::parse_ply({reinterpret_cast<const char*>(data), size}, "fuzz"));
    } catch (const razor::UserError& error) {
        require(std::string_view(error.what()).starts_with("fuzz:"));
        require(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
    }
    return 0;
}
