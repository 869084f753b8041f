#include "razor/scene/models/gltf_reader.h"

#include "razor/scene/animation/retarget.h"
#include "razor/scene/error.h"
#include "razor/scene/models/gltf/drawn_mesh.h"
#include "razor/scene/models/gltf/joints.h"
#include "razor/scene/models/gltf/materials.h"
#include "razor/scene/models/gltf/named_nodes.h"
#include "razor/scene/models/gltf/nodes.h"
#include "razor/scene/models/own_materials.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>

namespace razor {
namespace {

using namespace gltf;

std::vector<glm::dvec3> pose_all(const std::vector<Skin>& skins, const SkeletonPose& skeleton) {
    std::size_t count = 0;
    for (const Skin& skin : skins)
        count += skin.points.size();
    std::vector<glm::dvec3> points(count);
    std::span<glm::dvec3> rest = points;
    for (const Skin& skin : skins) {
        pose(skin, skeleton, rest.first(skin.points.size()));
        rest = rest.subspan(skin.points.size());
    }
    return points;
}

class GltfMotion final : public MovingCage {
public:
    GltfMotion(std::shared_ptr<const Mesh> cage, std::vector<Skin> skins,
               std::shared_ptr<const SkeletonMotion> motion, double cycle)
        : cage_(std::move(cage)), skins_(std::move(skins)), motion_(std::move(motion)), cycle_(cycle) {}

