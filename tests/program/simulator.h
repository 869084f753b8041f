// razor-sim in a folder of its own.
#pragma once

#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

inline const std::string tiny = quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml");

/// Calls visit(path) for every value in it that is no object, no array and not null, with [] for places in
/// arrays.
inline void each_path(const nlohmann::json& json, const std::string& path,
                      const std::function<void(const std::string&)>& visit) {
    if (json.is_object())
        for (const auto& [key, value] : json.items())
            each_path(value, path.empty() ? key : path + "." + key, visit);
    else if (json.is_array())
        for (const nlohmann::json& value : json)
            each_path(value, path + "[]", visit);
    else if (!json.is_null())
        visit(path);
}

/// Whether a path is one that the pattern stands for, whose * are any names.
inline bool stands_for(std::string_view pattern, std::string_view path) {
    while (!pattern.empty() && !path.empty()) {
        const std::size_t a = std::min(pattern.find('.'), pattern.size()),
                          b = std::min(path.find('.'), path.size());
        const std::string_view name = pattern.substr(0, a);
        if (name != path.substr(0, b) && name != "*" && !(name == "*[]" && path.substr(0, b).ends_with("[]")))
            return false;
        pattern.remove_prefix(std::min(a + 1, pattern.size()));
        path.remove_prefix(std::min(b + 1, path.size()));
    }
    return pattern.empty() && path.empty();
}

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

    /// Every figure of a report has one line of `razor-sim explain`, which are added to `used`. All paths.
    std::set<std::string> expect_explained(const nlohmann::json& report,
                                           std::set<std::string>* used = nullptr) const {
        std::vector<std::string> patterns;
        std::istringstream lines(simulator("explain").out);
        for (std::string line; std::getline(lines, line);)
            patterns.push_back(line.substr(0, line.find_first_of(": ")));
        std::set<std::string> paths;
        each_path(report, "", [&](const std::string& path) { paths.insert(path); });
        for (const std::string& path : paths) {
            int found = 0;
            for (const std::string& pattern : patterns)
                if (stands_for(pattern, path)) {
                    ++found;
                    if (used != nullptr)
                        used->insert(pattern);
                }
            EXPECT_EQ(found, 1) << path;
        }
        return paths;
    }

    TemporaryFolder folder_;
};

} // namespace razor
