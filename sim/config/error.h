// A mistake in a machine's description: one clear line, exit code 2.
#pragma once

#include <stdexcept>

namespace sim {

/// what() is one line: file:line:column (or the override), cause, mend.
class ConfigError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace sim
