// razor-trace overlay: what each pixel's rays did to memory, over the picture.
#pragma once

#include "analysis/plots/overlay.h"

#include <CLI/CLI.hpp>

#include <string>

namespace traces {

/// Of --range: "LOW,HIGH". Throws Error.
analysis::OverlayScale parse_overlay_range(const std::string& text, bool logarithmic);

/// Of pictures that `razor render --layers` writes: a trace knows screen tiles (`tiles`), but no pixels.
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
