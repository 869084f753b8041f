// A scene to be rendered: read from a file or from text, and edited.
//
// What it consists of is plain data whose members the headers below describe; it is held by value, so copies
// are scenes of their own. What is wrong with a value is said when it is set, what is wrong with the scene
// as a whole (an object that is flattened by all that it hangs on, say) when it is rendered: both as a
// UserError, whose what() is one line that names the place, the cause and the mend.
#pragma once

#include "razor/scene/error.h"
#include "razor/scene/graph/affine.h"
#include "razor/scene/light.h"
#include "razor/scene/material.h"
#include "razor/scene/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace razor {
struct SceneDescription;
}

namespace razor::api {

/// How a bare model, or a table of instances, becomes a scene: see razor/scene/framing.h.
struct Framing {
    bool z_up = false; // else y
    bool floor = true;
    Scheme scheme = Scheme::catmull_clark;
    /// Of MD3 and glTF models: where normals of the file differ between faces by more degrees, edges stay
    /// hard.
    double crease_angle = 180;
    int width = 512, height = 512; // of the picture, pixels: its shape says how far away the camera stands
};

class Scene {
public:
    /// The one that programs show where none is named.
    static Scene built_in();
    /// A scene file (.toml), a model (.obj, .ply, .md3, .gltf, .glb) or a table of them (.instances).
    /// `framing` is of models and tables. Throws UserError.
    static Scene load(const std::filesystem::path& file, const Framing& framing = {});
    /// The text of a scene file. Files that it names are found from `folder`; `name` stands for the file's in
    /// messages. Throws UserError.
    static Scene parse(std::string_view toml, const std::filesystem::path& folder = ".",
                       std::string_view name = "scene");
    /// Of a description that was made in some other way (razor/scene/description.h).
    explicit Scene(SceneDescription description);

    Scene(const Scene& other);
    Scene& operator=(const Scene& other);
    Scene(Scene&& other) noexcept; // leaves nothing but what can be assigned to and destroyed
    Scene& operator=(Scene&& other) noexcept;
    ~Scene();

    /// A complete scene file, all defaults filled in: parsing it gives the same scene.
    std::string toml() const;
    bool is_animated() const;
    double frame_rate() const; // frames a second
    const SceneDescription& description() const;

    const Settings& settings() const;
    void set_settings(const Settings& settings);

    /// Where the camera moves: as it is in the beginning. One that is set stands still.
    const Camera& camera() const;
    void set_camera(const Camera& camera);
    /// From which levels of detail are measured, where that is not the camera.
    const std::optional<Camera>& dicing_camera() const;
    void set_dicing_camera(const std::optional<Camera>& camera);

    /// Likewise: lights that are set stand still, and are all there are.
    const std::vector<Light>& lights() const;
    void set_lights(std::vector<Light> lights);
    /// Radiance from infinitely far away, W / (m^2 sr); of a sky with a map, what multiplies it.
    glm::vec3 sky() const;
    void set_sky(const glm::vec3& radiance);

    /// Those that the scene states itself, not those of models' files.
    const std::vector<Material>& materials() const;
    /// Takes the place of the one of its name, or is added. Maps are numbers of textures that the scene has.
    void set_material(const Material& material);

    /// The names of objects, "group/object" of those in groups, in the scene's order. Two may have one name.
    std::vector<std::string> objects() const;
    /// Of the object of that name; where it moves, as it is in the beginning. Throws UserError where there is
    /// none, or more than one.
    const Transform& transform(std::string_view object) const;
    /// It stands still then.
    void set_transform(std::string_view object, const Transform& transform);
    /// Of all that the object places and that states none of its own; empty: none is stated here either.
    void set_object_material(std::string_view object, std::string_view material);

    /// The names of meshes, in the scene's order: that of the layer pick.mesh.
    std::vector<std::string> meshes() const;
    /// Of the mesh of that name, where objects do not replace it; empty: those of its file.
    void set_mesh_material(std::string_view mesh, std::string_view material);

private:
    friend class Renderer;
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace razor::api
