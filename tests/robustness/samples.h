#pragma once
#include <vector>

#include "tests/robustness/damage.h"

namespace ossa::test {

/// One of every format that carries a checksum: .ossa, .ossadb, .ossagp, .ossarefine, .ossaprior,
/// our .oni, PNG, .gz, .tar.gz, .zip, packed shards.
std::vector<DamageSample> ChecksummedSamples();

}  // namespace ossa::test
