// What razor check says, for people and for programs.
#pragma once

#include "razor/check/convergence.h"
#include "razor/check/escapes.h"
#include "razor/check/mesh_report.h"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace razor::check {

/// A line a mesh, and one for each kind of finding.
std::string text_of(const std::vector<MeshReport>& meshes);
/// How many kinds of findings there are that most likely are mistakes, summed over meshes.
int warnings_of(const std::vector<MeshReport>& meshes);
std::string text_of(const EscapeReport& report);
std::string text_of(const ConvergenceReport& report);

nlohmann::ordered_json json_of(const MeshReport& mesh);
nlohmann::ordered_json json_of(const EscapeReport& report);
nlohmann::ordered_json json_of(const ConvergenceReport& report);

/// Why rays cannot be shot from inside: one line that names the first open mesh and its first open edge, or
/// what else keeps it from being closed.
std::string why_open(const std::vector<MeshReport>& meshes);

} // namespace razor::check
