#include "razor/scene/crop.h"

#include <fmt/format.h>

namespace razor {

std::string mistake_of_crop(const Crop& part, const Settings& s) {
    if (part.width > 0 && part.height > 0 && part.x + part.width <= s.width &&
        part.y + part.height <= s.height) {
        return {};
    }
    return fmt::format("the crop of {} x {} pixels at ({}, {}) is not a part of a picture of {} x {}; give "
                       "X, Y, WIDTH and HEIGHT of one that is",
                       part.width, part.height, part.x, part.y, s.width, s.height);
}

} // namespace razor
