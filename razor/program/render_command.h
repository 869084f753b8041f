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
    bool render(std::unique_ptr<NativeRenderer>& renderer, MovingScene& moving, int frame,
                const RenderOptions& options, const Progress& progress) const;

    /// Of PNG files. Throws UserError.
    Tone tone() const;

    SceneOptions scene_;
    LayerOptions layers_;
    std::vector<std::string> outputs_;
    std::string threads_, isa_ = "auto", share_ = "chip", memory_, repeat_ = "1", frames_, statistics_,
                          trace_, exposure_, tone_ = "srgb";
    bool print_config_ = false, explain_ = false, quiet_ = false, eager_ = false, resume_ = false;
};

} // namespace razor
