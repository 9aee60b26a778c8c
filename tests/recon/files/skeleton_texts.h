#pragma once
// Small recordings in other formats, made here: two or three frames in which every number differs.
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "recon/files/skeleton_io.h"

namespace ossa::recon {

/// Reads a recording with this text, called "file".
inline SkeletonSequence ReadText(const std::string& text, const SkeletonReadOptions& options = {}) {
  std::istringstream stream(text);
  return ReadSkeletonStream(stream, "file", options);
}

inline std::string ReplacedAll(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

// Numbers that differ in every place: x = 0.01 joint, y = 0.1 frame, z = 2.
inline std::string Triple(size_t joint, size_t frame, const char* separator) {
  std::ostringstream text;
  text << 0.01 * static_cast<double>(joint) << separator << 0.1 * static_cast<double>(frame)
       << separator << 2;
  return text.str();
}

inline constexpr const char* kGaitNames[] = {
    "Head",       "Shoulder-Center", "Shoulder-Right", "Shoulder-Left", "Elbow-Right",
    "Elbow-Left", "Wrist-Right",     "Wrist-Left",     "Hand-Right",    "Hand-Left",
    "Spine",      "Hip-centro",      "Hip-Right",      "Hip-Left",      "Knee-Right",
    "Knee-Left",  "Ankle-Right",     "Ankle-Left",     "Foot-Right",    "Foot-Left"};

inline std::string GaitText(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    for (size_t j = 0; j < 20; ++j) {
      text += std::string(kGaitNames[j]) + ";" + Triple(j, f, ";") + "\r\n";
    }
  }
  return text;
}

inline std::string MsrText(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    for (size_t j = 0; j < 20; ++j) text += Triple(j, f, " ") + " 0.9\n";
  }
  return text;
}

inline std::string UtText() {
  std::string text;
  for (const size_t f : {size_t{5}, size_t{6}, size_t{6}, size_t{9}}) {
    text += std::to_string(f);
    for (size_t j = 0; j < 20; ++j) text.append(" ").append(Triple(j, f, " "));
    text += "\n";
  }
  return text;
}

inline std::string Msrc12Text(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    text += std::to_string(1'000'000'000 + 1'662'500 * f);
    for (size_t j = 0; j < 20; ++j) text.append(" ").append(Triple(j, f, " ")).append(" 0");
    text += "\n";
  }
  return text;
}

// The first frame with nobody, the last with two people.
inline std::string MsrDailyText(size_t frames) {
  std::string text = std::to_string(frames) + " 20\n";
  for (size_t f = 0; f < frames; ++f) {
    const size_t people = f == 0 ? 0 : f + 1 == frames ? 2 : 1;
    text += std::to_string(40 * people) + "\n";
    for (size_t j = 0; j < 20 * people; ++j) {
      text += Triple(j, f, " ") + " 1\n0.5 0.25 2000 1\n";
    }
  }
  return text;
}

// One person, and zeros for another.
inline std::string PkuMmdText(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    for (size_t j = 0; j < 25; ++j) text += Triple(j, f, " ") + " ";
    for (size_t number = 0; number < 75; ++number) text += "0 ";
    text += "\n";
  }
  return text;
}

inline std::string LabanText(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    text += std::to_string(89810293609 + 330000 * f) + ",";
    for (size_t j = 0; j < 25; ++j) text += Triple(j, f, ",") + "," + std::to_string(j % 3) + ",";
    text += "\n";
  }
  return text;
}

inline std::string KeraalText(size_t columns) {
  std::string text;
  for (size_t i = 0; i < columns / 7; ++i) text += Triple(i, 1, " ") + " 0.8 0 0 0.6 ";
  return text + "\n";
}

inline std::string NtuText() {
  std::string text = "2\n0\n1\n72057594037931101 0 1 1 1 1 0 0.02 -0.06 2\n25\n";
  for (size_t j = 0; j < 25; ++j)
    text += Triple(j, 3, " ") + " 277 191 1036 519 0.2 0.1 0.3 nan 2\n";
  return text;
}

