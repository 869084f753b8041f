// Parts of small scene files that tests of several programs are of.
#pragma once

#include <string>

namespace razor {

/// A square lamp above; keys of it may follow.
inline const std::string lamp_text = R"(
    [[light]]
    corner = [-1, 4, -1]
    edge_u = [2, 0, 0]
    edge_v = [0, 0, 2]
    radiance = 8
)";

/// A floor below, and a gear, which objects may place.
inline const std::string floor_and_gear_text = R"(
    [[mesh]]
    name = "floor"
    shape = "plane"
    scale = 6
    translate = [0, -1, 0]
    [[mesh]]
    name = "gear"
    shape = "gear"
)";

} // namespace razor
