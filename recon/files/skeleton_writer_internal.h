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
  virtual void SetShape(int /*id*/, const ShapeVector& /*shape*/) {}  // most show no bodies
};

class PeopleLog;
/// Throws InputError where nobody is anywhere in the recording. `path`: of the file to be.
void ExpectSomebody(const PeopleLog& people, const std::filesystem::path& path);

/// `path`, of the first person (`index` 0) as it is, of another with `_ID` before the extension.
std::filesystem::path PathForBody(const std::filesystem::path& path, size_t index, int id);

std::unique_ptr<SkeletonWriter::Format> NewTrcWriter(const std::filesystem::path& path);
std::unique_ptr<SkeletonWriter::Format> NewBvhWriter(const std::filesystem::path& path,
                                                     BvhNames names);
std::unique_ptr<SkeletonWriter::Format> NewGltfWriter(const std::filesystem::path& path,
                                                      const SkeletonWriteOptions& options);

}  // namespace ossa::recon
