// Compression as gzip, xz and zstd do, on the way to a sink.
#pragma once

#include "traces/io/sink.h"

namespace traces {

/// By how the name ends: .gz, .xz, .zst; else the sink itself.
std::unique_ptr<Sink> compressing(std::unique_ptr<Sink> sink, const std::string& name);

} // namespace traces
