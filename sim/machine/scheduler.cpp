#include "sim/machine/scheduler.h"

namespace sim {

void Scheduler::add(std::uint32_t thread, cycle t, std::function<void()> work,
                    std::function<void()> prefetch) {
    threads_.resize(std::max<std::size_t>(threads_.size(), thread + 1));
    threads_[thread] = std::make_unique<Thread>();
    threads_[thread]->number = thread;
    threads_[thread]->prefetch = std::move(prefetch);
    threads_[thread]->fibre = std::make_unique<Fibre>(
        stack_bytes_, [this, work = std::move(work)] { body(work); }, main_);
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

void Scheduler::push(Key k) {
    queue_.push_back(k);
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
}

Scheduler::Key Scheduler::pop() {
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    Key k = queue_.back();
    queue_.pop_back();
    return k;
}

/// Bookkeeping of the thread that runs from now on, with its next operation at `k`.
void Scheduler::go_on(Key k) {
    current_ = static_cast<std::uint32_t>(k & ((Key{1} << thread_bits) - 1));
    if (exact())
        horizon_ =
            std::min(queue_.empty() ? limit_ - 1 : std::min(limit_ - 1, queue_.front()), first_event() - 1);
    else if (whole_windows_)
        horizon_ = limit_ - 1;
    else
        horizon_ = std::min(limit_, key((cycle_of(k) / quantum_ + 1) * quantum_, 0)) - 1;
}

/// Many threads' work does not fit into the host's caches: that of the one after the next.
void Scheduler::prefetch_next() const {
    if (queue_.empty())
        return;
    const Thread& t = *threads_[queue_.front() & ((Key{1} << thread_bits) - 1)];
    t.fibre->prefetch();
    if (t.prefetch)
        t.prefetch();
}

/// All that come before the earliest thread.
void Scheduler::let_events_happen() {
    for (Key first = first_event(); first < limit_ && (queue_.empty() || first <= queue_.front());
         first = first_event())
        events_->step();
}

/// From the thread that runs, which is in the queue or parked, to the next one.
void Scheduler::leave() {
    const std::uint32_t left = current_;
    Fibre& self = *threads_[left]->fibre;
    if (events_ != nullptr && !stepping_)
        let_events_happen();
    if (stepping_ || queue_.empty() || queue_.front() >= limit_) {
        self.switch_to(main_);
    } else {
        go_on(pop());
        prefetch_next();
        if (current_ != left)
            self.switch_to(*threads_[current_]->fibre);
    }
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::yield(Key k) {
    if (cancelling_ || std::uncaught_exceptions() > 0)
        return; // unwinding: destructors act at once
    if (!stepping_ && k < limit_ && (queue_.empty() || k < queue_.front()) && k < first_event()) {
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
    threads_[current_]->fibre->switch_to(main_);
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::cancel() {
    cancelling_ = true;
    for (auto& t : threads_)
        if (t != nullptr && !t->fibre->finished()) {
            current_ = t->number;
            main_.switch_to(*t->fibre);
        }
}

void Scheduler::step(std::uint32_t thread) {
    stepping_ = true;
    current_ = thread;
    horizon_ = 0;
    main_.switch_to(*threads_[thread]->fibre);
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
            if (queue_.empty() || queue_.front() >= limit_)
                return;
            go_on(pop());
            prefetch_next();
        }
        main_.switch_to(*threads_[current_]->fibre);
    }
}

} // namespace sim
