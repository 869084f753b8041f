// What `razor-sim study` and `razor-sim sweep` know: settings of runs, figures, plots.
#pragma once

#include "razor/program/study/study_options.h"

#include <string_view>
#include <vector>

namespace sim {

/// Settings, figures and plots that `razor-sim study` knows.
razor::StudyProgram machine_study_program();
/// ... `razor-sim sweep`.
razor::StudyProgram sweep_program();
/// Settings besides those of scenes and of the machine's file.
const std::vector<std::string_view>& run_keys();

} // namespace sim
