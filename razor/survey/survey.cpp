#include "razor/survey/survey.h"

#include "razor/survey/kd_leaf_at.h"
#include "razor/survey/sight.h"
#include "razor/survey/tile_layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace razor {
namespace {

constexpr int most_lanes = 64;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// The pixels of one packet, and what they show.
struct Packet {
    alignas(256) std::int32_t column[most_lanes], row[most_lanes];
    alignas(256) float point[3][most_lanes];
    alignas(256) float t[most_lanes], u[most_lanes], v[most_lanes];
    alignas(256) std::int32_t patch[most_lanes], triangle[most_lanes], block[most_lanes];

    SeeArguments arguments(int count) {
        return {column, row, count, {point[0], point[1], point[2]}, t, u, v, patch, triangle, block};
    }
    NamedHit hit(std::size_t lane) const {
        return {t[lane], u[lane], v[lane], patch[lane], triangle[lane], block[lane]};
    }
};

class Surveyor {
public:
    Surveyor(Frame& frame, const Crop& part, const SurveyOptions& options, Film& film)
        : frame_(frame), h_(frame.header()), part_(part), options_(options),
          values_(all_layers().size(), nullptr), ids_(all_layers().size(), nullptr) {
        // All planes first: those that are there move when others are added.
        for (const Layer& layer : all_layers())
            if (options.layers.has(layer.group) && source_of(layer.group) != LayerSource::tile)
                layer.names ? film.add_ids(layer.name) : film.add(layer.name);
        for (std::size_t i = 0; i < values_.size(); ++i)
            if (Plane* plane = film.find(all_layers()[i].name)) {
                values_[i] = all_layers()[i].names ? nullptr : plane->values.data();
                ids_[i] = all_layers()[i].names ? plane->ids.data() : nullptr;
            }
    }

    bool run() {
        // A packet's pixels, as the kernels shape one of one sample a pixel: see packet_shape().
        const int lanes_log2 = std::countr_zero(static_cast<unsigned>(options_.kernels->width));
        const int rows = 1 << lanes_log2 / 2, columns = 1 << (lanes_log2 - lanes_log2 / 2);
        for (int y = part_.y / rows * rows; y < part_.y + part_.height; y += rows)
            for (int x = part_.x / columns * columns; x < part_.x + part_.width; x += columns) {
                if (options_.cancel != nullptr && options_.cancel->load())
                    return false;
                see(x, y, std::min(x + columns, h_.width), std::min(y + rows, h_.height));
            }
        return true;
    }

private:
    /// Pixels from (x0, y0) up to, not including, (x1, y1): a lane each, row by row.
    void see(int x0, int y0, int x1, int y1) {
        pixels_.clear();
        for (int y = y0; y < y1; ++y)
            for (int x = x0; x < x1; ++x) {
                packet_.column[pixels_.size()] = x;
                packet_.row[pixels_.size()] = y;
                pixels_.push_back(place_in_film(x, y));
            }
        const SeeArguments arguments = packet_.arguments(static_cast<int>(pixels_.size()));
        const Counters before = frame_.counters(0).kind[kind_camera];
        frame_.see(*options_.kernels, arguments);
        Counters steps = frame_.counters(0).kind[kind_camera];
        steps -= before;
        if (options_.layers.has(LayerSource::sight))
            put_sights();
        put_steps(steps);
        if (options_.layers.has(LayerSource::touch))
            put_bytes(options_.touched(frame_, arguments));
    }

    /// The number of a pixel in the film; -1: it is beyond the part.
    std::ptrdiff_t place_in_film(int x, int y) const {
        const int column = x - part_.x, row = y - part_.y;
        const bool inside = column >= 0 && row >= 0 && column < part_.width && row < part_.height;
        return inside ? static_cast<std::ptrdiff_t>(row) * part_.width + column : -1;
    }

    /// of(lane) to each pixel of the packet, if the layer is asked for.
    template <class Of> void put(std::string_view name, Of of) {
        float* values = values_[static_cast<std::size_t>(find_layer(name) - all_layers().data())];
        if (values == nullptr)
            return;
        for (std::size_t lane = 0; lane < pixels_.size(); ++lane) {
            if (pixels_[lane] >= 0)
                values[pixels_[lane]] = static_cast<float>(of(lane));
        }
    }
    /// Likewise a name; -1: there is none.
    template <class Of> void put_id(std::string_view name, Of of) {
        std::uint32_t* ids = ids_[static_cast<std::size_t>(find_layer(name) - all_layers().data())];
        for (std::size_t lane = 0; ids != nullptr && lane < pixels_.size(); ++lane)
            if (const std::int32_t id = of(lane); pixels_[lane] >= 0)
                ids[pixels_[lane]] = id < 0 ? no_id : static_cast<std::uint32_t>(id);
    }

