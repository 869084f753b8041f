// What the workers of a frame have: arenas, scratch memory, and stretches of the screen.
#include "razor/frame/budget.h"
#include "razor/frame/frame_memory.h"
#include "razor/frame/scratch.h"

#include <bit>
#include <numeric>
#include <tuple>
#include <utility>

namespace razor {
namespace {

std::uint64_t share_of(std::uint64_t all, int workers) {
    std::uint64_t granule = isa::address_space::granule;
    return all / static_cast<std::uint64_t>(workers) / granule * granule;
}

} // namespace

void Frame::Impl::size_bounded_arenas() {
    const std::uint64_t budget = std::min(options.memory_bytes, all_grids);
    for (int t = 0; t < trees; ++t) {
        const std::uint64_t share =
            budget * static_cast<std::uint64_t>(workers_of(t)) / static_cast<std::uint64_t>(options.workers);
        grains.push_back(static_cast<int>(share / (grain_lines * line_bytes + sizeof(std::int32_t))));
    }
}

std::uint64_t Frame::Impl::arena_bytes() const {
    if (options.memory_bytes != 0)
        return 4 * std::min(options.memory_bytes, all_grids) +
               static_cast<std::uint64_t>(trees) * 8 * isa::address_space::granule;
    return static_cast<std::uint64_t>(options.workers) * (grid_bytes + node_bytes + list_bytes);
}

void Frame::Impl::size_arenas() {
    if (options.memory_bytes != 0)
        return size_bounded_arenas();
    const auto size = [&](std::uint64_t wanted, std::uint64_t all) {
        const std::uint64_t granule = isa::address_space::granule;
        const std::uint64_t most = share_of(all, options.workers) - granule; // room for colours
        return wanted == 0 ? most : std::min((wanted + granule - 1) / granule * granule, most);
    };
    grid_bytes = size(options.grid_bytes, all_grids);
    node_bytes = size(options.node_bytes, all_nodes);
    list_bytes = size(options.list_bytes, all_lists);
    grid_lines_each = static_cast<int>(grid_bytes / line_bytes);
    nodes_each = static_cast<int>(node_bytes / sizeof(KdNode));
    list_lines_each = static_cast<int>(list_bytes / line_bytes);
}

void Frame::Impl::place_workers() {
    // All of it lives for one frame.
    auto n = static_cast<std::size_t>(options.workers);
    header->queues.set(region<QueueRecord>("queues", -1, 1, true));
    header->stretches.set(region<StretchRecord>("queues", -1, n, true));
    header->trees.set(region<TreeRecord>("kd nodes", -1, static_cast<std::size_t>(trees), true));
    header->workers.set(region<WorkerRecord>("stack", -1, n, true));
    for (int t = 0; t < trees; ++t) {
        TreeRecord& tree = header->trees.get()[t];
        tree.patches.set(
            coloured<OpenPatch>("grids", t, static_cast<std::size_t>(header->patch_count), colour_patches));
        tree.curve_lengths.set(
            coloured<isa::shared<std::int32_t>>("grids", t, total.curves, colour_curve_lengths));
    }
    if (options.memory_bytes != 0)
        place_bounded_arenas();
    else
        place_arenas();
    for (int w = 0; w < options.workers; ++w) {
        WorkerRecord& r = header->workers.get()[w];
        r.stack.set(coloured<float>("stack", w, 2 * spare_stack, colour_stack));
        r.packets.set(coloured<float>("packets", w, 2 * spare_packets, colour_packets));
        r.blends.set(coloured<float>("blended blocks", w,
                                     static_cast<std::size_t>(blend_slots) *
                                         static_cast<std::size_t>(header->slot_floats),
                                     colour_blends));
        r.tree = options.tree_of_worker[static_cast<std::size_t>(w)];
        ++header->trees.get()[r.tree].sharers;
    }
    header->discards = options.discards ? 1 : 0;
    header->grid_lines = grid_lines_each;
    header->node_count = nodes_each;
    header->list_lines = list_lines_each;
    order_workers();
}

void Frame::Impl::order_workers() {
    const auto key = [this](int worker) {
        const auto w = static_cast<std::size_t>(worker);
        return std::tuple(options.tree_of_worker[w],
                          options.place_of_worker.empty() ? worker : options.place_of_worker[w], worker);
    };
    std::vector<int> order(static_cast<std::size_t>(options.workers));
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&key](int a, int b) { return key(a) < key(b); });
    header->worker_count = options.workers;
    header->tile_rows = options.tiles_in_rows ? 1 : 0;
    header->place_span = static_cast<std::int32_t>(std::bit_ceil(static_cast<unsigned>(options.workers)));
    for (int place = options.workers - 1; place >= 0; --place) {
        WorkerRecord& r = header->workers.get()[order[static_cast<std::size_t>(place)]];
        r.place = place;
        TreeRecord& tree = header->trees.get()[r.tree];
        tree.first_place = place;
        if (tree.end_place == 0)
            tree.end_place = place + 1;
    }
}

