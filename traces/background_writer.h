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
        coming_.references.push_back(r);
        if (coming_.references.size() >= block_)
            hand_over();
    }
    /// Waits for all, then ends the file with its index. Throws Error.
    void finish();

    /// Of a finished file.
    std::uint64_t bytes() const { return writer_.bytes(); }
    std::uint64_t references() const { return writer_.references(); }

private:
    struct Batch {
        std::vector<std::string> sites;
        std::vector<Reference> references;
    };
    void hand_over();
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
