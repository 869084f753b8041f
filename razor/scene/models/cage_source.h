// Cages from where a scene says they come: shapes, OBJ and PLY files and sequences of them, MD3 and glTF
// models.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/models/model_file.h"
#include "razor/scene/textures/texture_cache.h"

#include <filesystem>
#include <string_view>
#include <unordered_map>

namespace razor {

/// What was read, by the file and how it is played, with its pictures: no file is read twice.
struct CageCache {
    struct Entry {
        Playback playback{}; // as asked for, and what was left open
        std::shared_ptr<const Mesh> source{};
        std::shared_ptr<const MovingCage> motion{};
        std::shared_ptr<const Tags> tags{};
        std::shared_ptr<const NamedNodes> nodes{};
    };
    std::unordered_map<std::string, Entry> entries;
    TextureCache textures;
};

/// Reads or generates the cage of a mesh whose file or shape, parameters, playback and deformers are set;
/// fills in which frames are played (all that there are) and which clip (the first). Throws UserError.
void load_cage(MeshDescription& mesh);
void load_cage(MeshDescription& mesh, CageCache& cages);

/// Sets `cage` to what it is so many seconds after the scene's beginning, or at its moment. Throws UserError
/// where a frame cannot be read.
void shape_cage(MeshDescription& mesh, double scene_seconds);
/// ... and lets it stand at that moment.
void pose_cage(MeshDescription& mesh, double scene_seconds);

/// Until when its own motion has shown all: the last key, or the longest period. Seconds.
double motion_length(const MeshDescription& mesh);

/// What a file's cage is called: the stem of its name, without the place of a number.
std::string cage_name(const std::filesystem::path& path);

} // namespace razor
