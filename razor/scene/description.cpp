#include "razor/scene/description.h"

#include "razor/scene/attachment.h"
#include "razor/scene/error.h"
#include "razor/scene/material_fields.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

namespace razor {
namespace {

glm::dvec3 rotated(glm::dvec3 p, int axis, double degrees) {
    const auto [c, s] = cos_sin_degrees(degrees);
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    const double pu = p[u];
    const double pv = p[v];
    p[u] = c * pu - s * pv;
    p[v] = s * pu + c * pv;
    return p;
}

int material_index(const SceneDescription& description, std::string_view name) {
    const auto material = std::find_if(description.materials.begin(), description.materials.end(),
                                       [&](const Material& m) { return m.name == name; });
    return static_cast<int>(std::distance(description.materials.begin(), material));
}

/// For each material of the mesh's file what replaces it, -1: nothing; or none at all.
std::vector<int> replaced_materials(const SceneDescription& description, const MeshDescription& mesh) {
    if (mesh.materials.empty()) {
        return {};
    }
    const ModelMaterials& own = *mesh.source->own_materials;
    std::vector<std::string> names;
    for (const Material& material : own.materials) {
        names.push_back(material.name);
    }
    std::vector<int> result(names.size(), -1);
    for (const std::vector<std::string>& called : {names, own.parts}) { // a part is only its own material's
        for (const auto& [name, replacement] : mesh.materials) {
            for (std::size_t m = 0; m < called.size(); ++m) {
                if (called[m] == name) {
                    result[m] = material_index(description, replacement);
                }
            }
        }
    }
    return result;
}

std::vector<glm::dvec3> placed(const MeshDescription& mesh, const std::vector<glm::dvec3>& points) {
    std::vector<glm::dvec3> result;
    result.reserve(points.size());
    for (const glm::dvec3& point : points) {
        glm::dvec3 p = mesh.scale * point;
        for (int axis = 0; axis < 3; ++axis) {
            if (mesh.rotate[axis] != 0) {
                p = rotated(p, axis, mesh.rotate[axis]);
            }
        }
        result.push_back(mesh.translate + p);
    }
    return result;
}

/// Where the materials and textures of the models' files are in the scene: behind its own, those of each file
/// once.
class OwnMaterials {
public:
    struct Place {
        std::shared_ptr<const ModelMaterials> own;
        int material = 0, texture = 0; // the first of them
    };

    explicit OwnMaterials(const SceneDescription& description) {
        auto material = static_cast<int>(description.materials.size());
        auto texture = static_cast<int>(description.textures.size());
        for (const MeshDescription& mesh : description.meshes) {
            if (!uses_own(mesh) || find(*mesh.source->own_materials) != nullptr) {
                continue;
            }
            const ModelMaterials& own = *mesh.source->own_materials;
            places_.push_back({mesh.source->own_materials, material, texture});
            material += static_cast<int>(own.materials.size());
            texture += static_cast<int>(own.textures.size());
        }
    }

    static bool uses_own(const MeshDescription& mesh) {
        return mesh.material.empty() && mesh.source->own_materials != nullptr;
    }

    const Place* find(const ModelMaterials& own) const {
        const auto found =
            std::find_if(places_.begin(), places_.end(), [&](const Place& p) { return p.own.get() == &own; });
        return found == places_.end() ? nullptr : &*found;
    }

    void append_to(Scene& scene) const {
        for (const Place& place : places_) {
            scene.textures.insert(scene.textures.end(), place.own->textures.begin(),
                                  place.own->textures.end());
            for (Material material : place.own->materials) {
                visit_material_maps(
                    [&](std::string_view, TextureMap& map) {
                        map.texture += map.texture < 0 ? 0 : place.texture;
                    },
                    material);
                scene.materials.push_back(std::move(material));
            }
        }
    }

