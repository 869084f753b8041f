// A scene that was edited is, to the last bit, the edited scene read anew; and what was wrong with an edit is
// said.
#include "tests/api/films.h"

#include "razor/native/render.h"

#include <cmath>
#include <functional>
#include <limits>
#include <utility>

namespace razor {
namespace {

using api::Renderer;
using api::Scene;

/// The film of a renderer that knows of no edits.
Film anew(const Scene& scene, double seconds = 0) {
    Renderer renderer(Scene::parse(scene.toml()), {.threads = 1});
    renderer.go_to(seconds);
    return renderer.render();
}

using Edit = std::pair<const char*, std::function<void(Scene&)>>;

template <class Change> auto settings(Change change) {
    return [change](Scene& scene) {
        Settings s = scene.settings();
        change(s);
        scene.set_settings(s);
    };
}
template <class Change> auto material(std::string_view name, Change change) {
    return [name, change](Scene& scene) {
        for (Material m : std::vector<Material>(scene.materials()))
            if (m.name == name) {
                change(m);
                scene.set_material(m);
            }
    };
}

const std::vector<Edit>& edits() {
    static const std::vector<Edit> all{
        {"object",
         [](Scene& s) {
             s.set_transform("front", {.translate = {0.5, 0, 1}});
         }},
        {"object in a group",
         [](Scene& s) {
             s.set_transform("pair/left", {.rotate = {0, 40, 0}});
         }},
        {"object that moves",
         [](Scene& s) {
             s.set_transform("wheel", {.scale = {2, 1, 1}});
         }},
        {"matrix",
         [](Scene& s) {
             Affine mirror;
             mirror.linear[0] = {-1, 0, 0.25};
             mirror.translation = {0, 0.25, -1};
             s.set_transform("back", {.matrix = mirror});
         }},
        {"another matrix",
         [](Scene& s) {
             Affine turned;
             turned.linear[0] = {0, 1, 0};
             turned.linear[1] = {-1, 0, 0};
             s.set_transform("back", {.matrix = turned});
         }},
        {"camera",
         [](Scene& s) {
             Camera c = s.camera();
             c.position = {2, 2, 7};
             c.fov_degrees = 50;
             s.set_camera(c);
         }},
        {"lens",
         [](Scene& s) {
             Camera c = s.camera();
             c.aperture_radius = 0.2;
             s.set_camera(c);
         }},
        {"orthographic camera",
         [](Scene& s) {
             Camera c = s.camera();
             c.projection = Projection::orthographic;
             c.aperture_radius = 0;
             c.height = 5;
             s.set_camera(c);
         }},
        {"dicing camera",
         [](Scene& s) {
             Camera c;
             c.position = {0, 20, 40};
             s.set_dicing_camera(c);
         }},
        {"light moved",
         [](Scene& s) {
             std::vector<Light> lights = s.lights();
             lights[0].corner = {0, 4, 0};
             lights[0].radiance = {2, 20, 2};
             s.set_lights(lights);
         }},
        {"more lights",
         [](Scene& s) {
             std::vector<Light> lights = s.lights();
             Light spot;
             spot.kind = LightKind::spot;
             spot.position = {0, 6, 3};
             spot.radiance = glm::vec3(80);
             Light sun;
             sun.kind = LightKind::directional;
             sun.direction = {1, -2, -1};
             lights.push_back(spot);
             lights.push_back(sun);
             s.set_lights(lights);
         }},
        {"no light", [](Scene& s) { s.set_lights({}); }},
        {"sky",
         [](Scene& s) {
             s.set_sky({1, 0.2F, 0.1F});
         }},
        {"black sky, one light",
         [](Scene& s) {
             s.set_sky(glm::vec3(0));
             s.set_lights({Light{.corner = {-1, 5, -1}, .radiance = glm::vec3(20)}});
         }},
        {"sky again", [](Scene& s) { s.set_sky(glm::vec3(0.4F)); }},
        {"material", material("stone",
                              [](Material& m) {
                                  m.albedo = {0.1F, 0.7F, 0.1F};
                              })},
        {"glass", material("stone", [](Material& m) { m.specular = m.transmission = 1; })},
        {"new material",
         [](Scene& s) {
             Material m;
             m.name = "chalk";
             m.albedo = glm::vec3(0.9F);
             s.set_material(m);
             s.set_object_material("pair/right", "chalk");
         }},
        {"mesh's material", [](Scene& s) { s.set_mesh_material("gear", "stone"); }},
        {"size", settings([](Settings& s) { s.width = 40; })},
        {"samples and seed", settings([](Settings& s) {
             s.samples = 3;
             s.seed = 5;
         })},
        {"filter", settings([](Settings& s) { s.filter = preset_filter(FilterKind::mitchell); })},
        {"noise threshold", settings([](Settings& s) {
             s.samples = 48;
             s.noise_threshold = 0.1;
         })},
        {"samples everywhere", settings([](Settings& s) {
             s.samples = 2;
             s.noise_threshold = 0;
         })},
        {"crop", settings([](Settings& s) {
             s.crop = {16, 0, 16, 32};
         })}};
    return all;
}

TEST(Edits, AreTheEditedSceneReadAnew) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 2});
    Film before = renderer.render();
    for (const auto& [name, edit] : edits()) {
        edit(renderer.scene());
        const Film& film = renderer.render();
        EXPECT_FALSE(same_beauty(film, before)) << name << " changed nothing";
        expect_same_bits(film, anew(renderer.scene()), name);
        before = film;
    }
}

