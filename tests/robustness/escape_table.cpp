// razor-check-table: rays from inside closed meshes, every pair of model, surface, growth, footprint, levels,
// place, size and target. None may escape, and hits are where the surface is by its definition.
#include "razor/check/report.h"
#include "razor/native/targets.h"
#include "razor/scene/framing.h"
#include "razor/scene/words.h"
#include "tests/kernels/cages.h"
#include "tests/robustness/pairwise.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace razor::test {
namespace {

constexpr const char* models[] = {"sphere", "torus", "spot", "female", "frame_000", "frame_011"};
constexpr Scheme schemes[] = {Scheme::catmull_clark, Scheme::bilinear};
constexpr double growths[] = {-1, -0.05, 0, 0.02, 10};
constexpr double bases[] = {1e-30, 0.7, 1.9, 5, 40}; // in finest target edges
constexpr double edges_across[] = {20, 60, 200};     // the model, so that it has 2 to 8 levels
constexpr double offsets[] = {0, 1e3, 1e5, 1e6};     // in units of its scale
constexpr double companions[] = {0, 1e3};            // distance of a second body; 0: none
constexpr double scales[] = {1e-12, 1e-6, 1, 1e6, 1e12};
constexpr const char* targets[] = {"sse4", "avx2", "avx512"}; // other tests hold plain to the bits of avx2

/// Its top turned against its bottom: no side is flat.
Mesh twisted(Mesh mesh) {
    for (glm::dvec3& p : mesh.points)
        if (p.z > 0)
            p = {0.9 * p.x - 0.3 * p.y, 0.3 * p.x + 0.9 * p.y, p.z};
    return mesh;
}

std::optional<Mesh> model(const std::string& name) {
    if (name == "sphere")
        return cube_cage();
    if (name == "torus")
        return stretched(torus_cage(9, 6));
    if (name == "coarse")
        return twisted(cube_cage());
    if (name == "spot")
        return shared_mesh("spot/spot_control_mesh.obj");
    if (name == "female")
        return shared_mesh("makehuman/female_generic.obj");
    return shared_mesh("makehuman_anim/" + name + ".obj");
}

struct Case {
    std::string model;
    Scheme scheme;
    double growth, base, edges, offset, companion, scale;
    std::string target;
};

std::vector<Case> all_cases() {
    const auto n = [](const auto& values) { return static_cast<int>(std::size(values)); };
    std::vector<Case> cases;
    for (const std::vector<int>& c :
         pairwise_cases({n(models), n(schemes), n(growths), n(bases), n(edges_across), n(offsets),
                         n(companions), n(scales), n(targets)}))
        cases.push_back({models[c[0]], schemes[c[1]], growths[c[2]], bases[c[3]], edges_across[c[4]],
                         offsets[c[5]], companions[c[6]], scales[c[7]], targets[c[8]]});
    // Faces of 2048 x 2048 quads, twelve levels. It takes 5 GiB.
    for (const Scheme scheme : schemes)
        cases.push_back({"coarse", scheme, 0.02, 1.9, 4000, 0, 0, 1, "avx2"});
    return cases;
}

void place(Mesh& mesh, double scale, const glm::dvec3& offset) {
    for (glm::dvec3& p : mesh.points)
        p = (p + offset) * scale;
}

/// Written to a file and read again, as models are.
Mesh reread(const Mesh& mesh) {
    const auto path =
        std::filesystem::temp_directory_path() / fmt::format("razor-check-table-{}.obj", getpid());
    {
        std::ofstream out(path);
        for (const glm::dvec3& p : mesh.points)
            out << fmt::format("v {} {} {}\n", p.x, p.y, p.z);
        std::size_t corner = 0;
        for (const int size : mesh.face_sizes) {
            out << 'f';
            for (int i = 0; i < size; ++i)
                out << ' ' << mesh.face_vertices[corner++] + 1;
            out << '\n';
        }
        if (!out.flush())
            throw std::runtime_error(path.string() + ": cannot be written");
    }
    FramingOptions framing;
    framing.floor = false;
    framing.scheme = mesh.scheme;
    Scene scene = build_scene(frame_model(path, framing));
    std::filesystem::remove(path);
    return scene.meshes.at(0);
}

double diagonal(const Mesh& mesh) {
    glm::dvec3 low(1e300), high(-1e300);
    for (const glm::dvec3& p : mesh.points) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return glm::length(high - low);
}

/// Nothing where the model is not there. Very small and very large ones are used as they are, the others are
/// read from a file.
std::optional<Scene> scene_of_case(const Case& c) {
    std::optional<Mesh> mesh = model(c.model);
    if (!mesh)
        return {};
    mesh->scheme = c.scheme;
    const double size = diagonal(*mesh);
    place(*mesh, c.scale / size, glm::dvec3(1, -0.7, 0.3) * c.offset * size);
    const bool extreme = c.scale == std::begin(scales)[0] || c.scale == std::end(scales)[-1];
    Scene scene = scene_of(extreme ? *mesh : reread(*mesh), c.edges);
    if (c.companion > 0) {
        const double unit = diagonal(scene.meshes[0]);
        Mesh other = cube_cage();
        const glm::dvec3 apart = scene.meshes[0].points[0] / unit + glm::dvec3(c.companion, 0, 0);
        place(other, 0.1 * unit, 10.0 * apart);
        other.edge_length = scene.meshes[0].edge_length;
        scene.meshes.push_back(other);
    }
    return scene;
}

bool has(const std::string& target) {
    for (const KernelTable* t : native_targets())
        if (t->name == target)
            return true;
    return false;
}

int main_(int argc, char** argv) {
    CLI::App app{
        "Rays from inside closed meshes: pairs of models, levels of detail, places, sizes and targets. "
        "Exit code 1: some escape, or hit what is not there."};
    check::EscapeOptions options;
    options.rays = 10'000'000;
    options.compared = 100'000;
    std::vector<int> wanted;
    std::string lod_word = "recursive", json_file;
    bool small = false;
    app.add_option("--rays", options.rays, "a case")->check(CLI::Range(1.0, 1e12));
    app.add_option("--compare", options.compared, "hits a case, with the surface by definition");
    app.add_option("--rays-an-origin", options.rays_an_origin)->check(CLI::Range(1, 8192));
    app.add_option("--case", wanted, "only these numbers");
    app.add_option("--lod", lod_word, "recursive, discrete, patch, paper, fixed, ...");
    app.add_option("--json", json_file, "write the table for programs");
    app.add_flag("--small", small, "only models that are made here, at no more than 60 edges across");
    CLI11_PARSE(app, argc, argv);
    Lod lod = Lod::recursive;
    bool known = false;
    for (const auto& [word, value] : lod_words)
        if (word == lod_word) {
            lod = value.lod;
            known = true;
        }
    if (!known)
        throw std::runtime_error("no level of detail is called " + lod_word);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    fmt::print(
        "{:>4} {:<9} {:<8} {:>6} {:>6} {:>6} {:>7} {:>6} {:>6} {:<7} {:>10} {:>8} {:>8} {:>8} {:>7} {:>6} "
        "{:>8}\n",
        "case", "model", "surface", "growth", "base", "edges", "offset", "apart", "scale", "target", "rays",
        "origins", "escapes", "compared", "differ", "worst", "Mrays/s");
    std::int64_t rays = 0, bad = 0, skipped = 0;
    const std::vector<Case> cases = all_cases();
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const Case& c = cases[i];
        if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), static_cast<int>(i)) == wanted.end())
            continue;
        if (small && ((c.model != "sphere" && c.model != "torus") || c.edges > 60))
            continue;
        std::optional<Scene> scene = scene_of_case(c);
        const std::string name =
            fmt::format("{:>4} {:<9} {:<8} {:>6} {:>6.1g} {:>6} {:>7.0g} {:>6.0g} {:>6.0g} {:<7}", i, c.model,
                        word_of(scheme_words, c.scheme), c.growth, c.base, c.edges, c.offset, c.companion,
                        c.scale, c.target);
        if (!scene || !has(c.target)) {
            fmt::print("{} skipped: the {} is not there\n", name, scene ? "target" : "model");
            ++skipped;
            continue;
        }
        scene->settings.lod = lod;
        options.growth = c.growth;
        options.base = c.base;
        options.seed = static_cast<unsigned>(i + 1);
        Frame frame(*scene, {});
        const check::EscapeReport r = check::shoot_from_inside(frame, native_target(c.target), lod, options);
        fmt::print("{} {:>10} {:>8} {:>8} {:>8} {:>7} {:>6.2f} {:>8.3f}\n", name, r.rays, r.origins,
                   r.escapes, r.compared, r.different, r.worst,
                   1e-6 * static_cast<double>(r.rays) / r.seconds);
        if (r.escapes + r.different > 0)
            fmt::print("{}", check::text_of(r));
        std::fflush(stdout);
        nlohmann::ordered_json row{
            {"case", i},          {"model", c.model},     {"surface", word_of(scheme_words, c.scheme)},
            {"growth", c.growth}, {"base", c.base},       {"edges", c.edges},
            {"offset", c.offset}, {"apart", c.companion}, {"scale", c.scale},
            {"target", c.target}};
        row.update(check::json_of(r));
        rows.push_back(row);
        rays += r.rays;
        bad += r.escapes + r.different + (r.origins == 0 ? 1 : 0);
    }
    fmt::print("{} rays in {} cases, {} skipped; {} went wrong\n", rays, rows.size(), skipped, bad);
    if (!json_file.empty()) {
        std::ofstream out(json_file);
        out << rows.dump(2) << '\n';
        if (!out.flush())
            throw std::runtime_error(json_file + ": cannot be written");
    }
    return bad > 0 ? 1 : 0;
}

} // namespace
} // namespace razor::test

int main(int argc, char** argv) {
    try {
        return razor::test::main_(argc, argv);
    } catch (const std::exception& error) {
        fmt::print(stderr, "razor-check-table: {}\n", error.what());
        return 2;
    }
}
