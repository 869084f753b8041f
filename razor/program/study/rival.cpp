#include "razor/program/study/rival.h"

#include "razor/program/study/command.h"
#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {

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

RivalRun run_rival(const analysis::Rival& rival, std::map<std::string, std::string> words,
                   const std::atomic<bool>& stop) {
    const ScratchFolder folder;
    words["json"] = (folder / "figures.json").string();
    words["picture"] = (folder / "picture.exr").string();
    run_command(rival_command(rival, words), folder / "log", stop);
    RivalRun out;
    try {
        out.picture = analysis::read_image(folder / "picture.exr");
    } catch (const analysis::ImageError& error) {
        throw UserError(fmt::format("rival {}: its picture: {}", rival.name, error.what()));
    }
    if (rival.figures.empty())
        return out;
    const nlohmann::ordered_json json = read_figures(folder / "figures.json", "rival " + rival.name);
    for (const auto& [figure, pointer] : rival.figures)
        out.figures[figure] = pointed_numbers(json, pointer);
    return out;
}

} // namespace razor
