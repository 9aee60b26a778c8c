#pragma once
#include <functional>
#include <string>

namespace ossa::commands {

/// For depth::SourceOptions::keep_waiting: says once that `source` is waited for, unless quiet, and
/// gives up at Ctrl-C.
std::function<bool()> KeepWaitingFor(const std::string& source, bool quiet);

}  // namespace ossa::commands
