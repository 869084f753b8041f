// Materials, textures, displacement and the sky's map in frame memory.
#include "razor/frame/frame_memory.h"

#include "razor/frame/displacement.h"
#include "razor/frame/light_records.h"
#include "razor/frame/scratch.h"
#include "razor/frame/sky_distribution.h"
#include "razor/frame/sky_record.h"
#include "razor/scene/mesh_error.h"
#include "razor/scene/textures/shared_exponent.h"
#include "razor/surface/texture_cage.h"

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

/// Calls visit(m) with the number of each of the scene's materials that the instance has, once or more often.
template <class Visit> void each_material(const Scene& scene, const Instance& i, const Visit& visit) {
    const auto known = [&](int m) {
        if (m >= 0 && static_cast<std::size_t>(m) < scene.materials.size())
            visit(static_cast<std::size_t>(m));
    };
    if (i.material >= 0)
        return known(i.material);
    for (const int material : scene.meshes[static_cast<std::size_t>(i.mesh)].face_materials)
        known(material);
}

/// " (1 of 2 faces, from face 1 on)"; nothing where one material is everybody's.
std::string faces_of(const Mesh& mesh, const Instance& i, std::size_t material) {
    const auto& faces = mesh.face_materials;
    const auto first = std::find(faces.begin(), faces.end(), static_cast<int>(material));
    if (i.material >= 0 || first == faces.end())
        return "";
    return fmt::format(" ({} of {} faces, from face {} on)", std::count(first, faces.end(), *first),
                       faces.size(), first - faces.begin());
}

/// What takes an instance's own coordinates to its mesh's. Of what has collapsed there is none: all zeros.
SolidRecord solid_record(const Instance& i, const glm::dvec3& mesh_origin) {
    SolidRecord r{};
    const double volume = glm::determinant(i.linear);
    const glm::dmat3 back = glm::inverse(i.linear);
    const glm::dvec3 shift = mesh_origin - back * glm::dvec3(i.offset);
    if (!std::isnormal(volume) || !std::isfinite(glm::dot(shift, shift)))
        return r;
    for (int k = 0; k < 3; ++k) {
        for (int column = 0; column < 3; ++column)
            r.row[k][column] = static_cast<float>(back[column][k]);
        r.row[k][3] = static_cast<float>(shift[k]);
    }
    r.shrink = static_cast<float>(1 / std::cbrt(std::abs(volume)));
    return r;
}

} // namespace

void Frame::Impl::fill_solid(std::size_t n) {
    const Instance& i = geometry.instances[n];
    if (SolidRecord* solids = header->solids.get())
        solids[n] = solid_record(i, geometry.mesh_origins[static_cast<std::size_t>(i.mesh)]);
}

int Frame::Impl::map_bits_of(const Instance& i) const {
    return i.material < 0 ? face_map_bits[static_cast<std::size_t>(i.mesh)]
                          : materials.map_bits[static_cast<std::size_t>(i.material)];
}

std::int32_t Frame::Impl::shading_of(const Scene& scene, const Instance& i) const {
    const auto mesh = static_cast<std::size_t>(i.mesh);
    int bits = scene.settings.shading == Shading::hits ? 0 : map_bits_of(i), arrays = 0;
    if ((bits >> map_bump & 1) != 0)
        bits |= 1 << map_normal;
    for (int map = 0; map < map_count; ++map)
        arrays += (bits >> map & 1) != 0 ? shaded_arrays(map) : 0;
    return pack_shading(shades_by_texture[mesh], shades_by_rest[mesh], arrays, bits);
}

void Frame::Impl::take_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    bool by_face = false;
    for (const Instance& i : geometry.instances) {
        by_face = by_face || i.material < 0;
        each_material(scene, i, [&](std::size_t m) { used[m] = true; });
    }
    materials = tabulate_materials(scene, used, by_face);
    for (const Mesh& mesh : scene.meshes) {
        face_map_bits.push_back(0);
        for (const int m : mesh.face_materials)
            face_map_bits.back() |= materials.map_bits[static_cast<std::size_t>(m)];
    }
    std::vector<bool> diced(scene_meshes, false);
    for (const Instance& i : geometry.instances) {
        const auto mesh = static_cast<std::size_t>(i.mesh);
        if (scene.settings.shading == Shading::diced && map_bits_of(i) != 0 && !diced[mesh]) {
            diced[mesh] = true;
            topologies[mesh] = analyse_topology(scene.meshes[mesh], Cut::diced);
        }
    }
    texture_cage_of.assign(scene_meshes, -1);
    shades_by_texture.assign(scene_meshes, false);
    shades_by_rest.assign(scene_meshes, false);
    for (const Instance& i : geometry.instances) {
        const auto mesh = static_cast<std::size_t>(i.mesh);
        const Mesh& own = scene.meshes[mesh];
        std::size_t textured = used.size();
        each_material(scene, i, [&](std::size_t m) {
            if (materials.needs_texcoords[m] || materials.displaced[m])
                textured = m;
            if (materials.needs_texcoords[m])
                shades_by_texture[mesh] = true;
            if (materials.needs_points[m])
                shades_by_rest[mesh] = !own.rest.empty();
        });
        if (textured == used.size() || texture_cage_of[mesh] >= 0)
            continue;
        if (own.face_texcoords.empty())
            throw MeshError(
                own.name,
                fmt::format("mesh '{}': it has no texture coordinates, but its material '{}'{} has a "
                            "texture; give it another material or a mesh with coordinates",
                            own.name, scene.materials[textured].name, faces_of(own, i, textured)));
        texture_cage_of[mesh] = static_cast<int>(meshes.size());
        meshes.push_back(texture_cage(own));
        const bool displaced = geometry.displacements[mesh] > 0;
        topologies.push_back(analyse_texture_cage(own, meshes.back(), displaced));
        if (displaced)
            topologies[mesh] = analyse_topology(own, Cut::displaced);
        topologies[mesh].max_exponent =
            std::min(topologies[mesh].max_exponent, topologies.back().max_exponent);
    }
}

