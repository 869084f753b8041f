// Materials of MD3 models: each surface's picture.
//
// The first shader of a surface is the path of a picture below the game's root folder, often with another
// extension than the file has, or the name of a script, of which nothing is read. A skin beside the model
// (head_default.skin, else head.skin, of head.md3, and of head_1.md3, a coarser level of it) states others
// for the surfaces that it names, in any case. Where pictures are looked for: game_files.h.
//
// A surface has a material of its own, called as its shader or else as the surface: matte, with the picture
// as the map of its albedo. What the picture's opacity means the script would say; it is passed over. Where
// there is no such picture, the material is the preset, and that is noted.
#pragma once

#include "razor/scene/models/md3_reader.h"
#include "razor/scene/textures/texture_cache.h"

namespace razor {

/// What a surface is painted with.
struct Md3Paint {
    std::string shader;            // empty: nothing is stated
    std::string stated_at;         // for messages: "m.md3: surface 'head'", "head_default.skin:2"
    std::filesystem::path picture; // empty: there is none
};

/// Of each surface of the model in `file`. Appends what is missing of those that have faces, for users, to
/// `notes`. Throws UserError where the skin cannot be read.
std::vector<Md3Paint> find_md3_paints(const std::filesystem::path& file, const Md3Model& model,
                                      std::vector<std::string>& notes);

/// Gives the cage the materials of those surfaces that have faces. Throws UserError "place: picture: cause;
/// mend" where one that is there cannot be read.
void paint(Md3Model& model, const std::filesystem::path& file, TextureCache& textures);

} // namespace razor
