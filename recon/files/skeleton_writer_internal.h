#pragma once
#include <string>

#include "recon/files/skeleton_writer.h"

namespace ossa::recon {

class SkeletonWriter::Format {
 public:
  virtual ~Format() = default;
  virtual void Write(const SkeletonFrame& frame) = 0;
  virtual void Finish() = 0;
  virtual int64_t FinishWithWhatFits() = 0;
  virtual void SetShape(int /*id*/, const ShapeVector& /*shape*/) {}  // optional
};

class PeopleLog;
/// Throws InputError if the recording has no people. `path`: the file to be written.
void RequirePeople(const PeopleLog& people, const std::filesystem::path& path);

/// `path` for the first person (`index` 0); for others with `_ID` before the extension.
std::filesystem::path PathForBody(const std::filesystem::path& path, size_t index, int id);

std::unique_ptr<SkeletonWriter::Format> NewTrcWriter(const std::filesystem::path& path);
std::unique_ptr<SkeletonWriter::Format> NewBvhWriter(const std::filesystem::path& path,
                                                     BvhNames names);
std::unique_ptr<SkeletonWriter::Format> NewGltfWriter(const std::filesystem::path& path,
                                                      const SkeletonWriteOptions& options);

}  // namespace ossa::recon
