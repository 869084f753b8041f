// The command-line options that choose a scene and override parts of it, for every program that renders.
#pragma once

#include "razor/scene/description.h"

#include <CLI/CLI.hpp>

#include <string>

namespace razor {

class SceneOptions {
public:
    /// Adds the options to `app`; the scene itself is the option `scene_name`: "scene" for a positional one,
    /// or "--scene". The object must outlive the parsing.
    void add_to(CLI::App& app, const std::string& scene_name);

    /// The scene that the parsed options ask for, in the frame that they ask for; the built-in one where none
    /// is named. Throws UserError.
    SceneDescription describe() const;
    /// ... a bare model without the floor that pictures give it.
    SceneDescription describe_alone() const;
    /// ... with all that moves.
    SceneDescription describe_moving() const;
    /// Of --frame, and whether it was given.
    int frame() const;
    bool frame_given() const { return !frame_.empty(); }
    /// Whether --lod was.
    bool lod_given() const { return !lod_.empty(); }
    /// Whether --edge-pixels was.
    bool edge_pixels_given() const { return !edge_pixels_.empty(); }

private:
    SceneDescription describe_moving(bool floor) const;

    std::string scene_, size_, crop_, samples_, noise_threshold_, filter_, filter_radius_, light_samples_,
        light_choices_, sky_samples_, bounces_, diffuse_bounces_, seed_, edge_pixels_, lod_, shading_,
        scheme_, frame_, crease_angle_, up_ = "y";
    bool no_floor_ = false, everything_ = false;
};

} // namespace razor
