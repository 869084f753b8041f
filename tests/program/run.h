// Runs one of our programs and keeps what it said.
#pragma once

#include "tests/program/quoted_argument.h"
#include "tests/scene/temporary_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/wait.h>

namespace razor {

struct Outcome {
    int code = -1; // exit code, or -1 where a signal ended it
    std::string out, err;

    std::ptrdiff_t error_lines() const { return std::count(err.begin(), err.end(), '\n'); }
};

/// Runs `command` (shell syntax) in `folder`, its streams in files outside it.
inline Outcome run(const std::string& command, const std::filesystem::path& folder) {
    const std::string out = folder.string() + ".out";
    const std::string err = folder.string() + ".err";
    const std::string line = "cd " + quoted_argument(folder.string()) + " && " + command + " >" +
                             quoted_argument(out) + " 2>" + quoted_argument(err) + " </dev/null";
    Outcome result;
    const int status = std::system(line.c_str()); // NOLINT(cert-env33-c)
    result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    const auto slurp = [](const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(file)), {});
    };
    result.out = slurp(out);
    result.err = slurp(err);
    std::filesystem::remove(out);
    std::filesystem::remove(err);
    return result;
}

} // namespace razor
