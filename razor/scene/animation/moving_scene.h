// A scene that goes from moment to moment, and of which only what moves is made anew.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/scene_changes.h"

#include <optional>
#include <span>
#include <vector>

namespace razor {

class MovingScene {
public:
    explicit MovingScene(SceneDescription moving);
    MovingScene(const MovingScene&) = delete;
    MovingScene& operator=(const MovingScene&) = delete;

    /// To `seconds` after the beginning, from any moment. Throws UserError as pose_at() and build_scene() do.
    void go_to(double seconds);
    void go_to_frame(int frame) { go_to(frame / moving_.frame_rate); }

    /// Another edition of the scene: other cameras, lights, light of the sky, and transforms (with their
    /// keys) of these objects, of group -1 those of none; all else as it was. Go to a moment next.
    void take_over(const SceneDescription& edited, std::span<const PlacementName> objects);

    // After go_to(), until the next one:
    /// pose_at() of the moment ...
    const SceneDescription& description() const { return posed_; }
    /// ... and build_scene() of that.
    const Scene& scene() const { return scene_; }
    /// What go_to() made other than it was at the moment before. Null: it was the first, or the one before it
    /// threw.
    const SceneChanges* changes() const { return changes_ ? &*changes_ : nullptr; }

private:
    void begin(double seconds);
    void move(const PlacementName& object, double seconds);
    void move_mesh(std::size_t mesh, double seconds);

    SceneDescription moving_, posed_;
    Scene scene_;
    std::optional<SceneChanges> changes_;
    bool begun_ = false;
    // What has keys, hangs on others, or has other shapes: objects of a group (-1: of none) by number.
    std::vector<PlacementName> objects_;
    std::vector<std::size_t> meshes_;
    std::vector<PlacementName> edited_; // likewise; since the last moment
};

} // namespace razor
