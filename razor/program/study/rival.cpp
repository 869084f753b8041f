#include "razor/program/study/rival.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char** environ; // NOLINT: as of POSIX

namespace razor {
namespace {

namespace fs = std::filesystem;

/// Gone when it goes out of scope.
class ScratchFolder {
public:
    ScratchFolder() : path_(fs::temp_directory_path() / fmt::format("razor-study-{}", ::getpid())) {
        fs::remove_all(path_); // of a killed process of the same number
        fs::create_directories(path_);
    }
    ~ScratchFolder() {
        std::error_code ignored;
        fs::remove_all(path_, ignored);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    fs::path operator/(const char* name) const { return path_ / name; }

private:
    fs::path path_;
};

std::string last_line(const fs::path& file) {
    std::error_code ignored;
    if (fs::file_size(file, ignored) == 0 || ignored)
        return "it said nothing";
    std::string text = read_text_file(file, "a log");
    text.erase(text.find_last_not_of(" \n\r\t") + 1);
    return printable(text.substr(text.find_last_of('\n') + 1), 300);
}

void run_logged(const std::vector<std::string>& command, const fs::path& log) {
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
        throw UserError(fmt::format("{}: cannot be run ({}); build it, or mend the rival's command",
                                    printable(command[0], 300), std::strerror(wrong)));
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR)
            throw UserError(fmt::format("{}: cannot be waited for", printable(command[0], 300)));
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        throw UserError(fmt::format("{} failed ({}): {}", printable(command[0], 300),
                                    WIFEXITED(status) ? fmt::format("exit code {}", WEXITSTATUS(status))
                                                      : std::string(strsignal(WTERMSIG(status))),
                                    last_line(log)));
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

std::vector<std::string> rival_command(const analysis::Rival& rival,
                                       const std::map<std::string, std::string>& words) {
    std::vector<std::string> out;
    for (const std::string& part : rival.command) {
        std::string made;
        for (std::size_t at = 0; at < part.size();) {
            const std::size_t open = std::min(part.find('{', at), part.size());
            made += part.substr(at, open - at);
            if (open == part.size())
                break;
            const std::size_t close = part.find('}', open);
            const std::string word =
                close == std::string::npos ? "" : part.substr(open + 1, close - open - 1);
            const auto found = words.find(word);
            if (found == words.end()) {
                std::vector<std::string> known;
                for (const auto& [name, value] : words)
                    known.push_back(name);
                throw UserError(fmt::format("rival {}: {} stands for nothing; there are {}", rival.name,
                                            printable(part), fmt::join(known, ", ")));
            }
            made += found->second;
            at = close + 1;
        }
        out.push_back(std::move(made));
    }
    return out;
}

std::vector<double> pointed_numbers(const nlohmann::ordered_json& json, const std::string& pointer) {
    std::vector<double> out;
    try {
        collect_numbers(json, pointer, out);
    } catch (const UserError& error) {
        throw UserError(
            fmt::format("{}: {}; mend the rival's figures", printable(pointer, 200), error.what()));
    }
    return out;
}

RivalRun run_rival(const analysis::Rival& rival, std::map<std::string, std::string> words) {
    const ScratchFolder folder;
    words["json"] = (folder / "figures.json").string();
    words["picture"] = (folder / "picture.exr").string();
    run_logged(rival_command(rival, words), folder / "log");
    RivalRun out;
    try {
        out.picture = analysis::read_image(folder / "picture.exr");
    } catch (const analysis::ImageError& error) {
        throw UserError(fmt::format("rival {}: its picture: {}", rival.name, error.what()));
    }
    if (!rival.figures.empty()) {
        const std::string text = read_text_file(folder / "figures.json", "figures of a rival");
        const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
        if (json.is_discarded())
            throw UserError(fmt::format("rival {}: its figures are no JSON; mend its command", rival.name));
        for (const auto& [figure, pointer] : rival.figures)
            out.figures[figure] = pointed_numbers(json, pointer);
    }
    return out;
}

} // namespace razor
