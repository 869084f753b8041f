// Textures and materials of scene files.
//
// A material's kind states what it has where nothing else is stated: matte (what only reflects in all
// directions alike), principled (a dielectric's reflection besides), mirror or glass. Where a map is stated
// and the number or colour that it multiplies is not, that is 1.
#pragma once

#include "razor/scene/textures/texture_cache.h"
#include "razor/scene/toml_table.h"

#include "razor/scene/material.h"

#include <span>
#include <string>

namespace razor {

/// A texture that a table's member names, of `textures` by their names: its number.
int read_texture_name(TomlTable& table, std::string_view key, std::span<const std::string> textures);

/// [[texture]], with its picture; the file's name is relative to `folder`. Throws UserError.
Texture read_texture(TomlTable& table, const std::filesystem::path& folder, TextureCache& cache);

/// [[material]], whose maps may name these textures. Throws UserError.
/// Reads the heights of the texture that a material is displaced by, if nobody has yet. `table`: of the
/// material.
void read_heights(const TomlTable& table, const Material& material, std::span<Texture> textures,
                  TextureCache& cache);

Material read_material(TomlTable& table, std::span<const std::string> textures);

} // namespace razor
