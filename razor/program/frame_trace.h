// The trace that razor render --trace writes.
#pragma once

#include "razor/native/render.h"

#include <memory>
#include <string>

namespace razor {

class FrameRecorder;

class FrameTrace {
public:
    /// Throws UserError where the file cannot be written, or this build cannot record.
    FrameTrace(const std::string& file, const std::string& configuration);
    ~FrameTrace();
    /// A renderer with these options records its frame.
    void record_by(RenderOptions& options);
    /// Ends the file, which gets its name; a line that says what is in it. Throws UserError.
    std::string finish();

private:
    std::unique_ptr<FrameRecorder> recorder_;
};

} // namespace razor