void Frame::Impl::place_arenas() {
    // The regions of one family lie side by side, so that one base and 32 bits name anything in it.
    for (int w = 0; w < options.workers; ++w) {
        auto* p =
            reinterpret_cast<Line*>(memory->add("grids", w, grid_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->grids.set(p);
    }
    for (int w = 0; w < options.workers; ++w) {
        auto* p = reinterpret_cast<KdNode*>(
            memory->add("kd nodes", w, node_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->nodes.set(p);
    }
    for (int w = 0; w < options.workers; ++w) {
        auto* p = reinterpret_cast<Line*>(
            memory->add("item lists", w, list_bytes + isa::address_space::granule, true));
        if (w == 0)
            header->lists.set(p);
    }
}

void Frame::Impl::place_bounded_arenas() {
    std::uint64_t lines = 0;
    std::vector<int> first;
    for (int t = 0; t < trees; ++t) {
        lines += static_cast<std::uint64_t>(colour(t, colour_grids) / grain_lines * grain_lines);
        first.push_back(static_cast<int>(lines));
        lines += static_cast<std::uint64_t>(grains[static_cast<std::size_t>(t)]) * grain_lines;
    }
    std::byte* const p = memory->add(options.apart ? "grids" : "bounded", -1, lines * line_bytes, true);
    header->grids.set(reinterpret_cast<Line*>(p));
    header->nodes.set(
        reinterpret_cast<KdNode*>(options.apart ? memory->add("kd nodes", -1, lines * line_bytes, true) : p));
    header->lists.set(
        reinterpret_cast<Line*>(options.apart ? memory->add("item lists", -1, lines * line_bytes, true) : p));
    auto* tree = region<TreeBudget>("budget", -1, static_cast<std::size_t>(trees), true);
    auto* worker = region<WorkerBudget>("budget", -1, static_cast<std::size_t>(options.workers), true);
    std::vector<const TreeBudget*> records;
    for (int t = 0; t < trees; ++t) {
        TreeBudget& r = tree[t];
        r.first_line = first[static_cast<std::size_t>(t)];
        r.grains = grains[static_cast<std::size_t>(t)];
        r.workers = workers_of(t);
        r.frame_workers = options.workers;
        r.tree = t;
        r.piece = std::clamp(r.grains / (64 * r.workers), 2, 64);
        while (r.grains >> r.epoch_log2 >= 2 << epochs_log2)
            ++r.epoch_log2;
        r.marks.set(region<std::int32_t>("budget", -1, static_cast<std::size_t>(r.grains), true));
        records.push_back(&r);
    }
    for (int w = 0; w < options.workers; ++w) {
        worker[w].tree.set(tree + options.tree_of_worker[static_cast<std::size_t>(w)]);
        header->workers.get()[w].budget.set(worker + w);
    }
    log = std::make_unique<BudgetLog>(*header, std::move(records), options.memory_bytes);
}

void Frame::Impl::reset_budget() {
    for (int w = 0; w < options.workers; ++w) {
        WorkerBudget& r = *header->workers.get()[w].budget.get();
        r.awake = r.groups = r.holes = -1;
        r.epoch = 0;
        r.era = 1;
        r.tile_grains = 0;
        TreeBudget& tree = *r.tree.get();
        memory->clear(*memory->find(memory->offset(tree.marks.get())));
        tree.gate.word = tree.cursor.word = 0;
        tree.era = tree.epoch = 1;
        tree.free_share = 1;
    }
    log->clear();
}

void Frame::Impl::deal_tiles(int first, int end) {
    // Who shows progress looks at them.
    const auto put = [](std::int32_t& word, std::int32_t value) {
        std::atomic_ref(word).store(value, std::memory_order_relaxed);
    };
    const std::int64_t tiles = std::max(end - first, 0);
    const std::int64_t strides =
        (tiles + (std::int64_t{1} << header->stride_log2) - 1) >> header->stride_log2;
    const std::int64_t workers = options.workers;
    // Whole multiples of a power of two, few enough that all lengths can be written; what is beyond the last
    // tile is nothing.
    std::int64_t grain = 1;
    const auto grains = [&] { return (strides + grain - 1) / grain; };
    while (grains() > workers * ((2 << stretch_mantissa) - 1))
        grain *= 2;
    put(header->tiles_first, first);
    put(header->tiles_end, end);
    put(header->queues.get()->stopped.word, 0);
    const auto begin = [&](std::int64_t place) { return grains() * place / workers * grain; };
    for (std::int64_t place = 0; place < workers; ++place)
        put(header->stretches.get()[place].left.word,
            pack_stretch(static_cast<std::int32_t>(begin(place)),
                         static_cast<std::int32_t>(begin(place + 1) - begin(place))));
    dealt.store(grains() * grain, std::memory_order_relaxed);
}

double Frame::Impl::taken() const {
    std::int64_t left = 0;
    for (int place = 0; place < options.workers; ++place) {
        std::int32_t& word = header->stretches.get()[place].left.word;
        left += stretch_length(std::atomic_ref(word).load(std::memory_order_relaxed));
    }
    const std::int64_t all = dealt.load(std::memory_order_relaxed);
    return all > 0 ? 1 - static_cast<double>(left) / static_cast<double>(all) : 1;
}

} // namespace razor
