// razor render: a scene or a model to pictures and statistics.
#pragma once

#include "razor/api/renderer.h"
#include "razor/native/edge_choice.h"
#include "razor/native/render.h"
#include "razor/program/layer_options.h"
#include "razor/program/progress.h"
#include "razor/program/scene_options.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace razor {

class RenderCommand {
public:
    /// Adds the subcommand to `app`. The object must outlive the parsing.
    void add_to(CLI::App& app);

    /// Renders what the parsed options ask for and returns the exit code. Throws UserError.
    int run() const;

private:
    /// What the options ask for. Throws UserError where they contradict each other.
    RenderOptions options() const;
    /// One frame to its files; false: interrupted, none is written.
    bool render(api::Renderer& renderer, int frame, const RenderCalls& calls, const Progress& progress,
                const std::optional<EdgeChoice>& levels) const;
    /// Of a frame that took so long, loading included.
    void write_statistics(const api::Renderer& renderer, int frame, double seconds,
                          const std::optional<EdgeChoice>& levels) const;
    void tell(const api::Renderer& renderer, int frame, double seconds, const Film& film,
              const Progress& progress) const;

    /// Of PNG files. Throws UserError.
    Tone tone() const;
    /// In which samples are taken, where that is asked for. Throws UserError.
    PassOptions passes() const;
    void write_pictures(const api::Renderer& renderer, int frame, const Film& film,
                        const PassFigures& passes) const;
    /// What writes the pictures of passes. `written`: of how many samples a pixel those in the files are.
    Passed write_passes(const api::Renderer& renderer, int frame, double& written) const;

    SceneOptions scene_;
    LayerOptions layers_;
    std::vector<std::string> outputs_;
    std::string threads_, isa_ = "auto", share_ = "chip", memory_, repeat_ = "1", frames_, statistics_,
                          trace_, exposure_, tone_ = "srgb", time_, target_error_;
    bool print_config_ = false, explain_ = false, quiet_ = false, eager_ = false, resume_ = false,
         progressive_ = false;
};

} // namespace razor
