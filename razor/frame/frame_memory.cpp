#include "razor/frame/frame_memory.h"

#include "razor/frame/blend_table.h"
#include "razor/frame/displacement.h"
#include "razor/frame/filter_table.h"
#include "razor/frame/light_records.h"
#include "razor/frame/scratch.h"
#include "razor/frame/sky_record.h"
#include "razor/frame/unit.h"
#include "razor/frame/view.h"
#include "razor/scene/error.h"
#include "razor/scene/graph/records.h"

#include <fmt/core.h>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

namespace razor {
namespace {

/// Numbers of pixels so far apart that pictures of different seeds share no samples (MurmurHash3's
/// finalizer); 0 stays 0.
std::int32_t hashed(int seed) {
    auto h = static_cast<std::uint32_t>(seed);
    h = (h ^ (h >> 16)) * 0x85ebca6bU;
    h = (h ^ (h >> 13)) * 0xc2b2ae35U;
    return static_cast<std::int32_t>(h ^ (h >> 16));
}

} // namespace

int packet_samples_log2(int samples) {
    int log2 = 0;
    while ((2 << log2) < ISA_WIDTH && samples % (2 << log2) == 0)
        ++log2;
    return log2;
}

void Frame::Impl::count_records(const Scene& scene) {
    for (std::size_t m = 0; m < topologies.size(); ++m) {
        const Topology& t = topologies[m];
        first_cluster.push_back(total.clusters);
        first_face.push_back(total.faces);
        total.clusters += clusters_of(m);
        total.faces += t.faces.size();
        total.controls += t.controls.size();
        total.face_curves += t.face_curves.size();
        total.points += t.points.size();
        total.curves += t.curves.size();
    }
    for (const Instance& i : geometry.instances) {
        const Topology& t = topology_of(i);
        patches += static_cast<std::int64_t>(t.patches.size());
        clusters += static_cast<std::int64_t>(clusters_of(static_cast<std::size_t>(i.mesh)));
        undrawn += t.undrawn_faces;
    }
    if (patches == 0)
        throw UserError(fmt::format(
            "{}: no face of the scene is drawn; remove hole tags or boundary interpolation `none`",
            scene.name));
    constexpr std::int64_t most_clusters = most_patches >> refit_log2;
    if (clusters > most_clusters)
        throw UserError(fmt::format("{}: {} patches of {} instances are too many; at most 2^30", scene.name,
                                    patches, geometry.instances.size()));
    // Gathers index coordinates and patch records by signed 32-bit words; all else is counted in records.
    constexpr auto most = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
    if (std::max({total.clusters * refit_patches * (sizeof(PatchRecord) / 4), total.faces * 5, total.controls,
                  total.face_curves, total.points * 3, total.curves}) > most)
        throw UserError(
            fmt::format("{}: the meshes have more faces than can be numbered; leave some out", scene.name));
}

void Frame::Impl::place_scene(const Scene& scene) {
    header = region<FrameHeader>("scene graph", -1, 1);
    new (header) FrameHeader{};
    header->instances.set(region<InstanceRecord>("scene graph", -1, geometry.instances.size()));
    if (!materials.displacements.empty())
        header->displacement_bounds.set(region<float>("scene graph", -1, geometry.instances.size()));
    header->cluster_instance.set(region<std::int32_t>("scene graph", -1, static_cast<std::size_t>(clusters)));
    if (materials.solid)
        header->solids.set(region<SolidRecord>("materials", -1, geometry.instances.size()));
    fill_instances(scene);
    place_materials(scene);
}

void Frame::Impl::fill_instances(const Scene& scene) {
    std::int32_t* cluster_instance = header->cluster_instance.get();
    std::int32_t first_patch = 0;
    if (scene.settings.everything)
        plan.grids = grids_hanging;
    for (std::size_t n = 0; n < geometry.instances.size(); ++n) {
        const Topology& t = topology_of(geometry.instances[n]);
        InstanceRecord& r = header->instances.get()[n];
        r.first_patch = first_patch;
        fill_instance(scene, n);
        cluster_instance = std::fill_n(cluster_instance, r.cluster_count, static_cast<std::int32_t>(n));
        header->patch_count = std::max(header->patch_count, first_patch + r.patch_count);
        first_patch += r.cluster_count << refit_log2;
        for (const PatchRecord& p : t.patches)
            if (p.kind == PatchKind::catmull_clark || p.kind == PatchKind::bilinear)
                plan.grids = grids_hanging;
    }
}

/// All but which patches are the instance's.
void Frame::Impl::fill_instance(const Scene& scene, std::size_t n) {
    const Instance& i = geometry.instances[n];
    const Topology& t = topology_of(i);
    const auto mesh = static_cast<std::size_t>(i.mesh);
    InstanceRecord& r = header->instances.get()[n];
    for (int k = 0; k < 3; ++k) {
        r.origin[k] = i.origin[k];
        r.offset[k] = i.offset[k];
        for (int column = 0; column < 3; ++column)
            r.linear[3 * k + column] = static_cast<float>(i.linear[column][k]);
    }
    r.moved = !i.moved() ? 0 : glm::determinant(i.linear) < 0 ? -1 : 1;
    r.edge_length = static_cast<float>(i.edge_length);
    r.mesh_edge_length = static_cast<float>(i.mesh_edge_length);
    r.first_level = static_cast<std::int32_t>(std::lround(std::log2(i.edge_length)));
    r.max_exponent = t.max_exponent;
    r.mesh = i.mesh;
    r.patch_count = static_cast<std::int32_t>(t.patches.size());
    r.first_cluster = static_cast<std::int32_t>(first_cluster[mesh]);
    r.first_record = r.first_cluster << refit_log2;
    r.cluster_count = static_cast<std::int32_t>(clusters_of(mesh));
    glm::vec3 albedo(0.7F);
    const auto material = static_cast<std::size_t>(i.material);
    if (material < scene.materials.size())
        albedo = scene.materials[material].albedo;
    for (int k = 0; k < 3; ++k)
        r.albedo[k] = albedo[k];
    r.material = i.material;
    if (float* bounds = header->displacement_bounds.get(); bounds != nullptr)
        bounds[n] = static_cast<float>(displacement_bound(scene, i.mesh, i.material) * (1 + 1e-6));
    const int cage = texture_cage_of[mesh];
    r.shading = shading_of(scene, i);
    fill_solid(n);
    if (cage >= 0)
        r.texture_faces = static_cast<std::int32_t>(first_face[static_cast<std::size_t>(cage)]) -
                          static_cast<std::int32_t>(first_face[mesh]);
}

void Frame::Impl::fill_density(const Mesh& mesh, std::size_t number) {
    if (geometry.displacements[number] > 0)
        measure_texture_density(
            mesh, {header->texture_densities.get() + first_face[number], mesh.face_sizes.size()});
}

void Frame::Impl::place_graph() {
    const std::size_t most =
        options.moves ? Hierarchy::node_limit(geometry.instances.size()) : geometry.graph.nodes().size();
    header->graph.set(region<GraphNodeRecord>("scene graph", -1, most));
    fill_graph();
    for (int t = 0; t < trees; ++t)
        opened.push_back(std::make_unique<isa::mark_set>(static_cast<std::int64_t>(most) + clusters));
    // Boxes of clusters: a frame's refit writes them.
    header->cluster_count = static_cast<std::int32_t>(total.clusters);
    header->clusters_stride = (header->cluster_count + 15) & -16;
    header->cluster_boxes.set(
        region<float>("scene graph", -1, static_cast<std::size_t>(header->clusters_stride) * 6));
    header->refit_list.set(region<std::int32_t>("scene graph", -1, total.clusters));
    auto* counts = region<std::int32_t>("scene graph", -1, total.clusters);
    header->cluster_patches.set(counts);
    for (const Topology& t : topologies)
        for (std::size_t left = t.patches.size(); left > 0;) {
            const std::size_t here = std::min<std::size_t>(left, refit_patches);
            *counts++ = static_cast<std::int32_t>(here);
            left -= here;
        }
}

void Frame::Impl::fill_graph() {
    const std::vector<HierarchyNode>& nodes = geometry.graph.nodes();
    const std::vector<std::int32_t> others = geometry.graph.take_touched();
    for (const std::int32_t n : others) {
        GraphNodeRecord& record = header->graph.get()[n];
        record = pack(nodes[static_cast<std::size_t>(n)], geometry.origin);
        if (record.instance >= 0)
            record.child_count = header->instances.get()[record.instance].cluster_count;
    }
    header->graph_count = static_cast<std::int32_t>(nodes.size());
    touched.graph_nodes = static_cast<std::int64_t>(others.size());
}

void Frame::Impl::place_points(const Scene& scene) {
    std::size_t first = 0;
    for (const Topology& t : topologies) {
        first_point.push_back(first);
        first += t.points.size();
    }
    header->points.set(region<float>("control points", -1, total.points * 3));
    if (meshes_at_rest() > 0)
        header->rest_points.set(region<float>("control points", -1, total.points * 3));
    fill_meshes(scene);
    for (std::size_t cage = scene_meshes; cage < meshes.size(); ++cage) {
        float* xyz = header->points.get() + 3 * first_point[cage];
        for (const glm::dvec3& point : meshes[cage].points)
            for (int k = 0; k < 3; ++k)
                *xyz++ = static_cast<float>(point[k]);
    }
}

void Frame::Impl::fill_points(const Scene& scene, std::size_t mesh) {
    fill_density(scene.meshes[mesh], mesh);
    float* xyz = header->points.get() + 3 * first_point[mesh];
    for (const glm::dvec3& point : scene.meshes[mesh].points) {
        const glm::dvec3 p = point - geometry.mesh_origins[mesh];
        for (int k = 0; k < 3; ++k)
            *xyz++ = static_cast<float>(p[k]);
    }
    if (!shades_by_rest[mesh])
        return;
    xyz = header->rest_points.get() + 3 * first_point[mesh];
    for (const glm::dvec3& p : scene.meshes[mesh].rest)
        for (int k = 0; k < 3; ++k)
            *xyz++ = static_cast<float>(p[k]);
}

void Frame::Impl::fill_meshes(const Scene& scene) {
    std::vector<int> all;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        fill_points(scene, m);
        all.push_back(static_cast<int>(m));
    }
    list_clusters(all);
    touched.meshes = static_cast<std::int64_t>(all.size());
}