    std::shared_ptr<const Mesh> at(double seconds) const override {
        return moved(*cage_, pose_all(skins_, motion_->at(in_cycle(seconds, cycle_))));
    }
    double length() const override { return motion_->length(); }

private:
    std::shared_ptr<const Mesh> cage_;
    std::vector<Skin> skins_;
    std::shared_ptr<const SkeletonMotion> motion_;
    double cycle_;
};

/// Adds the triangles of a mesh; `first_point`: number of its first point in the cage. `materials`: may be
/// null.
void append_faces(const DrawnMesh& drawn, int first_point, bool turn, MaterialReader* materials, Mesh& cage) {
    const auto first_texcoord = static_cast<int>(cage.texcoords.size());
    for (std::size_t c = 0; c < drawn.triangles.size(); c += 3) {
        cage.face_sizes.push_back(3);
        if (materials != nullptr)
            cage.face_materials.push_back(materials->use(drawn.materials[c / 3]));
        for (const std::size_t corner : {c, turn ? c + 2 : c + 1, turn ? c + 1 : c + 2}) {
            cage.face_vertices.push_back(first_point + drawn.triangles[corner]);
            const int texcoord = drawn.corner_texcoords[corner];
            cage.face_texcoords.push_back(texcoord == none ? none : first_texcoord + texcoord);
        }
    }
    cage.texcoords.insert(cage.texcoords.end(), drawn.texcoords.begin(), drawn.texcoords.end());
    for (const Crease& c : drawn.creases)
        cage.creases.push_back({first_point + c.v0, first_point + c.v1, c.sharpness});
}

/// Texture coordinates at all corners or at none.
void finish_texcoords(Mesh& cage) {
    if (cage.texcoords.empty()) {
        cage.face_texcoords.clear();
    } else if (std::find(cage.face_texcoords.begin(), cage.face_texcoords.end(), none) !=
               cage.face_texcoords.end()) {
        std::replace(cage.face_texcoords.begin(), cage.face_texcoords.end(), none,
                     static_cast<int>(cage.texcoords.size()));
        cage.texcoords.emplace_back(0.0F, 0.0F);
    }
}

void check_cage(const Document& document, const Mesh& cage) {
    if (cage.face_sizes.empty())
        document.fail("its scene draws no triangles; a model needs at least one");
    const auto is_finite = [](const glm::dvec3& p) {
        return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
    };
    const auto in_range = [](const glm::vec2& t) { return std::isfinite(t.x) && std::isfinite(t.y); };
    if (!std::all_of(cage.points.begin(), cage.points.end(), is_finite))
        document.fail("its nodes take points beyond double precision; mend their transforms");
    if (!std::all_of(cage.texcoords.begin(), cage.texcoords.end(), in_range))
        document.fail("texture coordinate beyond single precision; mend it");
}

/// Whether any point follows one of these nodes.
bool follows(const std::vector<Skin>& skins, const std::vector<bool>& moved) {
    const auto is_moved = [&](int node) { return moved[static_cast<std::size_t>(node)]; };
    return std::any_of(skins.begin(), skins.end(), [&](const Skin& skin) {
        return skin.joints.empty() ? is_moved(skin.node)
                                   : std::any_of(skin.joints.begin(), skin.joints.end(), is_moved);
    });
}

/// ... or has a morph target that the clip moves.
bool moves(const Clip& clip, const Skeleton& skeleton, const std::vector<Skin>& skins) {
    return follows(skins, moved_nodes(skeleton, clip)) ||
           std::any_of(skins.begin(), skins.end(), [&](const Skin& skin) {
               return std::any_of(clip.channels.begin(), clip.channels.end(), [&](const Channel& channel) {
                   return channel.path == Channel::Path::weights && channel.node == skin.node;
               });
           });
}

/// What moves the nodes, and whether it moves the cage.
struct NodeMotion {
    std::shared_ptr<const SkeletonMotion> motion; // null: nothing
    bool moves_cage = false;
};

/// By the chosen clip of the file itself.
NodeMotion own_motion(GltfModel& model, const Document& document, const std::string& clip_name,
                      const Skeleton& skeleton, const std::vector<Skin>& skins) {
    model.clips = clip_names(document);
    if (model.clips.empty() && clip_name.empty())
        return {};
    Clip clip =
        read_clip(document, skeleton, clip_name.empty() ? 0 : find_clip(document, model.clips, clip_name));
    const bool moves_cage = moves(clip, skeleton, skins);
    return {std::make_shared<const ClipMotion>(skeleton, std::move(clip)), moves_cage};
}

/// By one of another file.
NodeMotion motion_of(const std::filesystem::path& path, GltfModel& model, const Document& document,
                     const std::string& clip_name, const Skeleton& skeleton, const std::vector<Skin>& skins) {
    const Document other = load_document(path);
    model.clips = clip_names(other);
    if (model.clips.empty())
        other.fail("has no animation; give a file that has one");
    Skeleton source = read_skeleton(other);
    Clip clip = read_clip(other, source, clip_name.empty() ? 0 : find_clip(other, model.clips, clip_name));
    auto motion = std::make_shared<const RetargetedMotion>(std::move(source), std::move(clip), skeleton,
                                                           match_joints(document, other));
    const bool moves_cage = follows(skins, motion->moved());
    return {std::move(motion), moves_cage};
}

GltfModel read(const std::filesystem::path& path, const std::string& clip_name, double cycle,
               TextureCache* textures, const std::filesystem::path& clip_file, double crease_degrees) {
    const Document document = load_document(path);
    if (!(cycle >= 0 && std::isfinite(cycle)))
        document.fail(fmt::format("a cycle of {} s; give 0 or more", cycle));
    const Skeleton skeleton = read_skeleton(document);
    const SkeletonPose rest = rest_pose(skeleton);
    Mesh cage;
    cage.name = path.stem().string();
    std::vector<Skin> skins;
    std::size_t points = 0;
    std::optional<MaterialReader> materials;
    if (textures != nullptr)
        materials.emplace(document, path.parent_path(), *textures);
    for (const int node : nodes_to_draw(document, skeleton)) {
        if (document.nodes[static_cast<std::size_t>(node)].mesh == none)
            continue;
        DrawnMesh drawn = read_drawn_mesh(document, node, crease_degrees);
        const bool turn =
            drawn.skin.joints.empty() && is_mirrored(rest.world[static_cast<std::size_t>(node)].linear);
        constexpr std::size_t most = std::numeric_limits<int>::max();
        if (drawn.skin.points.size() > most - points ||
            drawn.triangles.size() > most - cage.face_vertices.size())
            document.fail("has more than 2^31 face corners; split the model");
        append_faces(drawn, static_cast<int>(points), turn, materials ? &*materials : nullptr, cage);
        points += drawn.skin.points.size();
        skins.push_back(std::move(drawn.skin));
    }
    finish_texcoords(cage);
    if (materials)
        set_own_materials(cage, std::make_shared<const ModelMaterials>(materials->finish()));
    cage.points = pose_all(skins, rest);
    check_cage(document, cage);
    GltfModel model{std::make_shared<const Mesh>(std::move(cage)), nullptr, nullptr, {}};
    const NodeMotion played = clip_file.empty()
                                  ? own_motion(model, document, clip_name, skeleton, skins)
                                  : motion_of(clip_file, model, document, clip_name, skeleton, skins);
    if (played.moves_cage)
        model.motion = std::make_shared<const GltfMotion>(model.cage, std::move(skins), played.motion, cycle);
    if (std::vector<NamedNode> named = named_nodes(document, skeleton); !named.empty())
        model.nodes = std::make_shared<const NamedNodes>(std::move(named), skeleton, played.motion, cycle);
    return model;
}

} // namespace

GltfModel read_gltf(const std::filesystem::path& path, const std::string& clip, double cycle,
                    TextureCache* textures, const std::filesystem::path& clip_file, double crease_degrees) {
    const auto too_large = [&path] {
        return UserError(fmt::format("{}: the model does not fit in memory; give a smaller one",
                                     printable(path.string(), 1000)));
    };
    try {
        return read(path, clip, cycle, textures, clip_file, crease_degrees);
    } catch (const std::bad_alloc&) {
        throw too_large();
    } catch (const std::length_error&) {
        throw too_large();
    }
}

} // namespace razor
