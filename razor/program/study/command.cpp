#include "razor/program/study/command.h"

#include "analysis/study/isolated.h"
#include "analysis/study/run.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT: as of POSIX

namespace razor {
namespace {

namespace fs = std::filesystem;

constexpr int look_ms = 50; // at whether it is to stop

std::string last_line(const fs::path& file) {
    std::error_code error;
    if (fs::file_size(file, error) == 0 || error)
        return "it said nothing";
    std::string text = read_text_file(file, "a log");
    text.erase(text.find_last_not_of(" \n\r\t") + 1);
    return printable(text.substr(text.find_last_of('\n') + 1), 300);
}

void collect_numbers(const nlohmann::ordered_json& json, std::string_view pointer, std::vector<double>& out) {
    if (pointer.empty()) {
        if (!json.is_number())
            throw UserError("it names no number");
        out.push_back(json.get<double>());
        return;
    }
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    const std::string_view token = pointer.substr(1, end - 1), rest = pointer.substr(end);
    if (token == "*") {
        if (!json.is_array())
            throw UserError("its * stands for no array");
        for (const auto& one : json)
            collect_numbers(one, rest, out);
        return;
    }
    std::string first = "/";
    first += token;
    const nlohmann::ordered_json::json_pointer step(first);
    if (!json.contains(step))
        throw UserError(fmt::format("there is no {}", token));
    collect_numbers(json.at(step), rest, out);
}

} // namespace

ScratchFolder::ScratchFolder()
    : path_(fs::temp_directory_path() / fmt::format("razor-study-{}", ::getpid())) {
    fs::remove_all(path_); // of a killed process of the same number
    fs::create_directories(path_);
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
}

void run_command(const std::vector<std::string>& command, const fs::path& log,
                 const std::atomic<bool>& stop) {
    std::vector<char*> words;
    std::vector<std::string> copies = command;
    for (std::string& word : copies)
        words.push_back(word.data());
    words.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                     0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = 0;
    const int wrong = posix_spawnp(&child, words[0], &actions, nullptr, words.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    if (wrong != 0)
        throw UserError(fmt::format("{}: cannot be run ({}); build it, or mend the command",
                                    printable(command[0], 300), std::strerror(wrong)));
    const analysis::ChildrenEnd ended_soon({child});
    int status = 0;
    bool told = false;
    for (;;) {
        const pid_t ended = ::waitpid(child, &status, WNOHANG);
        if (ended == child)
            break;
        if (ended < 0 && errno != EINTR)
            throw UserError(fmt::format("{}: cannot be waited for", printable(command[0], 300)));
        if (stop.load() && !told) {
            told = true;
            ::kill(child, SIGTERM);
        }
        ended_soon.wait(look_ms);
    }
    if (stop.load())
        throw analysis::Stopped{};
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw UserError(fmt::format("{} failed ({}): {}", printable(command[0], 300),
                                    WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                                      : std::string(strsignal(WTERMSIG(status))),
                                    last_line(log)));
}

nlohmann::ordered_json read_figures(const fs::path& file, const std::string& whose) {
    auto json = nlohmann::ordered_json::parse(read_text_file(file, "a JSON file"), nullptr, false);
    if (json.is_discarded())
        throw UserError(fmt::format("{}: its figures are no JSON; mend its command", whose));
    return json;
}

std::vector<double> pointed_numbers(const nlohmann::ordered_json& json, const std::string& pointer) {
    std::vector<double> out;
    try {
        collect_numbers(json, pointer, out);
    } catch (const UserError& error) {
        throw UserError(fmt::format("{}: {}; mend the pointer", printable(pointer, 200), error.what()));
    }
    return out;
}

} // namespace razor
