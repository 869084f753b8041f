// Textures and materials as scene files state them.
#pragma once

#include "razor/scene/material.h"
#include "razor/scene/texture.h"

#include <string>
#include <vector>

namespace razor {

std::string to_toml(const Texture& texture);

/// Its name and albedo, and all the rest if any of it is not as it is by itself. Maps name these textures.
std::string to_toml(const Material& material, const std::vector<Texture>& textures);

} // namespace razor
