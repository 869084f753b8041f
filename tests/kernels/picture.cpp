// picture SCENE.toml WIDTH HEIGHT SAMPLES LOD THREADS MIB OUT.exr: what `razor render` renders of it with
// --size, --spp,
// --lod, --threads and --memory (0 MiB: no bound), by the best target there is; without what `razor` needs
// besides, so that builds for other widths and under sanitizers are quick.
#include "razor/image/output.h"
#include "razor/native/render.h"
#include "razor/scene/scene_file.h"
#include "razor/scene/words.h"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

int main(int argc, char** argv) {
    using namespace razor;
    if (argc != 9) {
        std::fputs("usage: picture SCENE.toml WIDTH HEIGHT SAMPLES LOD THREADS MIB OUT.exr\n", stderr);
        return 2;
    }
    try {
        Scene scene = load_scene(argv[1]);
        scene.settings.width = std::stoi(argv[2]);
        scene.settings.height = std::stoi(argv[3]);
        scene.settings.samples = std::stoi(argv[4]);
        const auto* const word = std::find_if(lod_words.begin(), lod_words.end(),
                                              [&](const auto& w) { return w.first == argv[5]; });
        if (word == lod_words.end())
            throw std::runtime_error(std::string("unknown level of detail ") + argv[5]);
        scene.settings.lod = word->second;
        RenderOptions options;
        options.threads = std::stoi(argv[6]);
        options.memory_bytes = std::stoull(argv[7]) << 20U;
        write_image(argv[8], render_native(scene, options).film, {});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "picture: %s\n", error.what());
        return 2;
    }
}
