#include "razor/native/edge_choice.h"

#include "razor/frame/tree_groups.h"
#include "razor/native/targets.h"
#include "razor/scene/ranges.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <thread>
#include <utility>
#include <vector>

namespace razor {
namespace {

constexpr std::size_t most_tiles = 128;
constexpr int least_samples = 16, most_samples = 64;
constexpr double offset = 0.01; // of relative errors, as pbrt's

/// Of the tiles that were rendered, one after the other: three channels a pixel of each half of the samples.
struct Halves {
    std::vector<float> first, second;
    std::vector<std::size_t> tile_ends; // in pixels
    double fraction = 1;                // of all tiles
};

double squared(double x) {
    return x * x;
}

Halves render_part(const Scene& scene, const RenderOptions& options, int samples) {
    const KernelTable& kernels = options.kernels != nullptr ? *options.kernels : native_target(options.isa);
    Frame frame(scene, FrameOptions{.workers = options.threads,
                                    .tree_of_worker = tree_groups(options.threads, options.share),
                                    .memory_bytes = options.memory_bytes,
                                    .passes = true,
                                    .tile_passes = true});
    const std::vector<TilePlace> places = frame.tile_places(kernels);
    const std::size_t stride = (places.size() + most_tiles - 1) / most_tiles;
    Halves halves;
    std::vector<std::size_t> pixels;
    for (std::size_t t = stride / 2; t < places.size(); t += stride) {
        each_pixel(places[t], shown_part(scene.settings), [&](std::size_t i) { pixels.push_back(i); });
        halves.tile_ends.push_back(pixels.size());
    }
    std::vector<int> ends(places.size(), 0);
    halves.fraction = static_cast<double>(halves.tile_ends.size()) / static_cast<double>(places.size());
    const auto render_to = [&](int end) {
        for (std::size_t t = stride / 2; t < places.size(); t += stride)
            ends[t] = end;
        frame.take_samples(kernels, ends);
        run_workers(frame, kernels, {}, options.cancel);
        const Film film = frame.film();
        std::vector<float> values;
        for (const std::size_t i : pixels)
            for (const char* name : {"R", "G", "B"})
                values.push_back(film.find(name)->values[i]);
        return values;
    };
    halves.first = render_to(samples / 2);
    halves.second = render_to(samples);
    for (std::size_t i = 0; i < halves.second.size(); ++i)
        halves.second[i] = 2 * halves.second[i] - halves.first[i];
    return halves;
}

/// What one pixel says: the product of its two differences, and its variance by noise. With d what both
/// differ by and s^2 each one's noise, that is 2 d^2 s^2 + s^4; channels' noise is taken as the same noise.
struct PixelDifference {
    double product = 0, variance = 0;
};

PixelDifference difference_at(const Halves& coarse, const Halves& fine, std::size_t pixel) {
    PixelDifference p;
    double deviation = 0;
    for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i) {
        const double mean = 0.5 * (double{fine.first[i]} + double{fine.second[i]});
        const double scale = std::max(mean, 0.0) + offset;
        const double a = (double{coarse.first[i]} - double{fine.first[i]}) / scale;
        const double b = (double{coarse.second[i]} - double{fine.second[i]}) / scale;
        const double noise = 0.5 * squared(a - b);
        p.product += a * b / 3;
        deviation += std::sqrt(2 * squared(0.5 * (a + b)) * noise + squared(noise)) / 3;
    }
    p.variance = squared(deviation);
    return p;
}

LevelDifference compare(const Halves& coarse, const Halves& fine) {
    LevelDifference d;
    std::size_t pixel = 0;
    double sum = 0, noise = 0, tile_squares = 0;
    for (const std::size_t end : coarse.tile_ends) {
        double of_tile = 0;
        for (; pixel < end; ++pixel) {
            const PixelDifference p = difference_at(coarse, fine, pixel);
            if (!std::isfinite(p.product) || !std::isfinite(p.variance))
                continue;
            ++d.pixels;
            of_tile += p.product;
            noise += p.variance;
        }
        sum += of_tile;
        tile_squares += squared(of_tile);
    }
    const auto n = static_cast<double>(std::max<std::size_t>(d.pixels, 1));
    const auto tiles = static_cast<double>(std::max<std::size_t>(coarse.tile_ends.size(), 2));
    // Tiles that were left out may differ from those that were not.
    const double between = (tile_squares - sum * sum / tiles) * tiles / (tiles - 1) * (1 - coarse.fraction);
    d.square = sum / n;
    d.square_uncertainty = std::sqrt(noise + between) / n;
    d.error = d.square > 0 ? std::sqrt(d.square) : 0;
    return d;
}

Scene with_edges(const Scene& scene, double edge_pixels, double lengths) {
    Scene other = scene;
    other.settings.edge_pixels = edge_pixels;
    for (Mesh& mesh : other.meshes)
        mesh.edge_length *= lengths;
    return other;
}

/// Frames in part by their edge_pixels and samples; where meshes state lengths, those are scaled alike.
class Pilot {
public:
    Pilot(const Scene& scene, const RenderOptions& options) : scene_(scene), options_(options) {
        if (options_.threads <= 0)
            options_.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
    }

