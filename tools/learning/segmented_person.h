#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// The pixels that a segmenter takes for the person's, row-major: 1 for those of the body but for
/// what may be the floor's as well (the soles, where the floor is known), and, of the things held
/// or standing before them (part 32), for those whose surface goes on from there without a jump in
/// depth. A table before the person is none of theirs, a box in their hands is. Pixels without a
/// reading are nobody's.
std::vector<uint8_t> SegmentedPerson(const LabelledFrame& frame, int id);

/// A person of a frame as a learner sees them, in an image of its own whole size.
struct SegmentedFrame {
  LabelledFrame frame;
  TruthBody body;
  std::vector<uint8_t> is_person;  // SegmentedPerson
};

/// One person of a data set's frame, in turn where there are several; nothing where too little of
/// them is seen. Throws as DatasetReader::Read does.
std::optional<SegmentedFrame> ReadSegmented(const DatasetReader& reader, int64_t index);

/// Puts the floor, where the frame knows it, into the pixels without a reading: data sets are
/// rendered without a background, but nobody stands on nothing.
void LayFloor(LabelledFrame* frame);

}  // namespace ossa::tools