    /// Rewrites the indices of a mesh that has its own. `instead`: of each of these another one of the scene,
    /// or -1; may be empty.
    void place(Mesh& mesh, const std::vector<int>& instead) const {
        const int first = find(*mesh.own_materials)->material;
        const auto in_scene = [&](int own) {
            const int other = own < 0 || instead.empty() ? -1 : instead[static_cast<std::size_t>(own)];
            return own < 0 ? 0 : other >= 0 ? other : first + own;
        };
        mesh.material = in_scene(mesh.material);
        std::transform(mesh.face_materials.begin(), mesh.face_materials.end(), mesh.face_materials.begin(),
                       in_scene);
    }

private:
    std::vector<Place> places_;
};

class GraphBuilder {
public:
    explicit GraphBuilder(const SceneDescription& description) : description_(description) {
        for (std::size_t m = 0; m < description.meshes.size(); ++m) {
            meshes_.try_emplace(description.meshes[m].name, static_cast<int>(m));
            files_.try_emplace(description.meshes[m].file, static_cast<int>(m));
        }
        for (std::size_t g = 0; g < description.groups.size(); ++g) {
            groups_.try_emplace(description.groups[g].name, static_cast<int>(g) + 1);
        }
        placed_.resize(description.meshes.size());
    }

    SceneGraph build() {
        if (description_.objects.empty() && description_.groups.empty()) {
            return {};
        }
        graph_.groups.resize(description_.groups.size() + 1);
        graph_.groups[0] = {"scene", {}};
        for (std::size_t g = 0; g < description_.groups.size(); ++g) {
            graph_.groups[g + 1].name = description_.groups[g].name;
            add_objects(g + 1, description_.groups[g].objects);
        }
        add_objects(0, description_.objects);
        std::vector<Placement> root;
        for (std::size_t m = 0; m < placed_.size(); ++m) {
            if (!placed_[m]) {
                root.push_back(
                    {.name = description_.meshes[m].name, .mesh = static_cast<int>(m), .local = {}});
            }
        }
        std::vector<Placement>& objects = graph_.groups[0].placements;
        root.insert(root.end(), std::make_move_iterator(objects.begin()),
                    std::make_move_iterator(objects.end()));
        objects = std::move(root);
        return std::move(graph_);
    }

private:
    using Names = std::unordered_map<std::string, int>;

    static int find(const Names& names, const std::string& name, std::string_view kind) {
        const auto found = names.find(name);
        if (found == names.end()) {
            throw UserError(fmt::format("an object places the {} '{}', which does not exist; add it", kind,
                                        printable(name)));
        }
        return found->second;
    }

    int place_mesh(int mesh) {
        placed_[static_cast<std::size_t>(mesh)] = true;
        return mesh;
    }

    void add_objects(std::size_t group, const std::vector<ObjectDescription>& objects) {
        for (std::size_t o = 0; o < objects.size(); ++o) {
            const ObjectDescription& object = objects[o];
            Placement placement{.name = object.name,
                                .local = stated_place(description_, objects, o),
                                .copies = object.copies,
                                .spacing = object.spacing,
                                .level_offset = object.level_offset,
                                .rate = object.rate};
            if (!object.material.empty()) {
                placement.material = material_index(description_, object.material);
            }
            if (object.table) {
                placement.group = add_table(object);
            } else if (!object.group.empty()) {
                placement.group = find(groups_, object.group, "group");
            } else {
                placement.mesh = place_mesh(find(meshes_, object.mesh, "mesh"));
            }
            graph_.groups[group].placements.push_back(std::move(placement));
        }
    }

