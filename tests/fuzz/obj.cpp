// OBJ cages: any bytes are a mesh with sound indices or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/models/obj_reader.h"
#include "tests/fuzz/cage.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 1 0\nvn 0 0 1\nf 1/1/1 2/2 3/1/1 4/2\nf -1 -2 -3\n",
        "v 1e3 -.5 +2 1 0 0 0\r\nv 1 2 3 \\\r\n# c\r\nv 3 2 1\rf 1 2 3",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nt crease 2/1/0 0 1 2.5\nt corner 1/1/0 2 10\nt hole 1/0/0 0\n",
        "mtllib a b.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nusemtl a # b\nf 1 2 3\nusemtl\nf 1 3 2\nusemtl "
        "a\r\nf 1 2 3\n",
        "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 1 1 0\nt interpolateboundary 1/0/0 1\nt facevaryinginterpolateboundary "
        "1/0/0 2\n"
        "t creasemethod 0/0/1 chaikin\nt smoothtriangles 0/0/1 smooth\n"};
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        razor::ObjMaterialNames materials;
        const razor::Mesh mesh = razor::parse_obj(bytes, "fuzz", &materials);
        require_sound(mesh);
        require(mesh.face_materials.empty() || mesh.face_materials.size() == mesh.face_sizes.size());
        for (const int material : mesh.face_materials)
            require(material >= -1 && material < static_cast<int>(materials.names.size()));
    } catch (const razor::UserError& error) {
        require_line(error.what(), "fuzz:");
    }
    return true;
}
