// Motion capture as text: BVH, Acclaim ASF with AMC, pybullet's JSON; mapping files. The first byte
// of an input chooses which. What is accepted must also yield its frames, a BVH of a person its
// motion on the body.
#include <cmath>
#include <cstdint>
#include <memory>

#include "recon/motion/acclaim_internal.h"
#include "recon/motion/bone_names_internal.h"
#include "recon/motion/bvh.h"
#include "recon/motion/bvh_source_internal.h"
#include "recon/motion/humanoid3d_internal.h"
#include "recon/motion/retarget_internal.h"
#include "tests/fuzz/outcome.h"
#include "tests/fuzz/seeds.h"
#include "tests/recon/motion/acclaim_texts.h"
#include "tests/recon/motion/bvh_texts.h"
#include "tests/recon/motion/figure.h"

namespace {

using namespace ossa::recon;

const std::string kAmc = "#!OML:ASF x.asf\n:FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 15 0 0 0 0\n";

void UseFrames(const SourceMotion& motion) {
  if (motion.frame_count == 0) abort();
  for (const size_t at : {size_t{0}, motion.frame_count - 1}) {
    if (motion.frame(at).position.size() != motion.joints.size()) abort();
  }
}

void UseBvh(const std::string& text) {
  const BvhFile bvh = ParseBvh(text, "x.bvh");
  if (bvh.FrameCount() > 0 && ComputePose(bvh, 0).position.size() != bvh.joints.size()) abort();
  // What we write of it reads as the same.
  const BvhFile again = ParseBvh(FormatBvh(bvh), "again.bvh");
  if (again.joints.size() != bvh.joints.size() || again.values.size() != bvh.values.size()) abort();
  for (BvhFile& root : SplitRoots(again)) {
    const SourceMotion motion = ToSourceMotion(std::move(root), "root.bvh");
    if (motion.frame_count > 100) continue;  // of a hostile frame time, resampling makes millions
    const MotionClip clip = Retarget(motion, FindBones(motion, nullptr), motion.frame_s);
    for (const RigPose& pose : clip.frames) {
      if (!pose.root_m.allFinite() || !pose.world_from_rest[0].coeffs().allFinite()) abort();
    }
  }
}

void UseMapping(const std::string& text) {
  const BoneMapping mapping = ParseBoneMapping(text, "names.txt");
  static const SourceMotion motion = ToSourceMotion(ParseBvh(test::FigureBvh(), "x.bvh"), "x.bvh");
  if (FindBones(motion, &mapping).hips < 0) abort();
}

void UseAsf(const std::string& text) {
  const auto skeleton = std::make_shared<const AcclaimSkeleton>(ParseAsf(text, "x.asf"));
  UseFrames(ParseAmc(kAmc, "x.amc", skeleton, 1.0 / 120.0));
}

void UseAmc(const std::string& text) {
  static const auto skeleton =
      std::make_shared<const AcclaimSkeleton>(ParseAsf(TPoseAsf(), "x.asf"));
  UseFrames(ParseAmc(text, "x.amc", skeleton, 1.0 / 120.0));
}

void UseHumanoid(const std::string& text) { UseFrames(ParseHumanoid3d(text, "x.txt")); }

}  // namespace

std::vector<std::string> ossa::fuzz::Seeds() {
  std::string frame = "[0.03";
  for (int i = 1; i < 44; ++i) frame += i % 4 == 0 ? ",1" : ",0";
  frame += "]";
  std::string zeros;
  for (size_t i = 0; i < kTPoseChannels; ++i) zeros += "0 ";
  return {"b" + TPoseHierarchy() + "MOTION\nFrames: 1\nFrame Time: 0.05\n" + zeros + "\n",
          "b" + test::FigureBvh(),
          "b" + test::FigureBvh({.bones_along_x = true}),
          "pHips = Hips\nElbowLeft=LeftForeArm # ours\nrest = frame 3\n",
          "s" + TPoseAsf(),
          "m" + kAmc + "lowerback 1 2 3\n",
          "j{\"Loop\":\"wrap\",\"Frames\":[" + frame + "," + frame + "]}"};
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  ossa::fuzz::ExpectValueOrOneLine([&] {
    switch (data[0] % 5) {
      case 'b' % 5:
        return UseBvh(text);
      case 's' % 5:
        return UseAsf(text);
      case 'm' % 5:
        return UseAmc(text);
      case 'p' % 5:
        return UseMapping(text);
      default:
        return UseHumanoid(text);
    }
  });
  return 0;
}
