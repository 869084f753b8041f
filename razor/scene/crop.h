// Whether a part of a picture lies in it.
#pragma once

#include "razor/scene/scene.h"

#include <string>

namespace razor {

/// What is wrong with a crop that was set, in pictures of these settings, and how to mend it; empty where
/// nothing is.
std::string mistake_of_crop(const Crop& part, const Settings& settings);

} // namespace razor
