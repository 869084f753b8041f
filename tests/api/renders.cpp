// Rendering by the library: cancelled and begun again, told of, in passes, on several threads.
#include "tests/api/films.h"

#include "razor/api/layers.h"
#include "razor/image/exr.h"
#include "razor/scene/description.h"
#include "tests/scene/temporary_folder.h"

#include <glm/common.hpp>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

namespace razor {
namespace {

using api::Renderer;
using api::Scene;

Scene slow_scene() {
    Scene scene = Scene::parse(small_scene);
    Settings settings = scene.settings();
    settings.width = settings.height = 160;
    settings.samples = 24;
    scene.set_settings(settings);
    return scene;
}
void make_fast(Scene& scene) {
    Settings settings = scene.settings();
    settings.width = settings.height = 48;
    settings.samples = 4;
    scene.set_settings(settings);
}

TEST(Renders, CanBeCancelledFromAnotherThread) {
    for (const int pass_samples : {0, 4}) {
        Renderer renderer(slow_scene(), {.threads = 2, .pass_samples = pass_samples});
        std::atomic<bool> cancel{false}, begun{false};
        const std::jthread other([&] {
            begun.wait(false);
            cancel = true;
        });
        const auto progress = [&](double fraction) {
            EXPECT_GE(fraction, 0);
            EXPECT_LE(fraction, 1);
            if (fraction > 0) {
                begun = true;
                begun.notify_one();
            }
        };
        EXPECT_THROW(renderer.render({.progress = progress, .cancel = &cancel}), Cancelled);
        EXPECT_THROW(renderer.statistics(), std::logic_error) << "of no picture";
        EXPECT_THROW(renderer.render({.cancel = &cancel}), Cancelled) << "the flag is still set";
        // The very frame that was left half-way, then others.
        Renderer fresh(renderer.scene(), {.threads = 1, .pass_samples = pass_samples});
        expect_same_bits(renderer.render(), fresh.render(), "again");
        make_fast(renderer.scene());
        make_fast(fresh.scene());
        expect_same_bits(renderer.render(), fresh.render(), "small");
    }
}

TEST(Renders, TellOfPasses) {
    Scene scene = Scene::parse(small_scene);
    make_fast(scene);
    Renderer renderer(scene, {.threads = 1, .pass_samples = 2});
    const TemporaryFolder folder;
    EXPECT_THROW(renderer.write(folder / "none.exr", Film(1, 1)), std::logic_error) << "no picture was begun";
    int told = 0;
    Film last;
    const auto passed = [&](const Film& film, const PassFigures& figures) {
        EXPECT_EQ(figures.samples, 2 * ++told);
        last = film;
        EXPECT_EQ(renderer.attributes(figures).back(),
                  (std::pair<std::string, std::string>("razor.samples", std::to_string(2 * told))));
        renderer.write(folder / "a.exr", film);
        ImageAttributes attributes;
        expect_same_bits(read_exr(folder / "a.exr", &attributes), film, "file");
        EXPECT_TRUE(std::ranges::is_permutation(attributes, renderer.attributes(figures)));
        renderer.write(folder / "a.png", film);
        EXPECT_TRUE(std::filesystem::exists(folder / "a.png"));
        EXPECT_EQ(renderer.instances().size(), 6U);
        EXPECT_THROW(renderer.statistics(), std::logic_error) << "of no picture yet";
        EXPECT_THROW(renderer.statistics_json(), std::logic_error);
    };
    const Film& film = renderer.render({.passed = passed});
    EXPECT_EQ(told, 2);
    renderer.write(folder / "last.exr", film);
    EXPECT_EQ(renderer.statistics().passes.samples, 4);
    expect_same_bits(film, last, "last pass");
    EXPECT_THROW(Renderer(scene, {.layers = "pick", .pass_samples = 2}), UserError);
}

TEST(Renders, HaveNoTimeForPassesThatAreNotTaken) {
    Scene scene = Scene::parse(small_scene);
    make_fast(scene);
    Renderer renderer(scene, {.threads = 1, .pass_seconds = 100});
    EXPECT_THROW(renderer.render(), UserError);
    Settings settings = scene.settings();
    settings.samples = 32;
    settings.noise_threshold = 10;
    renderer.scene().set_settings(settings);
    EXPECT_GT(renderer.render().width, 0);
    EXPECT_GT(renderer.statistics().passes.samples, 0);
}

TEST(Renders, TakeSamplesForAnError) {
    Scene scene = Scene::parse(small_scene);
    make_fast(scene);
    Renderer renderer(scene, {.threads = 1, .target_error = 0.05});
    const Film first = renderer.render();
    const PassFigures figures = renderer.statistics().passes;
    EXPECT_EQ(figures.target, 0.05);
    EXPECT_GT(figures.target_error, 0);
    EXPECT_LE(figures.target_error, 0.05);
    expect_same_bits(renderer.render(), first, "again");
    EXPECT_THROW(Renderer(scene, {.layers = "pick", .target_error = 0.05}), UserError);
    for (const double wrong : {-1.0, 1e-9, 1e9, std::nan("")})
        EXPECT_THROW(Renderer(scene, {.target_error = wrong}), UserError);
}

TEST(Renders, AreIndependentOfEachOther) {
    const Scene scene = Scene::parse(small_scene);
    Renderer alone(scene, {.threads = 1});
    const Film expected = alone.render();
    std::vector<Film> films(4);
    {
        std::vector<std::jthread> threads;
        for (Film& film : films)
            threads.emplace_back([&scene, &film] {
                Renderer renderer(scene, {.threads = 2, .share = 1});
                renderer.render();
                film = renderer.render(); // again, nothing changed
            });
    }
    for (const Film& film : films)
        expect_same_bits(film, expected, "at once");
}

TEST(Renders, HaveLayersAsTheirFilesDo) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 2, .layers = "pick,lod"});
    const Film film = renderer.render();
    const TemporaryFolder folder;
    renderer.write(folder / "a.exr", film);
    ImageAttributes attributes;
    expect_same_bits(read_exr(folder / "a.exr", &attributes), film, "file");
    EXPECT_EQ(attributes, (ImageAttributes{{"razor.isa", renderer.statistics().isa},
                                           {"razor.scene", renderer.scene_text()},
                                           {"razor.version", std::string(api::version())}}));

    // Names of what pixels show: what vanishes where it is taken away.
    const std::vector<std::string> instances = renderer.instances(), meshes = renderer.scene().meshes();
    EXPECT_EQ(instances, (std::vector<std::string>{"floor", "wheel", "front/left", "front/right", "back/left",
                                                   "back/right"}));
    Renderer other(renderer.scene(), {.threads = 2, .layers = "pick"});
    other.scene().set_transform("wheel", {.translate = {0, 1000, 0}});
    const Film without = other.render();
    int wheel = 0;
    for (std::size_t i = 0; i < film.pixel_count(); ++i) {
        const std::uint32_t instance = film.find("pick.instance")->ids[i],
                            mesh = film.find("pick.mesh")->ids[i];
        const bool shows = instance != no_id && instances.at(static_cast<std::size_t>(instance)) == "wheel";
        EXPECT_EQ(shows, mesh != no_id && meshes.at(static_cast<std::size_t>(mesh)) == "gear");
        EXPECT_EQ(shows, without.find("pick.instance")->ids[i] != instance) << i;
        wheel += shows ? 1 : 0;
    }
    EXPECT_GT(wheel, 20);

    const std::string plane = api::plane_name("layer", "lod");
    EXPECT_EQ(plane, "lod.level");
    const ValueRange range = api::plane_range(film, plane);
    EXPECT_LT(range.low, range.high);
    const Film colours = api::in_colours(film, plane);
    expect_same_bits(colours, api::in_colours(film, plane, range), "range");
    const Film names = api::in_colours(film, "pick.instance");
    for (std::size_t i = 0; i < film.pixel_count(); ++i) { // black is nothing
        EXPECT_EQ(colours.find("G")->values[i] == 0, film.find(plane)->values[i] > 1e30F);
        EXPECT_EQ(names.find("G")->values[i] == 0, film.find("pick.instance")->ids[i] == no_id);
    }
    EXPECT_THROW(api::plane_name("layer", "lot"), UserError);
    EXPECT_THROW(api::in_colours(film, "kd.depth"), std::invalid_argument);
}