    /// A group of the table's rows; one a table, however often it is placed.
    int add_table(const ObjectDescription& object) {
        const auto [entry, is_new] =
            tables_.try_emplace(object.table.get(), static_cast<int>(graph_.groups.size()));
        if (is_new) {
            Group group{object.instances, {}};
            std::vector<int> meshes;
            for (const std::string& file : object.table->files) {
                meshes.push_back(place_mesh(find(files_, file, "mesh file")));
            }
            for (const InstanceRow& row : object.table->rows) {
                group.placements.push_back({.name = fmt::format("line {}", row.line),
                                            .mesh = meshes[static_cast<std::size_t>(row.file)],
                                            .local = row.transform});
            }
            graph_.groups.push_back(std::move(group));
        }
        return entry->second;
    }

    const SceneDescription& description_;
    SceneGraph graph_;
    Names meshes_, files_, groups_;
    std::unordered_map<const InstanceTable*, int> tables_;
    std::vector<bool> placed_;
};

} // namespace

bool changes_shape(const MeshDescription& mesh) {
    return !mesh.playback.moment &&
           (mesh.motion != nullptr || std::any_of(mesh.deformers.begin(), mesh.deformers.end(),
                                                  [](const Deformer& d) { return d.period > 0; }));
}

std::vector<glm::dvec3> placed_points(const MeshDescription& mesh) {
    return placed(mesh, mesh.cage->points);
}

std::vector<Box> mesh_bounds(const SceneDescription& description) {
    std::vector<Box> bounds;
    for (const MeshDescription& mesh : description.meshes) {
        bounds.push_back(bounds_of_used_points(placed_points(mesh), mesh.cage->face_vertices));
    }
    return bounds;
}

SceneGraph build_graph(const SceneDescription& description) {
    return GraphBuilder(description).build();
}

namespace {

Mesh build_mesh(const SceneDescription& description, std::size_t number, const OwnMaterials& own) {
    const MeshDescription& source = description.meshes[number];
    Mesh mesh = *source.cage;
    mesh.name = source.name;
    mesh.scheme = source.scheme;
    mesh.edge_length = source.edge_length;
    mesh.points = placed_points(source);
    mesh.rest = placed(source, source.cage->rest);
    if (OwnMaterials::uses_own(source)) {
        own.place(mesh, replaced_materials(description, source));
    } else {
        mesh.material = source.material.empty() ? 0 : material_index(description, source.material);
        mesh.face_materials.clear();
    }
    mesh.own_materials = nullptr;
    return mesh;
}

} // namespace

Mesh build_mesh(const SceneDescription& description, std::size_t number) {
    return build_mesh(description, number, OwnMaterials(description));
}

std::vector<std::string> notes_of(const SceneDescription& description) {
    std::vector<std::string> notes;
    const auto add = [&](const std::string& note) {
        if (std::find(notes.begin(), notes.end(), note) == notes.end()) {
            notes.push_back(note);
        }
    };
    for (const MeshDescription& mesh : description.meshes) {
        if (OwnMaterials::uses_own(mesh)) {
            std::for_each(mesh.source->own_materials->notes.begin(), mesh.source->own_materials->notes.end(),
                          add);
        }
    }
    for (const Texture& texture : description.textures) {
        if (texture.pyramid != nullptr && texture.pyramid->below_zero > 0) {
            add(fmt::format("{}: {} of its numbers are below 0, down to {:.3g}, and taken as 0",
                            printable(texture.file, 1000), texture.pyramid->below_zero,
                            texture.pyramid->lowest));
        }
    }
    return notes;
}

Scene build_scene(const SceneDescription& description) {
    Scene scene;
    scene.name = description.name;
    scene.settings = description.settings;
    scene.camera = description.camera;
    scene.dicing_camera = description.dicing_camera;
    scene.sky = description.sky;
    scene.sky_map = description.sky_map;
    scene.lights = description.lights;
    scene.textures = description.textures;
    scene.materials = description.materials;
    const OwnMaterials own(description);
    own.append_to(scene);
    for (std::size_t m = 0; m < description.meshes.size(); ++m) {
        scene.meshes.push_back(build_mesh(description, m, own));
    }
    scene.graph = build_graph(description);
    return scene;
}

} // namespace razor
