// razor-trace overlay: what each pixel's rays did to memory, over the picture.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace traces {

/// Of pictures that `razor render --layers` writes: traces know kinds of rays and threads, but no pixels.
class OverlayCommand {
public:
    void add_to(CLI::App& app);
    bool parsed() const { return app_->parsed(); }
    /// Throws Error.
    void run() const;

private:
    CLI::App* app_ = nullptr;
    std::string picture_, layer_ = "bytes.touched", output_, range_;
    bool linear_ = false;
};

} // namespace traces
