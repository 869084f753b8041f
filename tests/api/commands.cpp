// The library's pictures are the command's, to the last bit.
#ifdef RAZOR_PROGRAM

#include "tests/api/films.h"
#include "tests/program/run.h"

#include "razor/image/exr.h"

#include <functional>

namespace razor {
namespace {

using api::Renderer;
using api::Scene;

class Commands : public ::testing::Test {
protected:
    /// The command's picture, with these arguments, and what its file says of the scene.
    Film command(const std::string& arguments) {
        const Outcome outcome = run(quoted_argument(RAZOR_PROGRAM) + " render " + arguments +
                                        " --threads 2 --quiet -o picture.exr",
                                    folder_.path());
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        attributes_.clear();
        return read_exr(folder_ / "picture.exr", &attributes_);
    }
    void expect_the_command(Renderer& renderer, const std::string& arguments) {
        const Film film = renderer.render();
        const Film expected = command(arguments);
        expect_same_bits(film, expected, arguments);
        EXPECT_EQ(film.window, expected.window);
        renderer.write(folder_ / "library.exr", film);
        ImageAttributes attributes;
        read_exr(folder_ / "library.exr", &attributes);
        EXPECT_EQ(attributes, attributes_) << arguments;
    }
    static std::filesystem::path config(const std::string& name) {
        return std::filesystem::path(RAZOR_SOURCE_DIR) / "configs/scenes" / name;
    }

    TemporaryFolder folder_;
    ImageAttributes attributes_;
};

Scene sized(Scene scene, const std::function<void(Settings&)>& more = {}) {
    Settings settings = scene.settings();
    settings.width = 64;
    settings.height = 48;
    settings.samples = 2;
    if (more)
        more(settings);
    scene.set_settings(settings);
    return scene;
}

TEST_F(Commands, RenderTheBuiltInScene) {
    Renderer renderer(sized(Scene::built_in()), {.threads = 1});
    expect_the_command(renderer, "--size 64x48 --spp 2");
}

TEST_F(Commands, RenderSceneFiles) {
    for (const std::string name : {"materials.toml", "crowd.toml"}) {
        Renderer renderer(sized(Scene::load(config(name)),
                                [](Settings& s) {
                                    s.crop = {16, 16, 32, 32};
                                }),
                          {.threads = 1, .layers = "pick,lod"});
        expect_the_command(renderer, quoted_argument(config(name)) +
                                         " --size 64x48 --spp 2 --crop 16,16,32,32 --layers pick,lod");
    }
}

TEST_F(Commands, RenderModels) {
    const std::filesystem::path model = folder_.file(
        "model.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nv 0.2 1 0.3\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    Scene scene = Scene::load(
        model, {.z_up = true, .floor = false, .scheme = Scheme::bilinear, .width = 64, .height = 48});
    Renderer renderer(sized(scene), {.threads = 1});
    expect_the_command(renderer, "model.obj --up z --no-floor --scheme bilinear --size 64x48 --spp 2");
}

TEST_F(Commands, RenderMomentsOfWhatMoves) {
    Renderer renderer(sized(Scene::load(config("moving.toml"))), {.threads = 1});
    const std::string arguments = quoted_argument(config("moving.toml")) + " --size 64x48 --spp 2 --frame ";
    for (const int frame : {5, 0, 17}) {
        renderer.go_to_frame(frame);
        expect_the_command(renderer, arguments + std::to_string(frame));
    }
}

TEST_F(Commands, RenderPassesWithinMemory) {
    Renderer renderer(sized(Scene::built_in(), [](Settings& s) { s.samples = 8; }),
                      {.threads = 1, .memory_bytes = 64U << 20U, .pass_samples = 4});
    expect_the_command(renderer, "--size 64x48 --spp 8 --progressive --memory 64MiB");
}

} // namespace
} // namespace razor

#endif
