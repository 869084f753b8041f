// razor-sim in a folder of its own.
#pragma once

#include "tests/program/run.h"

#include <nlohmann/json.hpp>

namespace razor {

inline const std::string tiny = quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml");

class Simulator : public ::testing::Test {
protected:
    Outcome simulator(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_SIMULATOR) + " " + arguments, folder_.path());
    }
    std::string text(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }
    nlohmann::json report(const std::string& name) const {
        nlohmann::json all = nlohmann::json::parse(text(name));
        all.erase("host");
        return all;
    }

    TemporaryFolder folder_;
};

} // namespace razor
