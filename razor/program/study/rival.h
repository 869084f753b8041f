// Another program's pictures and times, by a study's [[rival]].
#pragma once

#include "analysis/images/image_file.h"
#include "analysis/study/study_file.h"

#include <atomic>
#include <map>
#include <string>
#include <vector>

namespace razor {

/// Its command with {word} replaced. Throws UserError, which names the word, where there is none of that
/// name.
std::vector<std::string> rival_command(const analysis::Rival& rival,
                                       const std::map<std::string, std::string>& words);

struct RivalRun {
    analysis::ImageFile picture;
    std::map<std::string, std::vector<double>> figures;
};
/// One run; {json} and {picture} are files that go when it has ended. Throws UserError, analysis::Stopped.
RivalRun run_rival(const analysis::Rival& rival, std::map<std::string, std::string> words,
                   const std::atomic<bool>& stop);

} // namespace razor
