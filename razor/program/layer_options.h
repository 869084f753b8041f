// The options of razor render that add layers to pictures, or show one in false colours.
#pragma once

#include "razor/image/false_colour.h"
#include "razor/native/render.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace razor {

class LayerOptions {
public:
    /// The object must outlive the parsing.
    void add_to(CLI::App& render);

    bool given() const { return !layers_.empty() || !shown_.empty(); }
    /// Whether PNG files show a layer.
    bool shows() const { return !shown_.empty(); }
    /// What adaptive sampling alone has.
    bool shows_samples() const { return shown_ == "samples"; }
    /// Asks for the layers. Throws UserError for unknown ones, and where no picture would have them.
    void ask(RenderOptions& options, const std::vector<std::string>& outputs) const;
    /// The film's layer in false colours.
    Film shown(const Film& film) const;
    /// "steps.nodes: 2.5 (dark) to 40 (bright)", if PNG files show a layer; else nothing.
    std::string legend(const Film& film) const;

private:
    /// Of the layer that is shown: its name, by that of its group for the group's first; one that every
    /// picture has is a layer too.
    std::string shown_name() const;
    std::optional<ValueRange> stated_range() const;

    std::string layers_, shown_, range_;
};

} // namespace razor
