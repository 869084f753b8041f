#include "traces/program/analyses.h"

namespace traces {

std::vector<std::unique_ptr<AnalysisCommand>> analyses() {
    std::vector<std::unique_ptr<AnalysisCommand>> out;
    for (const auto make : {curve_command, reuse_command, windows_command, causes_command, lines_command,
                            use_command, strides_command, footprint_command, replicas_command,
                            objects_command, picture_command, tiles_command, report_command})
        out.push_back(make());
#ifdef RAZOR_HAS_SIMULATED
    out.push_back(rows_command());
#endif
    return out;
}

} // namespace traces
