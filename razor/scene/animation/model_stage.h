// Cameras and lights that the nodes of a model carry, wherever these move.
#pragma once

#include "razor/scene/animation/skeleton.h"
#include "razor/scene/light.h"

#include <optional>
#include <string>
#include <vector>

namespace razor {

/// Looks along -z of its node, y upwards.
struct CarriedCamera {
    std::string name, node_name; // either may be empty
    int node = 0;
    bool perspective = true; // else orthographic
    double fov_degrees = 0;  // of a perspective one: vertical, full angle
    double height = 0;       // of an orthographic one: of what it shows, in the file's units
    double aspect_ratio = 0; // width over height of what it shows; 0: of any picture

    /// By its node, else by itself.
    std::string called() const;
};

/// Shines along -z of its node: a point, a spot or a directional light.
struct CarriedLight {
    std::string name, node_name;
    int node = 0;
    /// Without place and direction; its radiance is luminous: candela, or lux if it is directional.
    Light light;

    std::string called() const; // likewise
};

/// Immutable. Coordinates are those of the file.
class ModelStage {
public:
    /// `cycle`: seconds after which the clip begins again; 0: it holds its last keys.
    ModelStage(Skeleton skeleton, std::optional<Clip> clip, double cycle, std::vector<CarriedCamera> cameras,
               std::vector<CarriedLight> lights);

    // In the order of nodes in the tree: each after its parent's.
    const std::vector<CarriedCamera>& cameras() const { return cameras_; }
    const std::vector<CarriedLight>& lights() const { return lights_; }

    /// From the coordinates of each node to those of the scene, so many seconds after the clip's beginning.
    std::vector<Affine> nodes_at(double seconds) const;
    /// Whether the clip moves it.
    bool moves(int node) const;

private:
    Skeleton skeleton_;
    std::optional<Clip> clip_;
    double cycle_;
    std::vector<CarriedCamera> cameras_;
    std::vector<CarriedLight> lights_;
    std::vector<bool> moved_; // of each node
};

} // namespace razor
