#pragma once
#include "tools/experiments/compare/recordings.h"
#include "tools/experiments/experiment.h"

namespace ossa::recon {
class PostureDatabase;  // recon/database/posture_database.h
}

namespace ossa::tools {

/// How far the postures of people are from the nearest one of a database: the mean joint
/// distance, normalised and of the standard size, by exercise (the part of a clip's name between
/// the slash and the first underscore). What a database lacks, no method that looks postures up in
/// it can give.
Table CoverageTable(const recon::PostureDatabase& database, const std::vector<RecordedPair>& clips);

}  // namespace ossa::tools
