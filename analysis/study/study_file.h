// Study files: what is measured, at which points, against which reference, how often. In TOML:
//
//     kind = "image"               # of the program that measures: image, machine, sweep, trace
//     title = "Levels of detail"
//     seeds = 4                    # runs of each point that differ in noise alone: seeds 1 to 4
//     repeats = 2                  # timed frames of a run after its first
//     where = ["samples * edge_pixels <= 64"]  # points of which one does not hold are left out: constraint.h
//     rank = ["rmse"]              # figures that points are ranked by, whose ratios tell what settings do
//     [settings]                   # of all points, where they state nothing else
//     scene = "../scenes/showcase.toml"
//     [knobs]                      # a point for each combination
//     lod = ["recursive", "fixed"]
//     edge_pixels = [1, 2, 4]
//     [[points]]                   # further ones: a value, or a list, of which each combination is a point
//     lod = "paper"
//     edge_pixels = [1, 2]
//     [[exclude]]                  # leaves out points of which all of this holds
//     lod = "fixed"                # a value, a list of them, or { least = 2, most = 4 } (or one of both)
//     edge_pixels = { most = 1 }
//     [reference]                  # what the reference has instead of a point's settings
//     seeds = 4
//     samples = 256
//     [[plot]]                     # from figures that the program knows
//     x = "seconds"
//     y = "rmse"
//     lines = ["lod"]              # settings that tell lines apart; points of a line differ in the others
//     [[curve]]                    # a figure over a setting of numbers, a line for all others' combinations
//     x = "edge_pixels"
//     y = "rmse"
//     [[rival]]                    # another program, measured by the same rules: see Rival
//     [full]                       # keys as above, which take their place where the full size is asked for
//
// Keys in tables of settings are the program's, "section.key" where they stand in tables of these.
#pragma once

#include "analysis/study/settings.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace analysis {

/// What the program that reads a study knows.
struct Vocabulary {
    std::string kind; // of studies
    /// What is wrong with a setting (cause; mend), or an empty text. May change the value's type, so that
    /// equal settings are equal values.
    std::function<std::string(std::string_view key, Value& value)> wrong;
    std::vector<std::string> figures; // that plots may show
    /// What a setting of a point of `file` is where the study does not say, as of a machine's file; none: it
    /// must say. Throws std::exception (cause; mend) for what is no number, or no setting.
    std::function<double(const Settings& point, std::string_view key, const std::string& file)> preset{};
    std::vector<std::string> files{};         // settings that name a file, from the study's folder
    std::vector<std::string> of_references{}; // those of the figures that only studies with a reference have
};

/// Another program: a command is run for each point, with words in braces replaced: settings of the point
/// ({scene}, {samples}), {seed}, {repeats}, {json} (the file that it writes figures to), and what else the
/// measuring program says. A braced word may stand within a longer one.
struct Rival {
    std::string name;
    std::vector<std::string> command;
    /// Figures by the measuring program's names, each a JSON pointer into the file (RFC 6901), of which `*`
    /// stands for all elements of an array.
    std::vector<std::pair<std::string, std::string>> figures;
    std::vector<Settings> points; // what each combination of its knobs adds to, or replaces in, the settings
};

struct PlotRequest {
    std::string x, y;
    std::vector<std::string> lines;
};

/// A figure over a setting.
struct CurveRequest {
    std::string x, y;
};

/// Where a value stands in a study's file.
struct FilePlace {
    std::uint32_t line = 0, column = 0;
};

struct Study {
    std::string file, title;
    int seeds = 1, repeats = 1;
    std::vector<Settings> points;   // resolved: the settings of all, overlaid with those of each; none twice
    std::vector<std::string> knobs; // what points differ in, in the file's order
    Settings common;                // [settings]
    Settings reference;             // [reference], without its seeds
    int reference_seeds = 2;
    std::vector<PlotRequest> plots;
    std::vector<CurveRequest> curves;
    std::vector<std::string> rank; // figures
    std::vector<Rival> rivals;
    std::map<std::pair<std::string, Value>, FilePlace>
        places; // of settings and their values, the last of equal ones

    /// "FILE:LINE:COLUMN" of a setting; the file alone where it does not say that.
    std::string place_of(const std::string& key, const Value& value) const;
    /// What is wrong with a point of these settings, behind the place of the first that it names, if any.
    std::string placed(const std::string& wrong, const Settings& settings) const;
};

/// Most points of a study.
inline constexpr std::size_t most_points = 100000;

/// Throws StudyError: `file:line:column: cause; mend`.
Study read_study(const std::string& file, const Vocabulary& vocabulary, bool full = false);
/// The same from text; `name` stands for the file's in messages.
Study parse_study(std::string_view text, std::string_view name, const Vocabulary& vocabulary,
                  bool full = false);

} // namespace analysis
