// razor render: a scene or a model to pictures and statistics.
#pragma once

#include "razor/image/tone.h"
#include "razor/native/render.h"
#include "razor/program/layer_options.h"
#include "razor/program/progress.h"
#include "razor/program/scene_options.h"
#include "razor/scene/animation/moving_scene.h"

#include <CLI/CLI.hpp>

#include <memory>
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
    /// One frame to its files; false: interrupted, none is written. `renderer` is made by the first.
    /// `written`: of how many samples a pixel the pictures in the files are meanwhile.
    bool render(std::unique_ptr<NativeRenderer>& renderer, MovingScene& moving, int frame,
                const RenderOptions& options, const Progress& progress, int& written) const;

    /// Of PNG files. Throws UserError.
    Tone tone() const;
    /// In which samples are taken, where that is asked for. Throws UserError.
    PassOptions passes() const;
    void write_pictures(int frame, const Film& film, const std::string& config, std::string_view isa,
                        const PassFigures& passes) const;
    /// Makes passes write their pictures.
    void write_passes(PassOptions& passes, int frame, const std::string& config, std::string_view isa,
                      int& written) const;

    SceneOptions scene_;
    LayerOptions layers_;
    std::vector<std::string> outputs_;
    std::string threads_, isa_ = "auto", share_ = "chip", memory_, repeat_ = "1", frames_, statistics_,
                          trace_, exposure_, tone_ = "srgb", time_;
    bool print_config_ = false, explain_ = false, quiet_ = false, eager_ = false, resume_ = false,
         progressive_ = false;
};

} // namespace razor
