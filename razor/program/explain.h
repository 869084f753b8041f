// What a frame needed, in words: its plan, what was left out of it, and what was never built.
#pragma once

#include "razor/native/render.h"
#include "razor/scene/scene.h"

#include <string>
#include <utility>
#include <vector>

namespace razor {

/// Two lines: what of a renderer's features the frame had in use, and what was left out.
std::string features_text(const Scene& scene, const FrameStatistics& frame);
/// The same by name: whether it is in use.
std::vector<std::pair<std::string, bool>> features_in_use(const Scene& scene, const FrameStatistics& frame);

/// Lines of text, of the frame rendered last.
std::string explain(const Scene& scene, const RenderStatistics& statistics);

} // namespace razor
