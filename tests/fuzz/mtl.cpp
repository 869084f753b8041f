// Libraries of OBJ materials: any text is materials within their ranges or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/models/mtl_reader.h"
#include "razor/scene/textures/texture_cache.h"
#include "tests/fuzz/target.h"
#include "tests/scene/picture_writer.h"

#include <cmath>

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "newmtl m\nKd 0.5 0.25 0.125\nKs 1 1 1\nNs 96\nillum 2\nNi 1.5\nd 0.5\n",
        "# c\nnewmtl m\r\nKd 0.1 0.2 0.3\nKe 1 2 3\nPr 0.4\nPm 1\nPs 0.3\nPc 1\nPcr 0.1\nmap_Kd -s 1 2 -o "
        "0.5 "
        "p.png\nbump -bm 2 p.png\nillum 7\n",
        "newmtl n\nTr 0.5\nTf 1 0 0\nnewmtl m\nmap_d p.png\nnorm p.png\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    static const File file("fuzz.mtl");
    static const std::vector<std::string> wanted{"m", "n"};
    static const bool drawn = (file.write_beside("p.png", razor::png_of(1, 1, {}, {255, 128, 0})), true);
    require(drawn);
    file.write(bytes);
    try {
        razor::TextureCache textures;
        razor::MtlReader reader(wanted, textures);
        reader.read(file.path());
        const razor::ModelMaterials all = reader.finish();
        require(all.materials.size() <= wanted.size());
        for (const razor::Material& m : all.materials) {
            require(m.albedo.x >= 0 && m.albedo.y >= 0 && m.albedo.z >= 0);
            require(std::isfinite(m.roughness) && m.roughness >= 0 && m.roughness <= 1);
            require(std::isfinite(m.ior) && m.ior > 0);
        }
    } catch (const razor::UserError& error) {
        require_line(error.what(), file.path());
    }
    return true;
}
