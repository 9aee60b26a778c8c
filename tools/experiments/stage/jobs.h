#pragma once
#include <cstddef>
#include <functional>

namespace ossa::tools {

/// Runs job(0) to job(count - 1) on so many threads, each once, in no promised order. The first
/// failure is thrown when all threads have ended.
void RunJobs(size_t count, int threads, const std::function<void(size_t)>& job);

}  // namespace ossa::tools
