#include "sim/machine/beyond.h"

#include <algorithm>
#include <tuple>

namespace sim {
namespace {

bool after(const Request& a, const Request& b) {
    return std::tie(a.at, a.tile, a.sequence) > std::tie(b.at, b.tile, b.sequence);
}

} // namespace

Beyond::Beyond(const Config& config, Reply reply)
    : ports_(static_cast<std::size_t>(config.chip.tiles),
             Port{OrderedPool(static_cast<std::size_t>(config.l2.mshrs)),
                  OrderedPool(static_cast<std::size_t>(config.l2.write_back_buffer))}),
      memory_(config, 4096), reply_(std::move(reply)) {}

void Beyond::push(const Request& r) {
    waiting_.push_back(r);
    std::push_heap(waiting_.begin(), waiting_.end(), after);
}

Request Beyond::pop() {
    std::pop_heap(waiting_.begin(), waiting_.end(), after);
    Request r = waiting_.back();
    waiting_.pop_back();
    return r;
}

void Beyond::accept(std::vector<Request>& leaving) {
    for (Request& r : leaving) {
        r.at = std::max(r.at, served_); // a thread that was behind: what is served stays served
        push(r);
    }
    leaving.clear();
}

void Beyond::serve(cycle end) {
    while (!waiting_.empty() && waiting_.front().at < end) {
        Request r = pop();
        served_ = r.at;
        Port& port = ports_[r.tile];
        if (r.write != Request::nothing) {
            OrderedPool::Grant buffer = port.write_backs.take(r.at);
            if (buffer.at > r.at) {
                r.at = buffer.at;
                push(r);
                continue;
            }
            port.write_backs.hold(buffer.entry, memory_.write(r.write, r.at));
            r.write = Request::nothing;
        }
        if (r.read == Request::nothing)
            continue;
        OrderedPool::Grant mshr = port.mshrs.take(r.at);
        if (mshr.at > r.at) {
            r.at = mshr.at;
            push(r);
            continue;
        }
        cycle ready = memory_.read(r.read, r.at);
        port.mshrs.hold(mshr.entry, ready);
        reply_(r.tile, r.ticket, ready);
    }
    if (end != everything)
        served_ = std::max(served_, end);
}

} // namespace sim
