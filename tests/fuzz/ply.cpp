// PLY cages: any bytes are a mesh with sound indices or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/models/ply_reader.h"
#include "tests/fuzz/cage.h"
#include "tests/scene/ply_writer.h"

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

void require_different_neighbours(const razor::Mesh& mesh) {
    std::size_t begin = 0;
    for (const int size : mesh.face_sizes) {
        const std::size_t end = begin + static_cast<std::size_t>(size);
        for (std::size_t c = begin; c < end; ++c)
            fuzz::require(mesh.face_vertices[c] != mesh.face_vertices[c + 1 == end ? begin : c + 1]);
        begin = end;
    }
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        razor::write_ply(two_quads(), razor::PlyEncoding::ascii),
        razor::write_ply(two_quads(), razor::PlyEncoding::little_endian, "\r\n"),
        razor::write_ply(two_quads(), razor::PlyEncoding::big_endian),
        "ply\nformat ascii 1.0\ncomment c\nelement e 1\nproperty list char double a\nelement vertex "
        "3\nproperty "
        "float32 nx\nproperty short x\nproperty uint z\nproperty uchar y\nelement face 1\nproperty int8 "
        "f\nproperty list ushort uint32 vertex_index\nend_header\n2 .5 1\n1 -1 2 3\n1 4 5 6\n1 7 8 9\n0 3 0 "
        "1 "
        "2\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        const razor::Mesh mesh = razor::parse_ply(bytes, "fuzz");
        require_sound(mesh);
        require_different_neighbours(mesh);
    } catch (const razor::UserError& error) {
        require_line(error.what(), "fuzz:");
    }
    return true;
}
