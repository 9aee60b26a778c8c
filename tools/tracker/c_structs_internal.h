#pragma once
#include <array>
#include <cstddef>

#include "ossa/ossa_c.h"

namespace ossa::tracker {

/// Facts of a versioned struct: its name, for messages; `kEarlier`, its sizes in earlier versions,
/// each the offset of the first member added then; `kEnd`, the end of its last member. There must
/// be no padding at the end, so that an added member lies outside earlier sizes.
template <typename T>
struct StructFacts;

template <>
struct StructFacts<ossa_depth_image> {
  static constexpr const char* kName = "ossa_depth_image";
  static constexpr std::array<size_t, 0> kEarlier{};
  static constexpr size_t kEnd = offsetof(ossa_depth_image, time_s) + sizeof(double);
};

template <>
struct StructFacts<ossa_source_options> {
  static constexpr const char* kName = "ossa_source_options";
  static constexpr std::array<size_t, 2> kEarlier = {offsetof(ossa_source_options, depth_format),
                                                     offsetof(ossa_source_options, keep_waiting)};
  static constexpr size_t kEnd = offsetof(ossa_source_options, keep_waiting_user) + sizeof(void*);
};

template <>
struct StructFacts<ossa_options> {
  static constexpr const char* kName = "ossa_options";
  static constexpr std::array<size_t, 2> kEarlier = {offsetof(ossa_options, rotate),
                                                     offsetof(ossa_options, pose_network)};
  static constexpr size_t kEnd = offsetof(ossa_options, parts) + sizeof(int32_t);
};

template <>
struct StructFacts<ossa_body> {
  static constexpr const char* kName = "ossa_body";
  static constexpr std::array<size_t, 1> kEarlier = {offsetof(ossa_body, person_score)};
  static constexpr size_t kEnd = offsetof(ossa_body, stature_sigma_m) + sizeof(float);
};

template <>
struct StructFacts<ossa_frame> {
  static constexpr const char* kName = "ossa_frame";
  static constexpr std::array<size_t, 1> kEarlier = {offsetof(ossa_frame, index)};
  static constexpr size_t kEnd = offsetof(ossa_frame, under_ceiling) + sizeof(int32_t);
};

template <>
struct StructFacts<ossa_skin> {
  static constexpr const char* kName = "ossa_skin";
  static constexpr std::array<size_t, 0> kEarlier{};
  static constexpr size_t kEnd = offsetof(ossa_skin, body_id) + sizeof(int32_t);
};

template <>
struct StructFacts<ossa_object> {
  static constexpr const char* kName = "ossa_object";
  static constexpr std::array<size_t, 0> kEarlier{};
  static constexpr size_t kEnd = offsetof(ossa_object, held_by) + sizeof(int32_t[OSSA_MAX_BODIES]);
};

template <>
struct StructFacts<ossa_smooth_parameters> {
  static constexpr const char* kName = "ossa_smooth_parameters";
  static constexpr std::array<size_t, 0> kEarlier{};
  static constexpr size_t kEnd =
      offsetof(ossa_smooth_parameters, max_deviation_radius_m) + sizeof(float);
};

template <>
struct StructFacts<ossa_writer_options> {
  static constexpr const char* kName = "ossa_writer_options";
  static constexpr std::array<size_t, 0> kEarlier{};
  static constexpr size_t kEnd = offsetof(ossa_writer_options, mesh) + sizeof(const char*);
};

}  // namespace ossa::tracker