inline std::string AzureText() {
  return R"({"bone_list":[],"frames":[{"bodies":[{"body_id":4,"joint_orientations":[],)"
         R"("joint_positions":[[-100,200,2500],[1,2,3],[10,-600,2400]]}],"frame_id":0,)"
         R"("num_bodies":1,"timestamp_usec":1000000},{"bodies":[],"frame_id":1,"num_bodies":0,)"
         R"("timestamp_usec":1033333}],"joint_names":["PELVIS","EYE_LEFT","HEAD"]})";
}

inline std::string SaverBytes(size_t frames) {
  std::string bytes(frames * 1920, '\0');
  for (size_t f = 0; f < frames; ++f) {
    for (size_t j = 0; j < 20; ++j) {  // the third of six skeletons
      const float values[4] = {0.01f * static_cast<float>(j), 0.1f * static_cast<float>(f), 2.0f,
                               2.0f};
      std::memcpy(bytes.data() + f * 1920 + 16 * (2 * 20 + j), values, sizeof(values));
    }
  }
  return bytes;
}

template <typename T>
inline void Put(std::string& bytes, size_t offset, T value) {
  std::memcpy(bytes.data() + offset, &value, sizeof(value));
}

// A C3D file of two points, HipCenter and Head, three frames of floats at 50 Hz in millimetres.
inline std::string C3dBytes() {
  std::string bytes(3 * 512, '\0');
  bytes[0] = 2;
  bytes[1] = 0x50;
  Put<uint16_t>(bytes, 2, 2);
  Put<uint16_t>(bytes, 6, 1);
  Put<uint16_t>(bytes, 8, 3);
  Put<float>(bytes, 12, -1.0f);
  Put<uint16_t>(bytes, 16, 3);
  Put<float>(bytes, 20, 50.0f);
  std::string section = std::string("\x01\x50\x01\x54", 4);
  section += std::string("\x05\xFF", 2) + "POINT" + std::string("\x03\x00\x00", 3);
  section += std::string("\x06\x01", 2) + "LABELS" + std::string("\x1B\x00\xFF\x02\x0A\x02", 6) +
             "HipCenter Head      " + std::string(1, '\0');
  section += std::string("\x05\x01", 2) + "UNITS" + std::string("\x08\x00\xFF\x01\x02", 5) + "mm" +
             std::string(1, '\0');
  bytes.replace(512, section.size(), section);
  for (size_t f = 0; f < 3; ++f) {
    for (size_t p = 0; p < 2; ++p) {
      const size_t at = 1024 + 16 * (2 * f + p);
      Put<float>(bytes, at, 100.0f * static_cast<float>(p));
      Put<float>(bytes, at + 4, -10.0f * static_cast<float>(f));
      Put<float>(bytes, at + 8, 1000.0f);
      Put<float>(bytes, at + 12, f == 2 && p == 1 ? -1.0f : 0.0f);
    }
  }
  return bytes;
}

/// One recording of each format.
// Tables of custom programs, with the names of both SDKs.
inline std::string JointLines(size_t frames) {
  std::string text;
  for (size_t f = 0; f < frames; ++f) {
    for (const char* name : {"Hip_Left", "KneeLeft", "SpineBase", "Neck", "SpineShoulder"}) {
      text += std::to_string(f) + " " + name + " " + Triple(text.size() % 50, f, " ") + " 0.9\n";
    }
  }
  return text;
}

inline std::string JointColumnsText() {
  return "time,SpineBase_x,SpineBase_y,SpineBase_z,HipLeft.X,HipLeft.Y,HipLeft.Z,KneeLeft.X,"
         "KneeLeft.Y,KneeLeft.Z\n0,0.01,0.1,2,0.1,0.1,2,0.1,-0.3,2\n0.04,0.01,0.1,2,,,,0.1,-0.3,"
         "2\n";
}

inline std::vector<std::string> ForeignSkeletonTexts() {
  return {GaitText(2),     MsrText(2),         UtText(),      LabanText(2),    KeraalText(175),
          KeraalText(119), NtuText(),          AzureText(),   SaverBytes(2),   C3dBytes(),
          JointLines(2),   JointColumnsText(), Msrc12Text(2), MsrDailyText(3), PkuMmdText(2)};
}

}  // namespace ossa::recon
