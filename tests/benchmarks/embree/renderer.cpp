#include "tests/benchmarks/embree/renderer.h"

#include "razor/frame/layout.h"
#include "razor/frame/scene_geometry.h"
#include "razor/frame/unit.h"
#include "razor/scene/error.h"
#include "tests/benchmarks/embree/deviation.h"
#include "tests/benchmarks/embree/embree_scenes.h"
#include "tests/benchmarks/embree/grid_mesh.h"
#include "tests/benchmarks/embree/levels.h"
#include "tests/benchmarks/embree/parallel.h"
#include "tests/benchmarks/embree/tessellation.h"
#include "tests/benchmarks/embree/view.h"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <map>

namespace razor::baseline {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point begin) {
    return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// What depends on a mesh's topology, and its grids at the levels asked for so far.
struct MeshTables {
    Mesh mesh;
    Topology topology;
    int coarsest; // level
    std::unique_ptr<PageMaker> pages;
    std::map<int, std::unique_ptr<GridMesh>> levels;

    explicit MeshTables(const Mesh& m)
        : mesh(m), topology(analyse_topology(mesh)), coarsest(coarsest_level(topology)) {
        if (mesh.scheme == Scheme::catmull_clark)
            pages = std::make_unique<PageMaker>(mesh, topology);
    }
    const GridMesh& at(int level) {
        std::unique_ptr<GridMesh>& grid = levels[level];
        if (!grid)
            grid = std::make_unique<GridMesh>(make_grid_mesh(topology, pages.get(), level));
        return *grid;
    }
};

/// Vertices of one tessellation.
struct Part {
    const GridMesh* grid = nullptr;
    std::vector<float> points;       // of the control points
    std::int64_t first_vertex = 0;   // of all
    std::int32_t first_quad = 0;     // of all
    std::vector<std::size_t> placed; // instances that it is drawn by; one, which is in it, if flattened
    bool flattened = false;
};

std::array<double, 9> cofactors(const glm::dmat3& m) {
    const glm::dvec3 rows[3] = {
        {m[0][0], m[1][0], m[2][0]}, {m[0][1], m[1][1], m[2][1]}, {m[0][2], m[1][2], m[2][2]}};
    std::array<double, 9> c{};
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 row = glm::cross(rows[(k + 1) % 3], rows[(k + 2) % 3]);
        for (int i = 0; i < 3; ++i)
            c[3 * k + static_cast<std::size_t>(i)] = row[i];
    }
    return c;
}

} // namespace

struct Renderer::Impl {
    Options options;
    const Kernels& kernels;
    EmbreeScenes scenes;
    std::vector<std::unique_ptr<MeshTables>> meshes;
    std::vector<std::array<double, finest_level + 1>> deviations; // of meshes, if asked for
    std::vector<std::int32_t> quads;                              // of all grids in use
    std::map<const GridMesh*, std::int32_t> first_quad;
    std::vector<float> positions, normals;
    std::vector<Part> parts;
    std::vector<Piece> pieces;

    explicit Impl(const Options& o)
        : options(o), kernels(choose_kernels(o.isa)), scenes(o.threads, o.quality) {}

    void prepare(const Scene& scene) {
        bool same = scene.meshes.size() == meshes.size();
        for (std::size_t m = 0; same && m < meshes.size(); ++m)
            same = same_topology(scene.meshes[m], meshes[m]->mesh, 1);
        if (same)
            return;
        meshes.clear();
        deviations.clear();
        quads.clear();
        first_quad.clear();
        for (const Mesh& mesh : scene.meshes) {
            validate_mesh(mesh);
            const MeshTables& made = *meshes.emplace_back(std::make_unique<MeshTables>(mesh));
            if (options.levels == Levels::deviation)
                deviations.push_back(baseline::deviations(made.topology, made.pages.get(), mesh.points));
        }
    }

    std::vector<int> choose_levels(const Scene& scene, const SceneGeometry& geometry) const {
        if (options.levels == Levels::uniform)
            return std::vector<int>(geometry.instances.size(), std::clamp(options.finer, 0, finest_level));
        if (options.levels == Levels::deviation)
            return levels_by_deviation(geometry, deviations, options.finer);
        return levels_of(scene, geometry, options.finer);
    }