TEST(Edits, ComeAtAnyMoment) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 2});
    renderer.go_to(0.5);
    const Film half = renderer.render();
    EXPECT_FALSE(same_beauty(half, anew(renderer.scene())));
    expect_same_bits(half, anew(renderer.scene(), 0.5), "half a second");
    renderer.go_to(1);
    renderer.scene().set_transform("front", {.translate = {0.5, 0, 1}});
    expect_same_bits(renderer.render(), anew(renderer.scene(), 1), "one second, moved");
    renderer.go_to_frame(6); // of 24 a second
    EXPECT_TRUE(renderer.scene().is_animated());
    renderer.scene().set_transform("wheel", {});
    EXPECT_FALSE(renderer.scene().is_animated());
    const Film still = renderer.render();
    expect_same_bits(still, anew(renderer.scene(), 0.25), "stands still");
    renderer.go_to(1);
    expect_same_bits(renderer.render(), still, "still stands still");
    renderer.go_to(0.5);
    renderer.scene().set_sky({0, 0, 1});
    renderer.scene().set_transform("front", {});
    renderer.scene().set_transform("front", {.scale = {1, 2, 1}});
    expect_same_bits(renderer.render(), anew(renderer.scene(), 0.5), "several");
    renderer.scene() = Scene::parse(small_scene);
    expect_same_bits(renderer.render(), half, "as it was");
    EXPECT_THROW(renderer.go_to(std::numeric_limits<double>::quiet_NaN()), UserError);
    EXPECT_THROW(renderer.go_to(std::numeric_limits<double>::infinity()), UserError);
    expect_same_bits(renderer.render(), half, "no other moment");
}

TEST(Edits, OfCopiesAreTheirOwn) {
    const Scene original = Scene::parse(small_scene);
    Scene copy = original;
    copy.set_sky(glm::vec3(0));
    EXPECT_EQ(original.sky(), glm::vec3(0.3F, 0.4F, 0.5F));
    Renderer renderer(original, {.threads = 1});
    const Film first = renderer.render();
    renderer.scene() = copy;
    expect_same_bits(renderer.render(), anew(copy), "copy");
    copy = original;
    renderer.scene() = std::move(copy);
    expect_same_bits(renderer.render(), first, "original");
}

TEST(Edits, TouchWhatTheyMoveAlone) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 1});
    renderer.render();
    EXPECT_EQ(renderer.figures().frame.touched.instances, 6);
    EXPECT_GT(renderer.figures().frame.touched.meshes, 0);
    renderer.scene().set_transform("front", {.translate = {0.1, 0, 1}});
    renderer.render();
    EXPECT_EQ(renderer.figures().frame.touched.instances, 2);
    EXPECT_EQ(renderer.figures().frame.touched.meshes, 0);
    renderer.scene().set_sky({1, 1, 1});
    renderer.render();
    EXPECT_EQ(renderer.figures().frame.touched.instances, 0);
}

std::string said(const std::function<void()>& work) {
    try {
        work();
    } catch (const UserError& error) {
        return error.what();
    }
    return "nothing";
}

