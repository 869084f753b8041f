#include "sim/machine/scheduler.h"

#include "sim/machine/machine.h"

#include <algorithm>

namespace sim {

void Scheduler::add(std::uint32_t thread, std::function<void()> work) {
    threads_.resize(std::max<std::size_t>(threads_.size(), thread + 1));
    threads_[thread] = std::make_unique<Thread>();
    Thread* t = threads_[thread].get();
    t->number = thread;
    t->fibre = std::make_unique<Fibre>(
        stack_bytes_, [this, work = std::move(work)] { body(work); }, main_);
    push(key(0, thread));
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
        horizon_ = queue_.empty() ? ~Key{0} : queue_.front();
    else
        horizon_ = key(((k >> thread_bits) / quantum_ + 1) * quantum_, 0) - 1;
}

void Scheduler::yield(Key k) {
    if (cancelling_ || std::uncaught_exceptions() > 0)
        return; // unwinding: destructors act at once
    if (queue_.empty() || k < queue_.front()) {
        go_on(k);
        return;
    }
    std::uint32_t self = current_;
    Key next = queue_.front();
    std::pop_heap(queue_.begin(), queue_.end(), std::greater<>());
    queue_.back() = k;
    std::push_heap(queue_.begin(), queue_.end(), std::greater<>());
    go_on(next);
    threads_[self]->fibre->switch_to(*threads_[current_]->fibre);
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::sleep() {
    if (cancelling_)
        throw Cancelled{};
    std::uint32_t self = current_;
    if (queue_.empty()) {
        threads_[self]->fibre->switch_to(main_);
    } else {
        go_on(pop());
        threads_[self]->fibre->switch_to(*threads_[current_]->fibre);
    }
    if (cancelling_)
        throw Cancelled{};
}

void Scheduler::wake(Key k) {
    push(k);
    if (exact())
        horizon_ = std::min(horizon_, k);
}

void Scheduler::call(std::function<void()> request) {
    if (cancelling_)
        return;
    std::uint32_t self = current_;
    request_ = std::move(request);
    threads_[self]->fibre->switch_to(main_);
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

void Scheduler::run(const std::function<std::string()>& stuck) {
    while (unfinished_ > 0 && !failure_) {
        if (request_) {
            auto request = std::move(request_);
            request_ = nullptr;
            try {
                request();
            } catch (...) {
                failure_ = std::current_exception();
                break;
            }
        } else if (queue_.empty()) {
            failure_ = std::make_exception_ptr(Deadlock(stuck()));
            break;
        } else {
            go_on(pop());
        }
        main_.switch_to(*threads_[current_]->fibre);
    }
    if (failure_) {
        cancel();
        std::rethrow_exception(failure_);
    }
}

} // namespace sim