    /// Which tessellations there are, and what draws them.
    void plan(const SceneGeometry& geometry, const std::vector<int>& levels) {
        std::map<std::pair<int, int>, std::vector<std::size_t>> users; // of mesh and level
        for (std::size_t i = 0; i < geometry.instances.size(); ++i)
            users[{geometry.instances[i].mesh,
                   std::max(levels[i], mesh(geometry.instances[i].mesh).coarsest)}]
                .push_back(i);
        std::int64_t all = 0;
        std::vector<bool> flattened;
        for (const auto& [key, instances] : users) {
            const auto count = static_cast<std::int64_t>(instances.size());
            const std::int64_t triangles = triangles_at(mesh(key.first).topology, key.second);
            flattened.push_back(count == 1 || triangles * count <= options.flatten);
            all += triangles * (flattened.back() ? count : 1);
        }
        if (all > options.most_triangles)
            throw UserError(
                fmt::format("{} triangles are more than --most-triangles {}; take a coarser level", all,
                            options.most_triangles));
        parts.clear();
        std::size_t user = 0;
        for (const auto& [key, instances] : users) {
            const bool flat = flattened[user++];
            if (mesh(key.first).topology.patches.empty())
                continue;
            const GridMesh& grid = mesh(key.first).at(key.second);
            if (flat)
                for (const std::size_t i : instances)
                    parts.push_back({&grid, {}, 0, 0, {i}, true});
            else
                parts.push_back({&grid, {}, 0, 0, instances, false});
        }
        for (Part& part : parts) {
            const auto [at, fresh] =
                first_quad.try_emplace(part.grid, static_cast<std::int32_t>(quads.size() / 4));
            if (fresh)
                quads.insert(quads.end(), part.grid->quads.begin(), part.grid->quads.end());
            part.first_quad = at->second;
        }
    }
    MeshTables& mesh(int number) { return *meshes[static_cast<std::size_t>(number)]; }

