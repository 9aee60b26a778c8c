#pragma once
#include <cstddef>
#include <functional>

namespace ossa::tools {

/// Runs job(0) to job(count - 1), each once and in any order, on `threads` threads. After all
/// threads have ended, the first exception is thrown again.
void RunJobs(size_t count, int threads, const std::function<void(size_t)>& job);

/// Processor time of this thread, milliseconds; independent of other load.
double ProcessorTime_ms();

}  // namespace ossa::tools
