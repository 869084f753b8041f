// The camera or the lights of a scene as a model's file brings them: [camera] and [[light]] with `from`.
//
// Photometric units become radiometric ones by one factor, `lumens_per_watt`: W / sr = cd / it, W / m^2 = lux
// / it. 683, the most that a watt of light can have (at 555 nm), is what Blender writes files by; with 1 the
// file's numbers are taken as watts, as three.js takes them.
#pragma once

#include "razor/scene/animation/model_stage.h"
#include "razor/scene/animation/playback.h"
#include "razor/scene/scene.h"

#include <memory>
#include <string>
#include <vector>

namespace razor {

struct FromModel {
    std::string file;    // absolute path of a glTF file
    std::string name;    // of the camera, or of one light; empty: the first camera, all lights
    Playback playback{}; // of its nodes: clip, cycle, start, speed, moment
    // A point p of the file lies at translate + Rz Ry Rx (scale p), as of [[mesh]]; intensities of points and
    // spots grow by the square of the scale, so that all looks the same.
    double scale = 1;
    glm::dvec3 rotate{0}, translate{0};
    double lumens_per_watt = 683; // of lights
    std::shared_ptr<const ModelStage> stage{};
};

/// Reads the stage of one whose file, name and playback are set, and fills in which clip is played. Throws
/// UserError; what it needs is a camera if `camera`, else a light.
void load_stage(FromModel& from, bool camera);

/// Whether the file has such a camera; what follows of cameras and lights needs them to be there.
bool has_camera(const FromModel& from);

/// The camera `seconds` after the scene's beginning. Its vertical angle or height is that of the file, but
/// larger where the picture is narrower than the camera's aspect ratio, so that all that it shows is seen;
/// the scale of its node does not change it (glTF 2.0, 3.10.2), that of `from` scales the height. Its target
/// lies one unit of the file ahead. Throws UserError where its node has no direction.
Camera camera_of(const FromModel& from, const Settings& settings, double seconds);

/// The lights likewise, as many at all times.
std::vector<Light> lights_of(const FromModel& from, double seconds);

/// Whether the camera, or any of the lights, is elsewhere at other moments.
bool camera_moves(const FromModel& from);
bool lights_move(const FromModel& from);

} // namespace razor