    /// Control points of the parts, pieces of the top scene, and room for vertices.
    void place(const Scene& scene, const SceneGeometry& geometry) {
        std::int64_t vertices = 0;
        for (Part& part : parts) {
            part.first_vertex = vertices;
            vertices += part.grid->vertices;
        }
        // Embree reads four floats at a time.
        positions.resize(static_cast<std::size_t>(3 * vertices + 1));
        normals.resize(static_cast<std::size_t>(3 * vertices + 1));
        pieces.clear();
        for (Part& part : parts) {
            const Instance& first = geometry.instances[part.placed.front()];
            const auto mesh = static_cast<std::size_t>(first.mesh);
            const std::vector<glm::dvec3>& points = scene.meshes[mesh].points;
            part.points.resize(3 * points.size());
            const glm::dvec3 shift = glm::dvec3(first.origin) + glm::dvec3(first.offset);
            for (std::size_t n = 0; n < points.size(); ++n) {
                glm::dvec3 p = points[n] - geometry.mesh_origins[mesh];
                if (part.flattened)
                    p = first.linear * p + shift;
                for (int k = 0; k < 3; ++k)
                    part.points[3 * n + static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
            }
            for (const std::size_t i : part.placed)
                add_piece(scene, geometry.instances[i], part);
        }
    }

    void add_piece(const Scene& scene, const Instance& instance, const Part& part) {
        Piece& p = pieces.emplace_back();
        p.first_quad = part.first_quad;
        p.first_vertex = static_cast<std::int32_t>(part.first_vertex);
        p.moved = part.flattened ? 0 : 1;
        const std::array<double, 9> turned = cofactors(instance.linear);
        for (int k = 0; k < 3; ++k) {
            for (int c = 0; c < 3; ++c) {
                p.linear[3 * k + c] = static_cast<float>(instance.linear[c][k]);
                p.cofactors[3 * k + c] = static_cast<float>(turned[static_cast<std::size_t>(3 * k + c)]);
            }
            p.shift[k] = static_cast<float>(static_cast<double>(instance.origin[k]) +
                                            static_cast<double>(instance.offset[k]));
        }
        glm::vec3 albedo(0.7F);
        const auto material = static_cast<std::size_t>(instance.material);
        if (material < scene.materials.size())
            albedo = scene.materials[material].albedo;
        for (int k = 0; k < 3; ++k)
            p.albedo[k] = albedo[k];
    }

    void make_vertices() {
        std::vector<Tessellation> all;
        for (const Part& part : parts)
            all.push_back({part.grid, part.points.data(), positions.data() + 3 * part.first_vertex,
                           normals.data() + 3 * part.first_vertex});
        tessellate(all, kernels, options.threads);
    }

    void build() {
        std::vector<Geometry> geometries;
        std::size_t piece = 0;
        for (const Part& part : parts) {
            geometries.push_back({positions.data(), 12 * static_cast<std::size_t>(part.first_vertex),
                                  static_cast<std::size_t>(part.grid->vertices), quads.data(),
                                  16 * static_cast<std::size_t>(part.first_quad),
                                  static_cast<std::size_t>(part.grid->quad_count()), !part.flattened,
                                  std::span(pieces).subspan(piece, part.placed.size())});
            piece += part.placed.size();
        }
        scenes.build(geometries);
    }

    RayCounts trace(const Scene& scene, const SceneGeometry& geometry, std::vector<float>& film) {
        const FrameView view = view_of_scene(scene, geometry.origin);
        const std::vector<LightSource> lights = lights_of_scene(scene, geometry.origin);
        const RenderArguments arguments{scenes.top(),   &view,
                                        lights.data(),  static_cast<int>(lights.size()),
                                        pieces.data(),  positions.data(),
                                        normals.data(), quads.data(),
                                        film.data()};
        const auto along = [](int pixels) { return (pixels + tile_side - 1) / tile_side; };
        std::vector<RayCounts> counts(static_cast<std::size_t>(options.threads));
        share_out(options.threads, along(view.width) * along(view.height), [&](int tile, int thread) {
            kernels.render_tile(arguments, tile, counts[static_cast<std::size_t>(thread)]);
        });
        RayCounts sum;
        for (const RayCounts& c : counts) {
            sum.camera += c.camera;
            sum.light += c.light;
            sum.sky += c.sky;
            sum.hits += c.hits;
        }
        return sum;
    }
};

Renderer::Renderer(const Options& options) : impl_(std::make_unique<Impl>(options)) {}
Renderer::~Renderer() = default;

Film Renderer::render(Scene scene, Report& report) {
    Impl& r = *impl_;
    scene.settings.lod = r.options.levels == Levels::mesh ? Lod::fixed : Lod::object;
    if (frame_unit(scene) != 1)
        throw UserError(
            fmt::format("{}: the baseline renders scenes of 2^-10 to 2^20 units only", scene.name));
    Seconds& s = report.seconds = {};
    auto begin = Clock::now();
    r.prepare(scene);
    s.topology = seconds_since(begin);

    std::clock_t processor = std::clock();
    begin = Clock::now();
    std::vector<bool> drawn;
    for (const auto& mesh : r.meshes)
        drawn.push_back(!mesh->topology.patches.empty());
    const SceneGeometry geometry = locate_scene(scene, drawn);
    const std::vector<int> levels = r.choose_levels(scene, geometry);
    s.place = seconds_since(begin);
    std::clock_t spent = std::clock() - processor;

    begin = Clock::now();
    r.plan(geometry, levels);
    s.topology += seconds_since(begin);

    processor = std::clock();
    begin = Clock::now();
    r.place(scene, geometry);
    s.place += seconds_since(begin);
    begin = Clock::now();
    r.make_vertices();
    s.tessellate = seconds_since(begin);
    begin = Clock::now();
    r.build();
    s.build = seconds_since(begin);
    begin = Clock::now();
    std::vector<float> planes(static_cast<std::size_t>(scene.settings.width) *
                              static_cast<std::size_t>(scene.settings.height) * film_planes);
    report.rays = r.trace(scene, geometry, planes);
    s.trace = seconds_since(begin);
    spent += std::clock() - processor;
    s.processor = static_cast<double>(spent) / CLOCKS_PER_SEC;

    report.triangles = report.instanced_triangles = report.topology_bytes = 0;
    for (const Part& part : r.parts) {
        report.triangles += part.grid->triangles;
        report.instanced_triangles += part.grid->triangles * static_cast<std::int64_t>(part.placed.size());
    }
    for (const auto& [grid, first] : r.first_quad)
        report.topology_bytes += grid->bytes();
    report.grid_meshes = static_cast<std::int64_t>(r.first_quad.size());
    report.pieces = static_cast<std::int64_t>(r.pieces.size());
    report.bvh_bytes = r.scenes.bytes();
    report.vertex_bytes = static_cast<std::int64_t>((r.positions.size() + r.normals.size()) * sizeof(float));

    Film film = make_film(scene.settings.width, scene.settings.height);
    const float* from = planes.data();
    for (Plane& plane : film.planes) {
        std::copy_n(from, film.pixel_count(), plane.values.begin());
        from += film.pixel_count();
    }
    return film;
}

} // namespace razor::baseline
