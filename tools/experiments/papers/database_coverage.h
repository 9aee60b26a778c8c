#pragma once
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::recon {
class PostureDatabase;  // recon/database/posture_database.h
}

namespace ossa::tools {

/// Mean joint distance of recorded postures from the nearest posture of a database, both
/// normalised, by exercise (the part of a clip's name between the slash and the first underscore):
/// a lower bound for methods that use the database.
Table CoverageTable(const recon::PostureDatabase& database, const std::vector<RecordedPair>& clips);

}  // namespace ossa::tools
