// What a frame needed, in words: its plan, what was left out of it, and what was never built.
#pragma once

#include "razor/native/render.h"
#include "razor/scene/scene.h"

#include <string>

namespace razor {

/// Lines of text, of the frame rendered last.
std::string explain(const Scene& scene, const RenderStatistics& statistics);

} // namespace razor
