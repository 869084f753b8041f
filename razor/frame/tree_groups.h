// Who shares a kd-tree where nothing is known of the machine but the number of workers.
#pragma once

#include <vector>

namespace razor {

/// The tree of each worker: workers 0 .. n-1 share the first, the next n the second and so on; 0: all share
/// one.
inline std::vector<int> tree_groups(int workers, int n) {
    std::vector<int> trees(static_cast<std::size_t>(workers));
    for (int w = 0; w < workers; ++w)
        trees[static_cast<std::size_t>(w)] = n <= 0 ? 0 : w / n;
    return trees;
}

} // namespace razor
