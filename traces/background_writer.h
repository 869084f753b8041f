// Writes a trace on a thread of its own, in the order in which references come: what waits is at most two
// blocks.
#pragma once

#include "traces/block_builder.h"
#include "traces/writer.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace traces {

class BackgroundWriter {
public:
    /// `block`: references of a block, of 1 to `most_references`.
    BackgroundWriter(std::unique_ptr<Sink> sink, const Description& description, std::size_t block);
    /// Without finish(): the sink goes, uncommitted.
    ~BackgroundWriter();
    BackgroundWriter(const BackgroundWriter&) = delete;
    BackgroundWriter& operator=(const BackgroundWriter&) = delete;

    /// Names of sites, as of Writer. Before the references that use them.
    void add_sites(std::vector<std::string> names);
    /// Throws nothing, as those who are traced may be in the middle of anything: what cannot be written is
    /// dropped, and finish() says why.
    void add(const Reference& r) {
        if (coming_.references.size() >= block_ && !BlockBuilder::continues(r.what))
            hand_over();
        coming_.references.push_back(r);
    }
    /// A window, before the references that follow; or the end.
    void mark(const Turn& turn) {
        if (turn.what == Turn::What::window) {
            const std::size_t n = coming_.references.size();
            const bool idle = coming_.marks.size() >= n + most_idle_windows;
            if (n >= block_ || (n != 0 && idle))
                hand_over();
            else if (idle)
                coming_.marks.pop_back(); // there is no block without references
        }
        coming_.marks.push_back({coming_.references.size(), turn});
    }
    /// Waits for all, then ends the file with its index. Throws Error.
    void finish();

    /// Of a finished file.
    std::uint64_t bytes() const { return writer_.bytes(); }
    std::uint64_t references() const { return writer_.references(); }

private:
    struct Batch {
        struct Mark {
            std::size_t before; // so many of the references
            Turn turn;
        };
        std::vector<std::string> sites;
        std::vector<Reference> references;
        std::vector<Mark> marks;
    };
    void hand_over();
    void build();
    void write_all();
    void end();

    Writer writer_;
    BlockBuilder builder_;
    std::size_t block_;
    Batch coming_, leaving_;
    std::mutex mutex_;
    std::condition_variable changed_;
    bool full_ = false, ends_ = false; // something is in leaving_; nothing more comes
    std::exception_ptr error_;
    std::thread thread_; // the last: it uses all else
};

} // namespace traces