    LevelDifference at(double edge_pixels, double target) {
        LevelDifference d;
        for (int samples = least_samples;; samples *= 2) {
            d = compare(of(edge_pixels, samples), of(0.5 * edge_pixels, samples));
            d.samples = samples;
            d.edge_pixels = edge_pixels;
            // Told apart, or so near that either will do.
            const double limit = squared(target);
            if (2 * d.square_uncertainty <= std::max(std::abs(d.square - limit), 0.5 * limit) ||
                samples >= most_samples || !time_left())
                return d;
        }
    }
    double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }
    /// Of a quarter of the time for the picture, where there is a limit.
    bool time_left() const {
        return options_.passes.seconds <= 0 || seconds() < 0.25 * options_.passes.seconds;
    }
    int frames() const { return static_cast<int>(known_.size()); }

private:
    const Halves& of(double edge_pixels, int samples) {
        const auto key = std::pair(edge_pixels, samples);
        const auto found = known_.find(key);
        if (found != known_.end())
            return found->second;
        const double lengths = edge_pixels / scene_.settings.edge_pixels;
        return known_[key] = render_part(with_edges(scene_, edge_pixels, lengths), options_, samples);
    }

    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    const Scene& scene_;
    RenderOptions options_;
    std::map<std::pair<double, int>, Halves> known_;
};

} // namespace

LevelDifference level_difference(const Scene& scene, const RenderOptions& options, double target) {
    return Pilot(scene, options).at(scene.settings.edge_pixels, target);
}

EdgeChoice choose_edge(const Scene& scene, const RenderOptions& options, double target, bool given) {
    Pilot pilot(scene, options);
    const double asked = scene.settings.edge_pixels;
    EdgeChoice choice;
    choice.chosen = pilot.at(asked, 0.5 * target);
    choice.given = given;
    const bool stated = std::any_of(scene.meshes.begin(), scene.meshes.end(),
                                    [](const Mesh& m) { return m.edge_length > 0; });
    const auto too_coarse = [&](const LevelDifference& d) {
        return d.square - 2 * d.square_uncertainty > squared(0.5 * target);
    };
    const auto surely_fine = [&](const LevelDifference& d) {
        return d.square + 2 * d.square_uncertainty < squared(0.25 * target);
    };
    if (given) {
        choice.reason = "stated";
    } else if (stated) {
        choice.given = true;
        choice.reason = "meshes state edge lengths";
    } else if (choice.chosen.square == 0 && choice.chosen.square_uncertainty == 0) {
        choice.reason = "nothing seen has levels";
    } else if (too_coarse(choice.chosen)) {
        while (too_coarse(choice.chosen) && pilot.time_left() && choice.chosen.edge_pixels > asked / 8 &&
               choice.chosen.edge_pixels >= 4 * edge_pixels_range.least)
            choice.chosen = pilot.at(0.5 * choice.chosen.edge_pixels, 0.5 * target);
        choice.reason =
            too_coarse(choice.chosen) ? "the finest that is tried" : "coarser levels differ too much";
    } else {
        choice.reason = "coarser levels may differ too much";
        while (pilot.time_left() && choice.chosen.edge_pixels < 4 * asked &&
               2 * choice.chosen.edge_pixels <= edge_pixels_range.most) {
            const LevelDifference next = pilot.at(2 * choice.chosen.edge_pixels, 0.25 * target);
            if (!surely_fine(next))
                break;
            choice.chosen = next;
            if (next.edge_pixels >= 4 * asked)
                choice.reason = "the coarsest that is tried";
        }
    }
    choice.frames = pilot.frames();
    choice.seconds = pilot.seconds();
    return choice;
}

} // namespace razor
