// Surfaces whose material is a light, cut into triangles to sample points on. Points lie on the surface by
// definition; rays may see it by as much elsewhere as levels of detail differ.
#pragma once

#include "razor/frame/emitter_record.h"
#include "razor/frame/light_bounds.h"
#include "razor/frame/scene_geometry.h"
#include "razor/surface/pages.h"

#include <map>
#include <memory>
#include <tuple>
#include <vector>

namespace razor {

/// Of a patch that is curved, along each side: as many quads as a block has.
inline constexpr int emitter_steps = 8;
/// In all; surfaces of more are cut less finely.
inline constexpr std::size_t most_emitters = std::size_t{1} << 20;

/// Groups of patches that are chosen together, at most about; with more patches there are more in a group.
inline constexpr std::size_t most_emitter_groups = 4096;

struct EmitterTables {
    std::vector<EmitterRecord> records;
    std::vector<EmitterGroup> groups; // without their leaves
    std::vector<LightBounds> bounds;  // of each group
    std::vector<float> sums;    // of chances in each group: 0 before its first triangle, 1 after its last
    std::vector<float> density; // of each material, by area; 0: its surfaces are not sampled
    double area = 0;            // of all
};

class Emitters {
public:
    /// Of what instances draw. Keeps references to meshes and topologies. `materials`: what those that are
    /// lights emit on the whole, maps and all; 0 of others.
    Emitters(const std::vector<Mesh>& meshes, const std::vector<Topology>& topologies,
             const std::vector<Instance>& instances, const std::vector<glm::dvec3>& materials);
    ~Emitters();
    Emitters(const Emitters&) = delete;
    Emitters& operator=(const Emitters&) = delete;

    /// Of all instances, whatever shape their meshes have.
    std::size_t count() const { return count_; }
    std::size_t groups() const { return groups_; }
    /// As they are now; `scene`: with the points of its meshes; `first_patches`: see InstanceRecord.
    EmitterTables tabulate(const Scene& scene, const SceneGeometry& geometry,
                           const std::vector<std::int32_t>& first_patches);

private:
    /// Of the points of one kind of face's part over its control points: rows as a page has them.
    struct Weights {
        std::size_t stride = 0;
        std::vector<float> of_points;
    };
    struct Grid;
    void group_patches(const std::vector<Instance>& instances);
    void set_chances(const std::vector<double>& power, EmitterTables& t) const;
    bool is_light(const Instance& instance, const PatchRecord& patch) const;
    int steps_of(const PatchRecord& patch) const;
    Grid grid_of(const Mesh& mesh, std::size_t m, const PatchRecord& patch);
    const Weights& weights_of(std::size_t mesh, int face_class, int sub);

    const std::vector<Mesh>& meshes_;
    const std::vector<Topology>& topologies_;
    std::vector<glm::dvec3> emitted_;
    std::vector<double> bright_; // the means of their colours
    int steps_ = emitter_steps;
    std::size_t count_ = 0, groups_ = 0;
    std::size_t patches_a_group_ = 1;
    std::vector<std::unique_ptr<PageMaker>> makers_;               // of meshes, where they are needed
    std::map<std::tuple<std::size_t, int, int>, Weights> weights_; // of mesh, class and part
};

} // namespace razor
