// Numbers out of a glTF file's buffers: glTF 2.0, 3.6.2.
#pragma once

#include "razor/scene/models/gltf/document.h"

#include <cstdint>

namespace razor::gltf {

/// All elements' components, one after another; normalised integers in [-1, 1] or [0, 1]. `width`: components
/// an element. `count`: elements there must be; 0: any number but none, and they may not be left out for
/// zeros. `what` names the use in messages. Throws UserError: not so, out of the buffer, or not finite.
std::vector<double> read_numbers(const Document& document, int accessor, int width, std::size_t count,
                                 std::string_view what);

/// The same of unsigned integers, one an element.
std::vector<std::uint32_t> read_indices(const Document& document, int accessor, std::string_view what);

/// Elements of this accessor, at most 2^31 - 1. Throws UserError.
std::size_t count_of(const Document& document, int accessor, std::string_view what);

} // namespace razor::gltf
