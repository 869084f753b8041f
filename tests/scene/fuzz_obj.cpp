// libFuzzer target for the OBJ reader and, of what begins as MD3 does, the MD3 reader: any bytes give a mesh
// with sound indices or a one-line UserError. A run without a corpus starts from the seeds below, through the
// custom mutator.
#include "razor/scene/error.h"
#include "razor/scene/models/md3_reader.h"
#include "razor/scene/models/obj_reader.h"
#include "tests/scene/md3_writer.h"
#include "tests/scene/sound_md3.h"

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

const std::string md3_seed = razor::write_md3(razor::two_surfaces(), 2);
const std::array<std::string_view, 6> seeds{
    md3_seed,
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\nf 1/1/1 2/2 3//1 4\nf -1 -2 -3\n",
    "v 1e3 -.5 +2 1 0 0 0\r\nv 1 2 3 \\\r\n# c\r\nv 3 2 1\rf 1 2 3",
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nt crease 2/1/0 0 1 2.5\nt corner 1/1/0 2 10\nt hole 1/0/0 0\n",
    "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl a # b\nf 1 2 3\nusemtl\nf 1 3 2\nusemtl "
    "a\r\nf 1 2 3\n",
    "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\nt interpolateboundary 1/0/0 1\nt facevaryinginterpolateboundary "
    "1/0/0 2\n"
    "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n",
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
    require(std::all_of(mesh.holes.begin(), mesh.holes.end(), below(mesh.face_sizes.size())));
    for (const razor::Crease& crease : mesh.creases) {
        require(below(mesh.points.size())(crease.v0) && below(mesh.points.size())(crease.v1) &&
                crease.sharpness >= 0);
    }
    for (const razor::Corner& corner : mesh.corners) {
        require(below(mesh.points.size())(corner.vertex) && corner.sharpness >= 0);
    }
    for (const auto& p : mesh.points) {
        require(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
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
    const std::string_view bytes{reinterpret_cast<const char*>(data), size};
    try {
        if (bytes.starts_with("IDP3")) {
            const razor::Md3Model model = razor::parse_md3(bytes, "fuzz");
            require(razor::sound(model));
            check(model.cage);
        } else {
            razor::ObjMaterialNames materials;
            const razor::Mesh mesh = razor::parse_obj(bytes, "fuzz", &materials);
            check(mesh);
            require(mesh.face_materials.empty() || mesh.face_materials.size() == mesh.face_sizes.size());
            for (const int material : mesh.face_materials) {
                require(material >= -1 && material < static_cast<int>(materials.names.size()));
            }
        }
    } catch (const razor::UserError& error) {
        require(std::string_view(error.what()).starts_with("fuzz:"));
        require(std::string_view(error.what()).find_first_of("\n\r") == std::string_view::npos);
    }
    return 0;
}