    void put_sights() {
        std::array<Sight, most_lanes> sights{};
        std::array<KdLeaf, most_lanes> leaves{};
        std::array<double, most_lanes> asked{};
        for (std::size_t lane = 0; lane < pixels_.size(); ++lane) {
            const NamedHit hit = packet_.hit(lane);
            if (hit.patch < 0)
                continue;
            sights[lane] = sight_of(frame_, hit);
            const glm::vec3 point(packet_.point[0][lane], packet_.point[1][lane], packet_.point[2][lane]);
            asked[lane] = asked_edge(h_, point);
            if (options_.layers.has(LayerGroup::kd))
                leaves[lane] = kd_leaf_at(h_, 0, point, hit.block);
        }
        const double unit = frame_.unit();
        const auto is_hit = [this](std::size_t lane) { return packet_.patch[lane] >= 0; };
        put_id("pick.mesh", [&](std::size_t i) { return sights[i].mesh; });
        put_id("pick.instance", [&](std::size_t i) { return sights[i].instance; });
        put_id("pick.face", [&](std::size_t i) { return sights[i].face; });
        put_id("pick.part", [&](std::size_t i) { return sights[i].part; });
        put("pick.u", [&](std::size_t i) { return sights[i].u; });
        put("pick.v", [&](std::size_t i) { return sights[i].v; });
        put("pick.Z", [&](std::size_t i) { return is_hit(i) ? packet_.t[i] * unit : infinity; });
        put_id("patch.id", [&](std::size_t i) { return sights[i].patch; });
        put_id("patch.block", [&](std::size_t i) { return sights[i].block; });
        put("lod.level",
            [&](std::size_t i) { return is_hit(i) ? sights[i].absolute + std::log2(unit) : infinity; });
        put("lod.depth", [&](std::size_t i) { return is_hit(i) ? sights[i].level : -1; });
        put("lod.asked", [&](std::size_t i) { return is_hit(i) ? std::log2(asked[i] * unit) : infinity; });
        put("kd.depth", [&](std::size_t i) { return leaves[i].depth; });
        put("kd.finer", [&](std::size_t i) { return leaves[i].finer; });
    }

    /// The same to all pixels of the packet.
    void put_share(std::string_view name, std::int64_t of_packet) {
        const double of_ray = static_cast<double>(of_packet) / static_cast<double>(pixels_.size());
        put(name, [of_ray](std::size_t) { return of_ray; });
    }
    void put_steps(const Counters& steps) {
        put_share("steps.nodes", steps.node_visits);
        put_share("steps.boxes", steps.box_tests);
        put_share("steps.blocks", steps.block_tests);
        put_share("steps.blended", steps.blended_tests);
        put_share("steps.cells", steps.cell_tests);
        put_share("steps.quads", steps.quad_tests);
    }
    void put_bytes(const TouchedBytes& bytes) {
        put_share("bytes.touched", bytes.all);
        put_share("bytes.tree", bytes.tree);
        put_share("bytes.grids", bytes.grids);
    }

    Frame& frame_;
    const FrameHeader& h_;
    const Crop& part_;
    const SurveyOptions& options_;
    std::vector<float*> values_;      // of each layer; null: it is not asked for
    std::vector<std::uint32_t*> ids_; // likewise, of those of names
    Packet packet_;
    std::vector<std::ptrdiff_t> pixels_; // of its lanes; -1: not in the film
};

} // namespace

bool survey(Frame& frame, const Crop& part, const SurveyOptions& options, Film& film) {
    if (options.layers.has(LayerSource::tile))
        add_tile_layers(frame.tile_costs(*options.kernels), frame.header(), options.kernels->width, part,
                        options.layers, film);
    const bool sees = options.layers.has(LayerSource::sight) || options.layers.has(LayerSource::packet) ||
                      options.layers.has(LayerSource::touch);
    return !sees || Surveyor(frame, part, options, film).run();
}

} // namespace razor
