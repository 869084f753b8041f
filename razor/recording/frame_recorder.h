// A frame's memory references as a trace, without a machine: the simulated kernels render it on the host, and
// the timing port records what they load and store. Workers are threads that take turns of some thousand
// operations, so that the trace of a scene is always the same.
#pragma once

#include "razor/frame/frame.h"
#include "traces/background_writer.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace razor {

class FrameRecorder {
public:
    /// `program`, `configuration`: for the trace's description.
    FrameRecorder(std::unique_ptr<traces::Sink> sink, std::string program, std::string configuration);
    ~FrameRecorder();

    static const KernelTable& kernels();
    /// Renders a frame with them; once. Throws what a worker threw, Cancelled, traces::Error.
    void run(Frame& frame, const std::function<void(double)>& progress, const std::atomic<bool>* cancel);
    /// Ends the file, which gets its name. Throws traces::Error.
    void finish() { writer_->finish(); }

    /// Of a finished file.
    std::uint64_t references() const { return writer_->references(); }
    std::uint64_t bytes() const { return writer_->bytes(); }

    class Worker; // what the port knows of a thread that runs one

private:
    traces::Description describe(Frame& frame);
    std::uint64_t site(const char* file, std::uint32_t line);

    std::unique_ptr<traces::Sink> sink_;
    std::string program_, configuration_;
    std::optional<traces::BackgroundWriter> writer_;
    std::map<std::string, std::uint16_t> structures_; // numbers of names
    std::vector<std::uint16_t> structure_of_region_;
    traces::Picture picture_;
    struct Place {
        const char* file;
        std::uint32_t line;
        bool operator==(const Place&) const = default;
    };
    struct Hash {
        std::size_t operator()(const Place& p) const {
            return std::hash<const void*>()(p.file) ^ p.line * std::size_t{0x9E3779B97F4A7C15U};
        }
    };
    std::unordered_map<Place, std::uint64_t, Hash> sites_;
    std::map<std::string, std::uint64_t> site_numbers_; // names may be several places'
    std::uint64_t time_ = 0;                            // operations of all workers
};

} // namespace razor
