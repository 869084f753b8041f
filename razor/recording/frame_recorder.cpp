#include "razor/recording/frame_recorder.h"

#include "razor/frame/kernel_table.h"
#include "razor/frame/phases.h"
#include "razor/frame/ray_kinds.h"
#include "razor/native/render.h"
#include "razor/recording/worker.h"
#include "traces/site_name.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {

constinit thread_local FrameRecorder::Worker* recorded_worker = nullptr;

namespace {

constexpr std::size_t block_references = std::size_t{1} << 18;

} // namespace

FrameRecorder::FrameRecorder(std::unique_ptr<traces::Sink> sink, std::string program,
                             std::string configuration)
    : sink_(std::move(sink)), program_(std::move(program)), configuration_(std::move(configuration)) {}

FrameRecorder::~FrameRecorder() = default;

const KernelTable& FrameRecorder::kernels() {
    return simulated::kernels;
}

/// Also numbers the structures of the frame's regions.
traces::Description FrameRecorder::describe(Frame& frame) {
    traces::Description d;
    d.program = program_ + ", without a machine"; // nor its spilled registers
    d.level = "core";
    d.time = "instructions"; // operations of the vocabulary, of all workers
    d.configuration = configuration_;
    d.phases.assign(std::begin(phase_names), std::end(phase_names));
    d.work.assign(std::begin(kind_names), std::end(kind_names));
    d.picture = picture_ = {static_cast<std::uint32_t>(frame.header().width),
                            static_cast<std::uint32_t>(frame.header().height), tile_side};
    for (int worker = 0; worker < frame.workers(); ++worker)
        d.streams.push_back(fmt::format("worker {}", worker));
    for (const isa::region& r : frame.memory().regions()) {
        const auto [found, fresh] =
            structures_.try_emplace(r.structure, static_cast<std::uint16_t>(d.structures.size()));
        if (fresh)
            d.structures.push_back(r.structure);
        structure_of_region_.push_back(found->second);
    }
    return d;
}

std::uint64_t FrameRecorder::site(const char* file, std::uint32_t line) {
    std::uint64_t& number = sites_[{file, line}];
    if (number == 0) {
        const std::string name = traces::site_name(file, line);
        const auto [found, fresh] = site_numbers_.try_emplace(name, site_numbers_.size() + 1);
        number = found->second;
        if (fresh)
            writer_->add_sites({name});
    }
    return number;
}

void FrameRecorder::Worker::note(traces::Kind what, const void* p, std::uint32_t bytes) {
    const std::vector<isa::region>& regions = space_.regions();
    const std::uint64_t address = space_.offset(p);
    if (address < regions[region_].begin || address >= regions[region_].end) {
        const auto after =
            std::upper_bound(regions.begin(), regions.end(), address,
                             [](std::uint64_t a, const isa::region& r) { return a < r.begin; });
        region_ = static_cast<std::size_t>(std::max<std::ptrdiff_t>(0, after - regions.begin() - 1));
    }
    recorder_.writer_->add({recorder_.time_,
                            address,
                            static_cast<std::uint32_t>(number_),
                            {site_, bytes, recorder_.structure_of_region_[region_],
                             static_cast<std::uint16_t>(phase), static_cast<std::uint16_t>(kind), what},
                            recorder_.picture_.tile_of(pixel)});
}

void FrameRecorder::run(Frame& frame, const std::function<void(double)>& progress,
                        const std::atomic<bool>* cancel) {
    writer_.emplace(std::move(sink_), describe(frame), block_references);
    Turns turns(static_cast<std::size_t>(frame.workers()));
    run_workers(
        frame,
        [&](int number) {
            Worker worker(*this, frame.memory(), turns, static_cast<std::size_t>(number));
            struct Turn { // also where the worker throws
                Turn(Turns& turns, int number, Worker& worker)
                    : turns(turns), number(static_cast<std::size_t>(number)) {
                    turns.begin(this->number);
                    recorded_worker = &worker;
                }
                ~Turn() {
                    recorded_worker = nullptr;
                    turns.end(number);
                }
                Turn(const Turn&) = delete;
                Turn& operator=(const Turn&) = delete;
                Turns& turns;
                std::size_t number;
            } turn(turns, number, worker);
            try {
                frame.render(kernels(), number);
            } catch (...) {
                frame.stop(); // before others have their turn
                throw;
            }
        },
        progress, cancel);
}

} // namespace razor
