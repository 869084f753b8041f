// turntable SCENE PICTURES [FRAMES]: a scene or model from all sides, while what moves in it does, to
// turn_0.png, turn_1.png, ... and the depths and meshes of the last in colours, into the folder PICTURES.
// Ctrl-C, or a key's line on a terminal, ends it between two whole files.
#include <razor/api/layers.h>
#include <razor/api/renderer.h>

#include <glm/gtc/matrix_transform.hpp>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <numbers>
#include <thread>
#include <unistd.h>

namespace {

std::atomic<bool> interrupted{false};

/// How many pixels show each mesh, by name, from two layers of a film.
void print_meshes(const razor::api::Renderer& renderer, const razor::Film& film) {
    const std::vector<std::string> names = renderer.scene().meshes();
    const std::vector<std::uint32_t>& mesh = film.find("pick.mesh")->ids;
    const std::vector<float>& level = film.find("lod.level")->values;
    struct Seen {
        int pixels = 0;
        double levels = 0;
    };
    std::map<std::string, Seen> seen;
    for (std::size_t p = 0; p < film.pixel_count(); ++p)
        if (mesh[p] < names.size()) {
            Seen& s = seen[names[mesh[p]]];
            ++s.pixels;
            s.levels += double{level[p]};
        }
    for (const auto& [name, s] : seen)
        std::printf("%s: %d pixels, of level %.1f in the mean\n", name.c_str(), s.pixels,
                    s.levels / s.pixels);
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 3) {
        std::fprintf(stderr, "usage: turntable SCENE PICTURES [FRAMES]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[2];
    const int frames = argc > 3 ? std::atoi(argv[3]) : 8;
    std::signal(SIGINT, [](int) { interrupted = true; });
    if (isatty(STDIN_FILENO) != 0) // a frame that is being rendered stops, whatever thread says so
        std::thread([] {
            std::getchar();
            interrupted = true;
        }).detach();
    try {
        razor::api::Scene scene = razor::api::Scene::load(argv[1], {.width = 160, .height = 120});
        razor::Settings settings = scene.settings();
        settings.width = 160;
        settings.height = 120;
        scene.set_settings(settings);
        const razor::Camera first = scene.camera();

        razor::api::Renderer renderer(scene, {.layers = "pick,lod"});
        for (int frame = 0; frame < frames; ++frame) {
            const double angle = 2 * std::numbers::pi * frame / frames;
            const glm::dmat4 turn = glm::rotate(glm::dmat4(1), angle, glm::normalize(first.up));
            razor::Camera camera = first;
            camera.position = first.target + glm::dvec3(turn * glm::dvec4(first.position - first.target, 0));
            renderer.scene().set_camera(camera);
            renderer.go_to_frame(frame);

            const razor::Film& film = renderer.render({.cancel = &interrupted});
            renderer.write(folder / ("turn_" + std::to_string(frame) + ".png"), film, {.exposure = 0.5F});
            if (frame + 1 == frames) {
                for (const auto& [name, plane] : {std::pair("depths", "depth.Z"), {"meshes", "pick.mesh"}})
                    renderer.write(folder / (std::string(name) + ".png"),
                                   razor::api::in_colours(film, plane));
                print_meshes(renderer, film);
            }
            const razor::api::Statistics figures = renderer.statistics();
            std::printf("frame %d: %.2f s, %.1f million rays, %lld of %lld patches opened\n", frame,
                        figures.render_seconds, static_cast<double>(figures.rays) / 1e6,
                        static_cast<long long>(figures.patches_opened),
                        static_cast<long long>(figures.patches));
        }
    } catch (const razor::UserError& error) { // one line: place, cause, mend
        std::fprintf(stderr, "turntable: %s\n", error.what());
        return 2;
    } catch (const razor::Cancelled&) {
        return 130;
    }
    return 0;
}
