// Renders a scene, and the same scene again after it was edited or has moved: what needs no new analysis
// keeps the one it has. One renderer is used by one thread at a time; different ones are independent.
//
//     razor::api::Renderer renderer(razor::api::Scene::load("scene.toml"));
//     const razor::Film& film = renderer.render();
//     renderer.write("picture.exr", film);
//     renderer.scene().set_transform("cup", {.translate = {0, 1, 0}});
//     renderer.write("moved.exr", renderer.render());
//
// Every picture is, bit for bit, the one that a new renderer would make of the scene as it is then, and does
// not depend on threads.
#pragma once

#include "razor/api/scene.h"
#include "razor/image/image.h"
#include "razor/image/tone.h"
#include "razor/native/render_calls.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace razor {
struct RenderOptions;
struct RenderStatistics;
} // namespace razor

namespace razor::api {

/// Of this library: "0.1.0".
std::string_view version();

struct Options {
    int threads = 0;                // 0: one a processor
    std::string isa = "auto";       // plain, sse4, avx2, avx512; auto: the best this processor has
    int share = 0;                  // how many threads share one kd-tree; 0: all
    std::uint64_t memory_bytes = 0; // what the frame builds may take at a time; 0: no bound
    /// Groups of layers, such as "pick,lod": their planes are added to films (razor/survey/layers.h).
    std::string layers{};
    /// Samples are taken in passes of so many; 0: in one go. For a time: see PassOptions::seconds.
    int pass_samples = 0;
    double pass_seconds = 0; // of pictures without passes render() refuses it
    /// Not 0: samples are taken in passes until the picture's relative error, by noise alone, is estimated to
    /// be no more (razor/native/target_sampling.h), or pass_seconds are over. Levels of detail are the
    /// scene's.
    double target_error = 0;
};

/// Of the last picture. All there is: Renderer::statistics_json().
struct Statistics {
    std::string isa, plan; // which kernels ran
    int threads = 0;
    double load_seconds = 0;   // analysis of the scene, or of what was edited in it
    double render_seconds = 0; // the picture alone
    std::int64_t rays = 0, instances = 0, patches = 0, patches_opened = 0, blocks = 0;
    std::int64_t grid_bytes = 0, node_bytes = 0, list_bytes = 0; // what was built
    PassFigures passes;                                          // where there were any
};

/// What a mesh's file holds.
struct MeshFigures {
    long long points = 0, faces = 0;
};

class Renderer {
public:
    /// Nothing is analysed before the first picture. Throws UserError for options that are not possible.
    explicit Renderer(Scene scene, const Options& options = {});
    /// With all that this project's programs can ask for (razor/native/render.h). `again`: it is rendered,
    /// edited or posed more than once.
    Renderer(Scene scene, const RenderOptions& options, bool again);
    Renderer(Renderer&& other) noexcept;
    Renderer& operator=(Renderer&& other) noexcept;
    ~Renderer();

    /// What is edited here is seen in the next picture. Cameras, lights, light of the sky and objects'
    /// transforms are posed anew; whatever else is edited has the scene analysed anew.
    Scene& scene();
    const Scene& scene() const;
    /// The moment of the next picture, counted from the scene's beginning; 0 unless set. Throws UserError
    /// where it is not finite.
    void go_to(double seconds);
    void go_to_frame(int frame);

    /// The picture: planes R, G, B (linear radiance), normal.X ..., depth.Z, albedo.R ... (see make_film()),
    /// and those of the layers asked for. It stays as it is until the next one is rendered. Throws UserError,
    /// and Cancelled; after either, and after edits, it may be called again. What `calls` calls must not
    /// throw.
    const Film& render(const RenderCalls& calls = {});

    /// Writes what the next picture would see of all surfaces, also of those that are hidden, cut as finely
    /// as its camera asks for: an .obj with normals, an object for each instance, points in world
    /// coordinates. The file is whole or not there. Throws UserError.
    MeshFigures write_mesh(const std::filesystem::path& file) const;

    // Of the last picture, also while its passes are told:
    /// The scene file of that moment.
    std::string scene_text() const;
    /// What pictures' files say of it: version, scene, instruction set, samples taken in passes.
    ImageAttributes attributes(const PassFigures& passes = {}) const;
    /// Writes it, or what was made of it, with its attributes: .exr with all planes, or .png, which alone
    /// `tone` is of. The file is whole or not there. Throws UserError.
    void write(const std::filesystem::path& file, const Film& film, const Tone& tone = {}) const;
    /// What the numbers of the layer pick.instance name: "group/object", the way down to each.
    std::vector<std::string> instances() const;

    // Of the last picture, once render() has returned it; earlier they throw std::logic_error. Of a pass that
    // is told, what `passed` is given is all there is.
    Statistics statistics() const;
    /// What `razor render --stats` writes of it: every figure by name.
    std::string statistics_json() const;

    // For this project's programs.
    const RenderOptions& options() const;
    const RenderStatistics& figures() const;
    const razor::Scene& posed() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace razor::api
