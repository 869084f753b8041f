// What razor render chooses and tells where samples are taken in passes.
#pragma once

#include "razor/native/edge_choice.h"
#include "razor/scene/description.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>

namespace razor {

/// The line of samples and errors.
std::string passes_text(const PassFigures& passes);
/// The line of levels of detail, and what --stats says of them.
std::string text_of(const EdgeChoice& choice);
nlohmann::ordered_json json_of(const EdgeChoice& choice);

/// Chooses edge_pixels of the scene for options.passes.target_error (razor/native/edge_choice.h), by what it
/// is in that frame; a time for passes is shorter by what this takes. `given`: the user states them. Nothing:
/// it was interrupted.
std::optional<EdgeChoice> choose_edges(SceneDescription& description, int frame, RenderOptions& options,
                                       bool given);

} // namespace razor
