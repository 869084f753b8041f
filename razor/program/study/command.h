// Another program, run as a study's point asks.
#pragma once

#include <nlohmann/json.hpp>

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace razor {

/// A folder of this process's own among temporary files, gone when this goes out of scope.
class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    std::filesystem::path operator/(const char* name) const { return path_ / name; }

private:
    std::filesystem::path path_;
};

/// Runs a command, as no shell does: its first word is a program of the PATH or a file. What it says goes to
/// `log`. Throws UserError where it cannot be run or does not end with 0, with its last line, and
/// analysis::Stopped where `stop` became true: the program has been told (SIGTERM) and has ended.
void run_command(const std::vector<std::string>& command, const std::filesystem::path& log,
                 const std::atomic<bool>& stop);

/// A JSON file that a command has written. Throws UserError.
nlohmann::ordered_json read_figures(const std::filesystem::path& file, const std::string& whose);

/// The numbers that a JSON pointer (RFC 6901) names, `*` standing for all elements of an array. Throws
/// UserError.
std::vector<double> pointed_numbers(const nlohmann::ordered_json& json, const std::string& pointer);

} // namespace razor