void Frame::Impl::list_clusters(const std::vector<int>& of_meshes) {
    std::int32_t* list = header->refit_list.get();
    std::vector<std::int32_t> wanted;
    // A frame that was given up has left some undone, and does not say which.
    if (header->queues.get() != nullptr && header->queues.get()->refitted.word != header->refit_count)
        wanted.assign(list, list + header->refit_count);
    for (const int mesh : of_meshes)
        for (std::size_t k = 0; k < clusters_of(static_cast<std::size_t>(mesh)); ++k)
            wanted.push_back(static_cast<std::int32_t>(first_cluster[static_cast<std::size_t>(mesh)] + k));
    std::sort(wanted.begin(), wanted.end());
    wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
    std::copy(wanted.begin(), wanted.end(), list);
    header->refit_count = static_cast<std::int32_t>(wanted.size());
    touched.clusters = header->refit_count;
}

void Frame::Impl::place_topology() {
    auto* patch = region<PatchRecord>("scene graph", -1, total.clusters * refit_patches);
    auto* face = region<FaceRecord>("topology", -1, total.faces);
    auto* control = region<std::int32_t>("topology", -1, total.controls);
    auto* face_curve = region<std::int32_t>("topology", -1, total.face_curves);
    auto* point = region<VertexRecord>("topology", -1, total.points);
    auto* curve = region<CurveRecord>("topology", -1, total.curves);
    auto* classes = region<ClassRecord>("topology", -1, pages->class_count());
    header->patches.set(patch);
    header->faces.set(face);
    header->controls.set(control);
    header->face_curves.set(face_curve);
    header->vertices.set(point);
    header->curves.set(curve);
    header->classes.set(classes);
    // Each mesh numbers from 0: move its numbers behind those of the meshes before.
    int base_face = 0, base_control = 0, base_face_curve = 0, base_point = 0, base_curve = 0, base_class = 0;
    for (std::size_t m = 0; m < topologies.size(); ++m) {
        const Topology& t = topologies[m];
        patch = header->patches.get() + (first_cluster[m] << refit_log2);
        for (PatchRecord p : t.patches) {
            p.mesh = static_cast<int>(m);
            p.face += base_face;
            bool part = (p.side_flags[0] & side_half) != 0;
            for (int& c : p.side_curve)
                c += c >= 0 ? base_curve : 0;
            p.corner[0] += base_point;
            p.corner[1] += part ? base_curve : base_point;
            p.corner[2] += part ? base_face : base_point;
            p.corner[3] += part ? base_curve : base_point;
            *patch++ = p;
        }
        for (FaceRecord f : t.faces) {
            f.face_class += f.face_class >= 0 ? base_class : 0;
            f.control_first += base_control;
            f.curve_first += base_face_curve;
            *face++ = f;
        }
        for (int c : t.controls)
            *control++ = c + base_point;
        for (int c : t.face_curves)
            *face_curve++ = c + base_curve;
        for (VertexRecord v : t.points) {
            v.owner_face += v.owner_face >= 0 ? base_face : 0;
            *point++ = v;
        }
        for (CurveRecord c : t.curves) {
            bool spoke = (c.flags & curve_spoke) != 0;
            c.owner_face += c.owner_face >= 0 ? base_face : 0;
            c.end0 += spoke ? base_curve : base_point;
            c.end1 += spoke ? base_face : base_point;
            *curve++ = c;
        }
        base_face += static_cast<int>(t.faces.size());
        base_control += static_cast<int>(t.controls.size());
        base_face_curve += static_cast<int>(t.face_curves.size());
        base_point += static_cast<int>(t.points.size());
        base_curve += static_cast<int>(t.curves.size());
        base_class += static_cast<int>(t.classes.size());
    }
    auto* entries = region<PageEntry>("topology pages", -1, pages->entry_count());
    pages->lay_out(entries, region<Line>("topology pages", -1, pages->line_count()), classes);
}

