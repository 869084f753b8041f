#include "traces/background_writer.h"

#include <iterator>
#include <utility>

namespace traces {

BackgroundWriter::BackgroundWriter(std::unique_ptr<Sink> sink, const Description& description,
                                   std::size_t block)
    : writer_(std::move(sink), description), block_(block), thread_([this] { write_all(); }) {}

BackgroundWriter::~BackgroundWriter() {
    end();
}

void BackgroundWriter::add_sites(std::vector<std::string> names) {
    std::move(names.begin(), names.end(), std::back_inserter(coming_.sites));
}

/// Waits until the batch before is written.
void BackgroundWriter::hand_over() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !full_; });
    std::swap(coming_, leaving_);
    full_ = true;
    lock.unlock();
    changed_.notify_all();
}

void BackgroundWriter::build() {
    std::size_t next = 0;
    const auto add_up_to = [&](std::size_t end) {
        for (; next < end; ++next)
            builder_.add(leaving_.references[next]);
    };
    for (const Batch::Mark& m : leaving_.marks) {
        add_up_to(m.before);
        builder_.mark(m.turn);
    }
    add_up_to(leaving_.references.size());
}

void BackgroundWriter::write_all() {
    Block block;
    for (;;) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return full_ || ends_; });
        if (!full_)
            return;
        lock.unlock();
        try {
            if (!error_) {
                writer_.add_sites(leaving_.sites);
                build();
                builder_.take(block);
                writer_.write(block);
            }
        } catch (...) {
            error_ = std::current_exception();
        }
        leaving_.sites.clear();
        leaving_.references.clear();
        leaving_.marks.clear();
        lock.lock();
        full_ = false;
        lock.unlock();
        changed_.notify_all();
    }
}

void BackgroundWriter::end() {
    {
        const std::scoped_lock lock(mutex_);
        ends_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

void BackgroundWriter::finish() {
    hand_over();
    end();
    if (error_)
        std::rethrow_exception(error_);
    writer_.finish();
}

} // namespace traces
