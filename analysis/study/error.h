// A mistake in a study's file or folder: one clear line, exit code 2.
#pragma once

#include <stdexcept>

namespace analysis {

/// what() is one line: file, place, cause, mend.
class StudyError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace analysis
