#pragma once
#include <functional>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"
#include "recon/models/pairs.h"

namespace ossa::tools {

/// Pairs of observed and true skeletons from files, folders or archives: the first of `observed`
/// belongs to the first of `truth`, and so on. Recordings in them are paired by name, single ones
/// on both sides whatever their names; others are left out, with a warning. So has a recording
/// whose clock is evidently not the truth's: times are taken as they are. Recordings of one
/// `observed` whose names begin with the same folder (or archive) are of one person. `read` (may be
/// empty) is called with the recordings of each file, for their warnings, and returns false to
/// stop: the pairs until then are returned. Throws InputError that names the files between which no
/// frame matches.
std::vector<recon::PosturePair> PairRecordings(
    const std::vector<std::string>& observed, const std::vector<std::string>& truth,
    const recon::SkeletonReadOptions& reading,
    const std::function<bool(const std::vector<recon::SkeletonClip>&)>& read = {});

}  // namespace ossa::tools
