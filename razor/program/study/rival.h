// Another program's pictures and times, by a study's [[rival]].
#pragma once

#include "analysis/images/image_file.h"
#include "analysis/study/store.h"
#include "analysis/study/study_file.h"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace razor {

/// `command` with {word} replaced. Throws UserError, which names the word, where there is none of that name.
std::vector<std::string> rival_command(const analysis::Rival& rival,
                                       const std::map<std::string, std::string>& words);

/// The numbers that a JSON pointer names, `*` standing for all elements of an array. Throws UserError.
std::vector<double> pointed_numbers(const nlohmann::ordered_json& json, const std::string& pointer);

struct RivalRun {
    analysis::ImageFile picture;
    std::map<std::string, std::vector<double>> figures;
};
/// One run, with files in a folder of its own that goes with it. Throws UserError.
RivalRun run_rival(const analysis::Rival& rival, std::map<std::string, std::string> words);

} // namespace razor