/// Where each object of an OBJ file lies: the least and the largest of its points.
std::map<std::string, std::pair<glm::dvec3, glm::dvec3>> boxes_of(const std::filesystem::path& file) {
    std::map<std::string, std::pair<glm::dvec3, glm::dvec3>> boxes;
    std::ifstream text(file);
    std::string line, name;
    while (std::getline(text, line)) {
        std::istringstream words(line);
        std::string kind;
        words >> kind;
        glm::dvec3 p;
        if (kind == "o") {
            words >> name;
            boxes[name] = {glm::dvec3(1e30), glm::dvec3(-1e30)};
        } else if (kind == "v" && words >> p.x >> p.y >> p.z) {
            boxes[name] = {glm::min(boxes[name].first, p), glm::max(boxes[name].second, p)};
        }
    }
    return boxes;
}

TEST(Renders, WriteMeshesAsTheyAreEditedAndAtTheirMoment) {
    const TemporaryFolder folder;
    Renderer renderer(Scene::parse(small_scene), {.threads = 1});
    const api::MeshFigures written = renderer.write_mesh(folder / "a.obj");
    const auto before = boxes_of(folder / "a.obj");
    EXPECT_EQ(before.size(), 6U) << "instances";
    EXPECT_THROW(renderer.statistics(), std::logic_error) << "no picture was rendered";

    const Scene again = Scene::load(folder / "a.obj", {.floor = false, .scheme = Scheme::bilinear});
    std::size_t faces = 0, points = 0;
    for (const MeshDescription& mesh : again.description().meshes) {
        faces += mesh.cage->face_sizes.size();
        points += mesh.cage->points.size();
    }
    EXPECT_EQ(static_cast<long long>(faces), written.faces);
    EXPECT_EQ(static_cast<long long>(points), written.points);

    renderer.scene().set_transform("back", {.translate = {0, 0.5, -1.5}});
    renderer.go_to(0.5); // the gear has turned by 45 degrees about z
    renderer.write_mesh(folder / "b.obj");
    const auto after = boxes_of(folder / "b.obj");
    EXPECT_EQ(after.at("floor"), before.at("floor"));
    for (const char* name : {"pawn.3", "pawn.4"}) {
        EXPECT_NEAR(after.at(name).first.y, before.at(name).first.y + 0.5, 1e-2) << name;
        EXPECT_NEAR(after.at(name).second.y, before.at(name).second.y + 0.5, 1e-2) << name;
    }
    EXPECT_NE(after.at("gear"), before.at("gear"));
    EXPECT_THROW(renderer.write_mesh(folder / "a.ply"), UserError);
    EXPECT_THROW(renderer.write_mesh(folder / "none/a.obj"), UserError);
}

TEST(Renders, TellWhatTheyTook) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 2});
    EXPECT_THROW(renderer.statistics(), std::logic_error);
    renderer.render();
    const api::Statistics s = renderer.statistics();
    EXPECT_EQ(s.threads, 2);
    EXPECT_EQ(s.instances, 6);
    EXPECT_GT(s.rays, 48 * 32 * 2);
    EXPECT_GT(s.patches_opened, 0);
    EXPECT_LE(s.patches_opened, s.patches);
    EXPECT_GT(s.blocks, 0);
    EXPECT_GT(s.grid_bytes, 0);
    EXPECT_GT(s.render_seconds, 0);
    EXPECT_NE(s.plan.find("reflecting"), std::string::npos) << s.plan;
    EXPECT_NE(renderer.statistics_json().find("\"rays\""), std::string::npos);
}

} // namespace
} // namespace razor