void Frame::Impl::place_blend_table() {
    auto* table = region<std::int32_t>("blend table", -1, blend_table_words);
    header->blend_table.set(table);
    fill_blend_table(table);
}

void Frame::Impl::place_view(const Scene& scene) {
    const Settings& s = scene.settings;
    const auto pixels = static_cast<std::size_t>(s.width) * static_cast<std::size_t>(s.height);
    header->film.set(region<float>("frame buffer", -1, pixels * film_planes));
    place_filter(scene);
    if (options.passes) {
        const int planes = header->filter_use == filter_weighted ? weighted_sum_planes : sum_planes;
        for (isa::ref<float>* sums : {&header->sums_before, &header->sums_after})
            sums->set(region<float>("frame buffer", -1, pixels * static_cast<std::size_t>(planes)));
    }
    if (options.tile_passes)
        tile_passes = region<TilePass>("frame buffer", -1, static_cast<std::size_t>(screen_tiles(s)));
    place_lights(scene);
    fill_view(scene);
}

void Frame::Impl::place_filter(const Scene& scene) {
    if (is_pixel(scene.settings.filter))
        return;
    try {
        const FilterTable table = tabulate(scene.settings.filter);
        auto* bins = region<FilterBin>("frame buffer", -1, table.bins.size());
        std::copy(table.bins.begin(), table.bins.end(), bins);
        header->filter_table.set(bins);
        header->filter_use = table.weighted ? filter_weighted : filter_even;
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: {}", scene.name, error.what()));
    }
}

