// Decompression of what gzip, xz and zstd wrote, as a source of bytes: streaming, in bounded memory.
#pragma once

#include "traces/io/source.h"

namespace traces {

/// The source itself, or, by its first bytes, what it decompresses to. Damage throws Error when it is met.
std::unique_ptr<PeekingSource> decompressed(std::unique_ptr<PeekingSource> source);

} // namespace traces
