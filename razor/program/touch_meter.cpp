#include "razor/program/touch_meter.h"

#ifdef RAZOR_HAS_RECORDING
#include "razor/recording/touched_lines.h"

#include <memory>
#endif

namespace razor {

bool can_measure_touch() {
#ifdef RAZOR_HAS_RECORDING
    return true;
#else
    return false;
#endif
}

TouchMeter touch_meter() {
#ifdef RAZOR_HAS_RECORDING
    return [lines = std::make_shared<TouchedLines>()](Frame& frame, const SeeArguments& packet) {
        return lines->measure(frame, packet);
    };
#else
    return {};
#endif
}

} // namespace razor
