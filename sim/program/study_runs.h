// Runs of the machine at the points of a study, beside runs of its reference.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/run.h"
#include "analysis/study/store.h"
#include "sim/config/machine_file.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace sim {

class MachineStudy {
public:
    /// `folder`: where files are named from. `program`: this one's file, which is run for each point.
    MachineStudy(const analysis::Study& study, std::filesystem::path folder, std::string program,
                 const std::atomic<bool>& stop);

    /// A point's body, with the whole machine and scene. Throws std::exception where they do not fit.
    std::string body(const analysis::Point& point) const;
    /// What these points are compared with, each once; none where the study names no reference.
    std::vector<analysis::Point> references(const std::vector<analysis::Point>& points) const;
    /// What is simulated of a tile for points in closed form, each once: all points of the study whose tiles
    /// are alike share the seed of the first of them, whatever is measured now.
    std::vector<analysis::Point> tile_seeds(const std::vector<analysis::Point>& points) const;
    /// Makes a tile's seeds, of all seeds of noise, in the store's folder `seeds`, where they stay.
    analysis::Result measure_tile_seed(const analysis::Point& seed, const analysis::Store& store) const;
    /// Figures of one point's runs, of all its seeds. Throws razor::UserError, analysis::Stopped.
    analysis::Result measure_reference(const analysis::Point& reference, const analysis::Store& store) const;
    /// ... beside its reference's, which has been measured.
    analysis::Result measure(const analysis::Point& point, const analysis::Store& store) const;
    /// The file of a point's machine or scene that is no more what the point's body says, or nothing.
    std::string changed(const analysis::Point& point) const;

private:
    /// What is known of a scene of these settings.
    struct Described {
        std::string digest;
        analysis::Settings settings; // all of them
    };
    const Described& described(const analysis::Settings& settings) const;
    /// `razor-sim run` of these settings. With seeds, of that one. `tile_seed`: its file, of a run in closed
    /// form.
    std::vector<std::string> command(const analysis::Settings& settings, int seed, const std::string& json,
                                     const std::string& tile_seed) const;
    MachineDescription machine_of(const analysis::Settings& settings) const;
    /// Of a point in closed form: its tile, by the settings of the study's first point with one like it.
    analysis::Point tile_seed_of(const analysis::Settings& settings, int seeds) const;
    /// The file of a tile's seed, which is made if it is not there.
    std::string kept_tile_seed(const analysis::Point& tile, int seed, const analysis::Store& store) const;
    void run(const std::vector<std::string>& words, const std::filesystem::path& log) const;
    /// `of_tile`: of a seed, which is the same whether settings of its machine are written down or its
    /// file's.
    std::string own_body(const analysis::Settings& settings, int seeds, bool of_tile = false) const;
    analysis::Point reference_of(const analysis::Point& point) const;
    analysis::Result run_all(const analysis::Settings& settings, int seeds,
                             const analysis::Store& store) const;

    const analysis::Study& study_;
    std::filesystem::path folder_;
    std::string program_;
    const std::atomic<bool>& stop_;
    mutable std::map<std::string, analysis::Point> tiles_; // by what a seed must know of tile and scene
    mutable std::map<std::string, Described> described_;   // by the settings' text: scenes take long to read
};

} // namespace sim