void Frame::Impl::choose_samples(int first, int count) {
    header->first_sample = first;
    header->samples = count;
    header->packet_samples_log2 = packet_samples_log2(count);
    if (options.passes) {
        float* const before = header->sums_before.get();
        header->sums_before.set(header->sums_after.get());
        header->sums_after.set(before);
    }
}

void Frame::Impl::fill_view(const Scene& scene) {
    const Settings& s = scene.settings;
    FrameHeader& h = *header;
    h.sky_samples = 0;
    h.focus = 0;
    put(h.lens_x, glm::dvec3(0));
    put(h.lens_y, glm::dvec3(0));
    h.width = s.width;
    h.height = s.height;
    camera = scene.camera;
    settings = s;
    part = shown_part(s);
    h.first_column = part.x / tile_side;
    h.first_row = part.y / tile_side;
    h.tiles_x = (part.x + part.width + tile_side - 1) / tile_side - h.first_column;
    h.tiles_y = (part.y + part.height + tile_side - 1) / tile_side - h.first_row;
    h.tiles = screen_tiles(s);
    h.stride_log2 = 0;
    while ((h.tiles - 1) >> h.stride_log2 >= most_strides)
        ++h.stride_log2;
    const View v = view_of(scene.camera);
    const FilmExtent film = film_extent(scene.camera, s);
    const double pixel = 2 * film.half_height / s.height;
    put(h.camera, scene.camera.position - geometry.origin);
    h.orthographic = scene.camera.projection == Projection::orthographic ? 1 : 0;
    put(h.film_corner, (h.orthographic != 0 ? glm::dvec3(0) : v.forward) - v.right * film.half_width +
                           v.up * film.half_height);
    put(h.line_of_sight, v.forward);
    put(h.film_x, v.right * pixel);
    put(h.film_y, -v.up * pixel);
    put(h.background, glm::dvec3(scene.sky));
    fill_lights(scene);
    fill_emitters(scene);
    SkyRecord* map = h.sky_map.get();
    const bool dark = map != nullptr && map->rows == 0;
    if (std::max({scene.sky.x, scene.sky.y, scene.sky.z}) > 0 && !dark) {
        h.sky_samples = s.sky_samples;
        const double samples = std::max(s.sky_samples, 1);
        put(h.sky, glm::dvec3(scene.sky) / (map != nullptr ? std::numbers::pi * samples : samples));
    }
    if (map != nullptr)
        map->turn =
            static_cast<float>(scene.sky_map.rotation / 360 - std::floor(scene.sky_map.rotation / 360));
    h.sample_seed = hashed(s.seed);
    h.fixed_target = one_level(s.lod.lod) ? least_target_edge : 0.0F;
    h.morphs = s.lod == Lod::recursive || s.lod == Lod::camera || s.lod == Lod::paper ? 1 : 0;
    h.one_field = s.lod == Lod::camera ? 1 : 0;
    h.leaving_morphs = h.morphs != 0 && h.one_field == 0 ? 1 : 0;
    h.level_choice = s.lod == Lod::patch ? by_patch : s.lod == Lod::paper ? by_stretch : by_leaf;
    const Camera& dicing = dicing_camera(scene);
    const CameraField asked = camera_field(dicing, s);
    put(h.field_origin, dicing.position - geometry.origin);
    h.camera_base = static_cast<float>(asked.base);
    h.camera_growth = static_cast<float>(asked.growth);
    put(h.camera_slope, view_of(dicing).forward * asked.slope);
    if (has_lens(scene.camera)) {
        h.focus = static_cast<float>(focus_distance(scene.camera));
        put(h.lens_x, v.right * scene.camera.aperture_radius);
        put(h.lens_y, v.up * scene.camera.aperture_radius);
    }
    h.sky_spacing = sample_spacing(s, map != nullptr ? 1 : std::numbers::pi, s.sky_samples);
    h.bounces = s.bounces;
    h.diffuse_bounces = s.diffuse_bounces;
    h.lobe_spacing = sample_spacing(s, 1, 1);
    h.reach = static_cast<float>(geometry.reach);
}

