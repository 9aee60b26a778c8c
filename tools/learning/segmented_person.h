#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/synth/dataset.h"

namespace ossa::tools {

/// The pixels that a segmenter assigns to the person, row-major, 1 or 0: those of the body, except
/// those that may be floor (the soles, if the floor is known), and those of objects held or in
/// front (part 32) that are connected to the body without a depth discontinuity, such as a held
/// box, but not a table. Pixels without a reading are 0.
std::vector<uint8_t> SegmentedPerson(const LabelledFrame& frame, int id);

/// A person of a frame as input of learning, in the uncropped image.
struct SegmentedFrame {
  LabelledFrame frame;
  TruthBody body;
  std::vector<uint8_t> is_person;  // SegmentedPerson
};

/// One person of a data set's frame; of several people each frame takes the next one. Empty if too
/// little of the person is visible. Throws as DatasetReader::Read does.
std::optional<SegmentedFrame> ReadSegmented(const DatasetReader& reader, int64_t index);

/// Renders the floor, if the frame has one, into pixels without a reading: data sets have no
/// background, but real people stand on a floor.
void LayFloor(LabelledFrame* frame);

}  // namespace ossa::tools
