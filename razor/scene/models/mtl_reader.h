// Wavefront MTL libraries as materials of the metallic-roughness model.
//
//   albedo        Kd; 1 where that is black and there is a map_Kd
//   specular      1 where Ks is not black, Ns > 0, and illum, if stated, is 2 or more; else 0
//   roughness     (2 / (Ns + 2))^(1/4): Phong's lobe of that exponent has the width alpha = sqrt(2 / (Ns +
//   2))
//                 (Walter et al., EGSR 2007), and roughness is the square root of alpha
//   emission      Ke; 1 where that is black and there is a map_Ke
//   transmission  1 - d (Tr is 1 - d), with specular 1, the index Ni, and roughness 0 where there is no Ns
//   mirrors       of illum 3 and 5, if Ks is not black: metallic 1, roughness 0, albedo Ks
//
// The physically based extension has the last word: Pm metallic, Pr roughness (either: specular 1, unless Ks
// is black), Pc coat, Pcr coat roughness, Ps sheen (white). A dielectric's Ni counts where it is above 1:
// exporters write 1 for what is opaque. Maps: map_Kd, map_Ke, map_Pm, map_Pr, map_Ps, norm (tangent-space
// normals), with -s, -o and -clamp. Where map_d is the file of map_Kd, opacity below 1/2 cuts out. Colours
// above 1 count as 1. Of bump (map_bump, map_Bump) and disp, a value v of the file, from 0 to 1, is a height,
// in the units of the scene's mesh: of bump -bm x -mm's gain x v, of disp base + gain v (-mm 0 1 unless
// stated). Exporters write normal maps as map_Bump, too: a picture whose mean is that of one (red and green
// within 0.1 of 1/2, blue above 3/4) is taken as such, -bm as its strength. All other statements are passed
// over; which options of maps are is noted.
#pragma once

#include "razor/scene/scene.h"
#include "razor/scene/textures/texture_cache.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

class MtlReader {
public:
    /// Of materials with other names nothing is read, their textures least of all. Both must outlive the
    /// reader.
    MtlReader(const std::vector<std::string>& wanted, TextureCache& textures);

    /// Adds what a library has of those that earlier ones have not. Throws UserError "file:line: cause;
    /// mend".
    void read(const std::filesystem::path& file);

    ModelMaterials finish() { return std::move(result_); }

private:
    const std::vector<std::string>& wanted_;
    TextureCache& textures_;
    ModelMaterials result_;
};

/// A file that another in `folder` names, perhaps by a path of another machine: there, or by its last part
/// beside it. Empty: neither is there.
std::filesystem::path find_beside(const std::filesystem::path& folder, std::string_view name);

} // namespace razor