bool Frame::Impl::pose(const Scene& scene) {
    index.reset();
    SceneGeometry posed = locate_scene(scene, drawn);
    const auto same_mesh = [](const auto& a, const auto& b) { return a.mesh == b.mesh; };
    if (!std::ranges::equal(posed.instances, geometry.instances, same_mesh) ||
        scene.lights.size() > most_lights)
        return false;
    geometry = std::move(posed);
    fill_instances(scene);
    fill_graph();
    fill_meshes(scene);
    fill_view(scene);
    touched.instances = static_cast<std::int64_t>(geometry.instances.size());
    reset();
    followed = true;
    return true;
}

bool Frame::Impl::follow(const Scene& scene, const SceneChanges& changes) {
    // The unit follows from all instances, and the box that is kept is of those that are drawn.
    if (unit != 1 || scene.lights.size() > most_lights ||
        std::find(drawn.begin(), drawn.end(), false) != drawn.end())
        return false;
    if (!index)
        index.emplace(geometry.flat, drawn_graph(scene.graph, scene.meshes.size()), scene.meshes.size());
    const std::optional<GeometryChanges> others = razor::follow(geometry, *index, scene, changes);
    if (!others || frame_unit(scene, geometry.graph.bounds()) != 1)
        return false;
    for (const std::int32_t n : others->instances)
        fill_instance(scene, static_cast<std::size_t>(n));
    fill_graph();
    for (const int mesh : others->meshes)
        fill_points(scene, static_cast<std::size_t>(mesh));
    list_clusters(others->meshes);
    touched.instances = static_cast<std::int64_t>(others->instances.size());
    touched.meshes = static_cast<std::int64_t>(others->meshes.size());
    fill_view(scene);
    reset();
    followed = true;
    return true;
}

} // namespace razor
