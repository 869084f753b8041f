#include "razor/program/frame_trace.h"

#include "razor/scene/error.h"

#ifdef RAZOR_HAS_RECORDING

#include "razor/program/arguments.h"
#include "razor/recording/frame_recorder.h"
#include "traces/error.h"
#include "traces/formats/format.h"

#include <fmt/format.h>

#include <algorithm>

namespace razor {
namespace {

template <class Work> auto with_user_errors(Work work) {
    try {
        return work();
    } catch (const traces::Error& error) {
        throw UserError(error.what());
    }
}

} // namespace

FrameTrace::FrameTrace(const std::string& file, const std::string& configuration) {
    recorder_ = with_user_errors([&] {
        traces::check_own_name(file);
        return std::make_unique<FrameRecorder>(traces::open_sink(file), fmt::format("razor {}", version()),
                                               configuration);
    });
}

FrameTrace::~FrameTrace() = default;

void FrameTrace::record_by(RenderOptions& options) {
    options.kernels = &FrameRecorder::kernels();
    options.run = [this, cancel = options.cancel](Frame& frame, const std::function<void(double)>& progress) {
        with_user_errors([&] { recorder_->run(frame, progress, cancel); });
    };
}

std::string FrameTrace::finish() {
    with_user_errors([&] { recorder_->finish(); });
    return fmt::format("trace: {} references in {} bytes, {:.2f} bytes each", recorder_->references(),
                       recorder_->bytes(),
                       static_cast<double>(recorder_->bytes()) /
                           static_cast<double>(std::max<std::uint64_t>(1, recorder_->references())));
}

} // namespace razor

#else

namespace razor {

class FrameRecorder {};

FrameTrace::FrameTrace(const std::string&, const std::string&) {
    throw UserError(
        "--trace: this build has no simulated kernels; build with `simulated` among RAZOR_TARGETS");
}
FrameTrace::~FrameTrace() = default;
void FrameTrace::record_by(RenderOptions&) {}
std::string FrameTrace::finish() {
    return {};
}

} // namespace razor

#endif
