// Scene files: any text is a scene that prints as one which reads back the same, or one clear line.
#include "razor/scene/error.h"
#include "razor/scene/scene_file.h"
#include "tests/fuzz/target.h"

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "[settings]\nsize = [9, 7]\nsamples = 2\nbounces = 1\nlod = \"patch\"\n[film]\nfilter = "
        "\"gaussian\"\n"
        "radius = [1.5, 1]\n[camera]\nposition = [0, 2, 7]\ntarget = [0, 0.8, 0]\nfov = 40\n[sky]\nradiance "
        "= "
        "0.4\n"
        "[[mesh]]\nshape = \"gear\"\n",
        "[animation]\nrate = 12\n[camera]\nposition = [0, 2, 7]\ninterpolation = \"smooth\"\n[[camera.key]]\n"
        "time = 0\nposition = [0, 2, 7]\n[[camera.key]]\ntime = 2\nposition = [3, 3, 7]\n[[light]]\n"
        "corner = [-2, 5, -1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, 2]\nradiance = 9\n[[light.key]]\ntime = "
        "0\n"
        "corner = [-2, 5, -1]\n[[light.key]]\ntime = 2\ncorner = [2, 5, -1]\n[[mesh]]\nshape = \"pawn\"\n"
        "[[mesh.deform]]\nkind = \"bend\"\ndirection = [1, 0, 0]\namount = 12\nperiod = 1\n",
        "[[material]]\nname = \"a\"\nalbedo = [0.7, 0.2, 0.1]\nmetallic = 0.5\nroughness = 0.3\n"
        "[[material]]\nname = \"b\"\nkind = \"glass\"\nior = 1.4\n[[mesh]]\nname = \"m\"\nshape = \"box\"\n"
        "material = \"a\"\nscale = [1, 2, 3]\nrotate = [10, 20, 30]\n[mesh.parameters]\nwidth = 0.97\n"
        "sharpness = 2.5\n[[group]]\nname = \"g\"\n[[group.object]]\nmesh = \"m\"\narray = [2, 1, 2]\n"
        "spacing = [1, 0, 1]\n[[object]]\ngroup = \"g\"\ntranslate = [1e3, 0, -1e-3]\n",
        "[[light]]\nkind = \"sphere\"\nposition = [0, 3, 0]\nradius = 0.25\nradiance = [1, 2, 3]\n[[light]]\n"
        "kind = \"point\"\nposition = [0, 3, 0]\nintensity = 4\n[[light]]\nkind = \"directional\"\n"
        "direction = [0, -1, 0]\nirradiance = 1\n[[mesh]]\nname = \"p\"\nshape = \"plane\"\nscheme = "
        "\"bilinear\"\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    // Models that a text names are not there, whatever it names.
    static const File nowhere("scene.toml");
    try {
        const razor::SceneDescription scene = razor::parse_scene_file(bytes, "fuzz", nowhere.folder());
        const std::string printed = razor::to_toml(scene);
        require(razor::to_toml(razor::parse_scene_file(printed, "again", nowhere.folder())) == printed);
    } catch (const razor::UserError& error) {
        require_line(error.what());
    }
    return true;
}