TEST(Edits, ThatAreWrongAreRefused) {
    Scene scene = Scene::parse(small_scene);
    const std::string before = scene.toml();
    const auto wrong = [&](const std::function<void()>& work) {
        const std::string what = said(work);
        EXPECT_EQ(what.find('\n'), std::string::npos) << what;
        return what;
    };
    EXPECT_EQ(wrong([&] { scene.set_transform("fromt", {}); }),
              "small: there is no object 'fromt'; objects() lists them");
    EXPECT_EQ(wrong([&] {
                  scene.set_transform("front", {.scale = {1, 0, 1}});
              }),
              "small: object 'front': scale flattens it; make it thicker");
    EXPECT_EQ(wrong([&] { scene.set_object_material("front", "gold"); }),
              "small: there is no material 'gold'; set_material() adds one");
    EXPECT_EQ(wrong([&] { scene.set_mesh_material("vase", ""); }),
              "small: there is no mesh 'vase'; meshes() lists them");
    Camera camera;
    camera.fov_degrees = 200;
    EXPECT_EQ(wrong([&] { scene.set_camera(camera); }),
              "small: camera.fov is 200; it must lie between 0.001 and 179");
    camera = {};
    camera.target = camera.position;
    EXPECT_EQ(wrong([&] { scene.set_dicing_camera(camera); }),
              "small: dicing_camera.position equals dicing_camera.target; move one of them");
    Light light;
    light.radiance.y = -1;
    EXPECT_EQ(wrong([&] { scene.set_lights({light}); }),
              "small: light.radiance is -1; it must lie between 0 and 1e+09");
    light = {.edge_u = {1, 0, 0}, .edge_v = {1, 0, 0}};
    EXPECT_NE(wrong([&] { scene.set_lights({light}); }), "nothing");
    EXPECT_EQ(wrong([&] { scene.set_sky(glm::vec3(std::nanf(""))); }),
              "small: sky.radiance is nan; it must lie between 0 and 1e+09");
    Material material;
    EXPECT_EQ(wrong([&] { scene.set_material(material); }), "small: a material without a name; give it one");
    material.name = "stone";
    material.ior = 4;
    EXPECT_EQ(wrong([&] { scene.set_material(material); }),
              "small: material 'stone': ior is 4; it must lie between 1 and 3");
    material.ior = 1.5F;
    material.albedo_map.texture = 1;
    EXPECT_EQ(wrong([&] { scene.set_material(material); }),
              "small: material 'stone': albedo_map is texture number 1, of 1; -1 is none");
    using Change = std::function<void(Settings&)>;
    const auto filter = [](FilterKind kind, double Filter::*parameter, double value) -> Change {
        return [=](Settings& s) {
            s.filter = preset_filter(kind);
            s.filter.*parameter = value;
        };
    };
    const std::vector<std::pair<const char*, Change>> changes{
        {"width", [](Settings& s) { s.width = 0; }},
        {"samples", [](Settings& s) { s.samples = 0; }},
        {"crop",
         [](Settings& s) {
             s.crop = {40, 0, 16, 16};
         }},
        {"settings.filter.sigma is 0; it must lie between 0.01 and 32",
         filter(FilterKind::gaussian, &Filter::sigma, 0)},
        {"settings.filter.b is 2; it must lie between 0 and 1", filter(FilterKind::mitchell, &Filter::b, 2)},
        {"settings.filter.c is nan", filter(FilterKind::mitchell, &Filter::c, std::nan(""))},
        {"settings.filter.tau is 0", filter(FilterKind::lanczos, &Filter::tau, 0)},
        {"lod", [](Settings& s) {
             s.lod = {Lod::recursive, 3};
         }}};
    for (const auto& [what, change] : changes) {
        Settings settings = scene.settings();
        change(settings);
        EXPECT_NE(wrong([&] { scene.set_settings(settings); }).find(what), std::string::npos) << what;
    }
    EXPECT_EQ(scene.toml(), before) << "something was set";
    EXPECT_NE(wrong([&] { Scene::load("none.obj", {.width = 0}); }).find("framing"), std::string::npos);
    EXPECT_EQ(wrong([&] { Scene::load("none.glb", {.crease_angle = -1}); }),
              "framing: crease_angle is -1; it must lie between 0 and 180");
    EXPECT_EQ(wrong([&] { Scene::parse("size = 3", ".", "text"); }).substr(0, 7), "text:1:");
    EXPECT_NE(wrong([&] { Renderer(scene, {.isa = "mmx"}); }), "nothing");
    EXPECT_NE(wrong([&] { Renderer(scene, {.layers = "pik"}); }), "nothing");
    EXPECT_NE(wrong([&] { Renderer(scene, {.threads = -1}); }), "nothing");
}

/// What is wrong as a whole is found where the picture is rendered, and mended there.
TEST(Edits, ThatAreWrongTogetherCanBeMended) {
    Renderer renderer(Scene::parse(small_scene), {.threads = 1});
    renderer.render();
    renderer.scene().set_transform("front", {.scale = {1e10, 1e10, 1e10}, .translate = {0, 0, 8e29}});
    renderer.scene().set_transform("pair/left", {.translate = {1e25, 0, 0}});
    EXPECT_THROW(renderer.render(), UserError);
    EXPECT_THROW(renderer.render(), UserError);
    renderer.scene().set_transform("front", {});
    renderer.scene().set_transform("pair/left", {});
    expect_same_bits(renderer.render(), anew(renderer.scene()), "mended");
}

} // namespace
} // namespace razor
