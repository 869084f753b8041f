// A mistake in what the user gave us, or damage to a file: one clear line, exit code 2.
#pragma once

#include <stdexcept>

namespace traces {

/// what() is one line: file, place, cause, mend.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace traces
