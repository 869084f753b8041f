#include "analysis/traces/object_lru.h"

namespace analysis {

void ObjectLru::unlink(std::uint32_t at) {
    const Node& n = nodes_[at];
    (n.before == none ? front_ : nodes_[n.before].after) = n.after;
    (n.after == none ? back_ : nodes_[n.after].before) = n.before;
    held_ -= n.bytes;
}

void ObjectLru::drop(std::uint32_t at) {
    unlink(at);
    places_.erase(nodes_[at].object);
    free_.push_back(at);
}

bool ObjectLru::touch(std::uint64_t object, std::uint64_t bytes) {
    std::uint32_t& place = places_[object];
    const bool hit = place != none;
    if (hit) {
        unlink(place);
    } else if (free_.empty()) {
        place = static_cast<std::uint32_t>(nodes_.size());
        nodes_.emplace_back();
    } else {
        place = free_.back();
        free_.pop_back();
    }
    const std::uint32_t at = place;
    nodes_[at] = {object, bytes, none, front_};
    (front_ == none ? back_ : nodes_[front_].before) = at;
    front_ = at;
    held_ += bytes;
    if (bytes > capacity_)
        drop(at);
    while (held_ > capacity_)
        drop(back_);
    return hit;
}

} // namespace analysis
