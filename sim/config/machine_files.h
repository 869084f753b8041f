// Which files a machine's description comes from, as far as it has a value of theirs.
#pragma once

#include "sim/config/machine_file.h"

#include <filesystem>
#include <string>
#include <vector>

namespace sim {

inline std::vector<std::string> machine_files(const std::string& file, const MachineDescription& about) {
    std::vector<std::string> out{file, about.calibration};
    const std::filesystem::path folder = std::filesystem::path(file).parent_path();
    for (const Origin& origin : about.origins)
        if (origin.layer == Origin::file)
            out.push_back((folder / origin.file_name).string());
    return out;
}

} // namespace sim
