#pragma once
#include <cstddef>
#include <functional>

namespace ossa::tools {

/// Runs job(0) to job(count - 1) on so many threads, each once, in no promised order. The first
/// failure is thrown when all threads have ended.
void RunJobs(size_t count, int threads, const std::function<void(size_t)>& job);

/// Processor time of this thread: what others do on the machine does not count.
double ProcessorTime_ms();

}  // namespace ossa::tools