void Frame::Impl::place_materials(const Scene& scene) {
    plan.look = materials.look;
    header->cutouts = materials.cutouts ? 1 : 0;
    header->one_sided = materials.one_sided ? 1 : 0;
    int arrays = 0;
    for (const Instance& i : geometry.instances) {
        const std::int32_t shading = shading_of(scene, i);
        arrays = std::max(arrays, shaded_arrays_in(shading) + rest_arrays(shading));
    }
    header->slot_floats = slot_floats(meshes.size() > scene_meshes, arrays);
    if (plan.look == look_matte && !materials.one_sided && materials.displacements.empty())
        return;
    const auto copy = [&](const auto& table, auto& to, const char* structure) {
        using Record = typename std::remove_reference_t<decltype(table)>::value_type;
        if (table.empty())
            return;
        auto* records = region<Record>(structure, -1, table.size());
        std::copy(table.begin(), table.end(), records);
        to.set(records);
    };
    copy(materials.materials, header->materials, "materials");
    copy(materials.maps, header->maps, "materials");
    copy(materials.textures, header->textures, "materials");
    header->sheens = materials.sheens;
    if (materials.sheens != sheen_none) {
        copy(materials.sheen_records, header->sheen_records, "materials");
        copy(materials.sheen_albedo, header->sheen_albedo, "materials");
    }
    copy(materials.displacements, header->displacements, "materials");
    if (materials.texels > 0) {
        auto* texel = region<std::int32_t>("textures", -1, materials.texels);
        header->texels.set(texel);
        for (const std::vector<std::uint32_t>* words : materials.words) {
            std::memcpy(texel, words->data(), words->size() * sizeof(std::int32_t));
            texel += words->size();
        }
    }
    place_sky(scene);
    place_displacement();
    const auto by_face = [](const Instance& i) { return i.material < 0; };
    if (std::any_of(geometry.instances.begin(), geometry.instances.end(), by_face)) {
        auto* of_faces = region<std::int32_t>("materials", -1, total.faces);
        header->face_materials.set(of_faces);
        for (std::size_t m = 0; m < scene_meshes; ++m)
            std::copy(scene.meshes[m].face_materials.begin(), scene.meshes[m].face_materials.end(),
                      of_faces + first_face[m]);
    }
}

void Frame::Impl::place_displacement() {
    if (materials.displacements.empty())
        return;
    auto* of_clusters = region<float>("scene graph", -1, total.clusters);
    header->cluster_displacements.set(of_clusters);
    for (std::size_t m = 0; m < scene_meshes; ++m)
        std::fill_n(of_clusters + first_cluster[m], clusters_of(m),
                    static_cast<float>(geometry.displacements[m] * (1 + 1e-6)));
    header->texture_densities.set(region<float>("materials", -1, total.faces));
}

void Frame::Impl::place_sky(const Scene& scene) {
    if (materials.sky_map < 0)
        return;
    const Texture& texture = scene.textures[static_cast<std::size_t>(scene.sky_map.texture)];
    const SkyDistribution d = sky_distribution(*texture.pyramid);
    const auto copy = [&](const std::vector<float>& sums, isa::ref<float>& to) {
        auto* words = region<float>("textures", -1, sums.size());
        std::copy(sums.begin(), sums.end(), words);
        to.set(words);
    };
    const auto step = [](int count) {
        return count < 2 ? 0 : static_cast<std::int32_t>(std::bit_floor(static_cast<unsigned>(count - 1)));
    };
    auto* sky = new (region<SkyRecord>("textures", -1, 1)) SkyRecord{};
    sky->map = materials.sky_map;
    sky->columns = d.columns;
    sky->rows = d.rows;
    sky->column_step = step(d.columns);
    sky->row_step = step(d.rows);
    copy(d.heights, sky->heights);
    copy(d.row_sums, sky->row_sums);
    copy(d.cell_sums, sky->cell_sums);
    copy(d.row_density, sky->row_density);
    header->sky_map.set(sky);
}

} // namespace razor
