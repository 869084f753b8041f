#include "sim/machine/scheduler.h"

namespace sim {

void Scheduler::add(std::uint32_t thread, cycle t, std::function<void()> work,
                    std::function<void()> prefetch) {
    threads_.resize(std::max<std::size_t>(threads_.size(), thread + 1));
    threads_[thread] = std::make_unique<Thread>(
        thread, std::move(prefetch), stack_bytes_, [this, work = std::move(work)] { body(work); }, main_);
    turns_.admit(thread);
    push(key(t, thread));
    ++unfinished_;
}

void Scheduler::body(const std::function<void()>& work) {
    if (!cancelling_) {
        try {
            work();
        } catch (const Cancelled&) {
        } catch (...) {
            if (!failure_)
                failure_ = std::current_exception();
        }
    }
    --unfinished_;
}

Scheduler::Key Scheduler::pop() {
    const Key k = turns_.first();
    turns_.set(thread_of(k), Turns::none);
    return k;
}

/// Bookkeeping of the thread that runs from now on, with its next operation at `k`.
void Scheduler::go_on(Key k) {
    current_ = thread_of(k);
    if (exact())
        horizon_ = std::min({limit_ - 1, turns_.first(), first_event() - 1});
    else if (whole_windows_)
        horizon_ = limit_ - 1;
    else
        horizon_ = std::min(limit_, key((cycle_of(k) / quantum_ + 1) * quantum_, 0)) - 1;
}

/// Many threads' work does not fit into the host's caches: that of the one after the next.
void Scheduler::prefetch_next() const {
    const Key next = turns_.first();
    if (next == Turns::none)
        return;
    const Thread& t = *threads_[thread_of(next)];
    t.fibre.prefetch();
    if (t.prefetch)
        t.prefetch();
}

/// All that come before the earliest thread.
void Scheduler::let_events_happen() {
    for (Key first = first_event(); first < limit_ && first <= turns_.first(); first = first_event())
        events_->step();
}

/// From the thread that runs, which is in the queue or parked, to the next one.
void Scheduler::leave() {
    const std::uint32_t left = current_;
    Fibre& self = threads_[left]->fibre;
    if (events_ != nullptr && !stepping_)
        let_events_happen();
    if (stepping_ || turns_.first() >= limit_) {
        self.switch_to(main_);
    } else {
        go_on(pop());
        prefetch_next();
        if (current_ != left)
            self.switch_to(threads_[current_]->fibre);
    }
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::yield(Key k) {
    if (cancelling_ || std::uncaught_exceptions() > 0)
        return; // unwinding: destructors act at once
    if (!stepping_ && k < limit_ && k < turns_.first() && k < first_event()) {
        go_on(k);
        return;
    }
    push(k);
    leave();
}

void Scheduler::park() {
    if (cancelling_)
        throw Cancelled{};
    leave();
}

void Scheduler::wake(Key k) {
    push(k);
    if (exact())
        horizon_ = std::min(horizon_, k);
}

void Scheduler::call(std::function<void()> request) {
    if (cancelling_)
        return;
    request_ = std::move(request);
    threads_[current_]->fibre.switch_to(main_);
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::cancel() {
    cancelling_ = true;
    for (auto& t : threads_)
        if (t != nullptr && !t->fibre.finished()) {
            current_ = t->number;
            main_.switch_to(t->fibre);
        }
}

void Scheduler::step(std::uint32_t thread) {
    stepping_ = true;
    current_ = thread;
    horizon_ = 0;
    main_.switch_to(threads_[thread]->fibre);
    stepping_ = false;
}

void Scheduler::run(cycle end) {
    limit_ = key(end, 0);
    while (!failure_) {
        if (request_) {
            auto request = std::move(request_);
            request_ = nullptr;
            try {
                request();
            } catch (...) {
                failure_ = std::current_exception();
                return;
            }
        } else {
            if (events_ != nullptr)
                let_events_happen();
            if (turns_.first() >= limit_)
                return;
            go_on(pop());
            prefetch_next();
        }
        main_.switch_to(threads_[current_]->fibre);
    }
}

} // namespace sim
