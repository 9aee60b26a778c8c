#include <matio.h>
#include <zlib.h>

#include <array>
#include <fstream>
#include <map>
#include <new>
#include <optional>
#include <span>

#include "depth/base/error.h"
#include "depth/sensor/readers/arrays/array_file.h"

namespace ossa::depth {
namespace {

std::optional<NumberFormat> FormatOf(matio_classes type) {
  switch (type) {
    case MAT_C_DOUBLE:
      return NumberFormat{NumberKind::kFloat, 8};
    case MAT_C_SINGLE:
      return NumberFormat{NumberKind::kFloat, 4};
    case MAT_C_INT8:
      return NumberFormat{NumberKind::kSigned, 1};
    case MAT_C_INT16:
      return NumberFormat{NumberKind::kSigned, 2};
    case MAT_C_INT32:
      return NumberFormat{NumberKind::kSigned, 4};
    case MAT_C_INT64:
      return NumberFormat{NumberKind::kSigned, 8};
    case MAT_C_UINT8:
      return NumberFormat{NumberKind::kUnsigned, 1};
    case MAT_C_UINT16:
      return NumberFormat{NumberKind::kUnsigned, 2};
    case MAT_C_UINT32:
      return NumberFormat{NumberKind::kUnsigned, 4};
    case MAT_C_UINT64:
      return NumberFormat{NumberKind::kUnsigned, 8};
    default:
      return std::nullopt;
  }
}

uint32_t NumberAt(std::span<const uint8_t> bytes, bool is_big_endian) {
  uint32_t number = 0;
  for (size_t i = 0; i < 4; ++i) number = number << 8 | bytes[is_big_endian ? i : 3 - i];
  return number;
}

// A stream of zlib: its checksum, and that it is whole.
void CheckCompressed(std::ifstream& file, size_t size, const std::string& place) {
  constexpr size_t kBlock = size_t{1} << 16;  // bytes, by hand
  std::vector<uint8_t> packed(kBlock), unpacked(kBlock);
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, decltype(&inflateEnd)> end(&stream, inflateEnd);
  int status = Z_OK;
  while (size > 0 && status == Z_OK) {
    const size_t some = std::min(size, kBlock);
    file.read(reinterpret_cast<char*>(packed.data()), static_cast<std::streamsize>(some));
    size -= some;
    stream.next_in = packed.data();
    stream.avail_in = static_cast<uInt>(some);
    while (stream.avail_in > 0 && status == Z_OK) {
      stream.next_out = unpacked.data();
      stream.avail_out = static_cast<uInt>(kBlock);
      status = inflate(&stream, Z_NO_FLUSH);
    }
  }
  if (status != Z_STREAM_END) throw InputError(place + ": its compressed numbers are damaged");
}

// Throws if a variable is cut short or its compressed numbers are damaged: matio gives zeros then.
void CheckElements(const std::filesystem::path& path) {
  constexpr size_t kHeader = 128, kTag = 8;  // bytes, the format's (MAT-File Format, 2023)
  constexpr uint32_t kCompressed = 15;       // the format's miCOMPRESSED
  std::ifstream file(path, std::ios::binary);
  std::array<uint8_t, kHeader> header{};
  file.read(reinterpret_cast<char*>(header.data()), kHeader);
  const bool is_big_endian = header[126] == 'M' && header[127] == 'I';
  const bool is_little_endian = header[126] == 'I' && header[127] == 'M';
  if (!file || (!is_big_endian && !is_little_endian)) {
    throw InputError("expected a MAT file of MATLAB or Octave, version 5, 6, 7 or 7.3");
  }
  const size_t size = std::filesystem::file_size(path);
  size_t number = 1;
  for (size_t at = kHeader; at < size; ++number) {
    const std::string place = "variable " + std::to_string(number);
    std::array<uint8_t, kTag> tag{};
    file.seekg(static_cast<std::streamoff>(at));
    file.read(reinterpret_cast<char*>(tag.data()), kTag);
    const size_t length = NumberAt(std::span(tag).subspan(4), is_big_endian);
    if (!file || length > size - at - kTag) throw InputError(place + ": cut short");
    if (NumberAt(tag, is_big_endian) == kCompressed) CheckCompressed(file, length, place);
    at += kTag + length;
  }
}

class MatFile final : public ArrayFile {
 public:
  explicit MatFile(const std::filesystem::path& path)
      : file_((CheckElements(path), Mat_Open(path.c_str(), MAT_ACC_RDONLY))) {
    if (!file_) throw InputError("expected a MAT file of MATLAB or Octave");
    while (matvar_t* next = Mat_VarReadNextInfo(file_.get())) {
      const Variable variable(next);
      if (variable->name == nullptr) continue;
      AddAll(*variable, {variable->name, {}}, variable->name);
    }
  }

  std::vector<ArrayInfo> List() override { return arrays_; }

  // What MATLAB compressed has to be unpacked from its beginning: at once.
  std::vector<uint8_t> Read(const ArrayInfo& array, size_t first, size_t count) override {
    if (whole_name_ != array.name) whole_ = ReadWhole(array);
    whole_name_ = array.name;
    const auto begin = whole_.begin() + static_cast<ptrdiff_t>(first * array.SliceBytes());
    return {begin, begin + static_cast<ptrdiff_t>(count * array.SliceBytes())};
  }

 private:
  struct Free {
    void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
    void operator()(mat_t* file) const { Mat_Close(file); }
  };
  using Variable = std::unique_ptr<matvar_t, Free>;

  // A cell, or a field of an element of a struct array.
  struct Member {
    size_t element = 0;
    std::optional<size_t> field;  // none: a cell

    matvar_t* In(matvar_t& whole) const {
      return field ? Mat_VarGetStructFieldByIndex(&whole, *field, element)
                   : Mat_VarGetCell(&whole, static_cast<int>(element));
    }
  };
  // An array of numbers: in which variable, and where inside of it.
  struct Place {
    std::string variable;
    std::vector<Member> members;
  };

  static size_t ElementsOf(const matvar_t& variable) {
    size_t elements = 1;
    for (int i = 0; i < variable.rank; ++i) elements *= variable.dims[i];
    return elements;
  }

  // The variable, or all that is inside of it, by MATLAB's names: s.depth, frames(3).depth,
  // depth{7}.
  void AddAll(matvar_t& variable, const Place& place, const std::string& name) {
    constexpr size_t kDeepest = 8, kMost = 100'000;  // by hand: against damage
    if (place.members.size() > kDeepest || arrays_.size() >= kMost) return;
    const bool is_struct = variable.class_type == MAT_C_STRUCT;
    if (!is_struct && variable.class_type != MAT_C_CELL) return Add(variable, place, name);
    if (variable.rank < 1 || variable.data == nullptr) return;
    const size_t elements = ElementsOf(variable);
    const size_t fields = is_struct ? Mat_VarGetNumberOfFields(&variable) : 1;
    char* const* names = is_struct ? Mat_VarGetStructFieldnames(&variable) : nullptr;
    for (size_t element = 0; element < std::min(elements, kMost); ++element) {
      const std::string number = std::to_string(element + 1);
      for (size_t field = 0; field < fields; ++field) {
        const Member member{element, is_struct ? std::optional(field) : std::nullopt};
        matvar_t* inside = member.In(variable);
        if (inside == nullptr) continue;
        Place there = place;
        there.members.push_back(member);
        const std::string text = is_struct
                                     ? (elements > 1 ? "(" + number + ")." : ".") + names[field]
                                     : "{" + number + "}";
        AddAll(*inside, there, name + text);
      }
    }
  }

  void Add(const matvar_t& variable, const Place& place, const std::string& name) {
    const auto format = FormatOf(variable.class_type);
    if (!format || variable.isComplex != 0 || variable.isLogical != 0 || variable.rank < 1) return;
    ArrayInfo info{name, *format, {}, true};
    for (int i = variable.rank - 1; i >= 0; --i) info.shape.push_back(variable.dims[i]);
    if (std::find(info.shape.begin(), info.shape.end(), 0) != info.shape.end()) return;
    std::erase(info.shape, 1);
    places_[name] = place;
    arrays_.push_back(std::move(info));
  }

  // The place's array, without its numbers; valid until another variable's is.
  matvar_t* Find(const Place& place) {
    if (opened_name_ != place.variable) {
      opened_.reset(Mat_VarReadInfo(file_.get(), place.variable.c_str()));
      opened_name_ = place.variable;
    }
    matvar_t* found = opened_.get();
    for (const Member& member : place.members) {
      if (found != nullptr) found = member.In(*found);
    }
    return found;
  }

  std::vector<uint8_t> ReadWhole(const ArrayInfo& array) {
    matvar_t* variable = Find(places_.at(array.name));
    if (variable == nullptr) throw InputError(array.name + ": cannot be read");
    const auto rank = static_cast<size_t>(variable->rank);
    std::vector<int> start(rank, 0), stride(rank, 1), edge(rank);
    for (size_t i = 0; i < rank; ++i) edge[i] = static_cast<int>(variable->dims[i]);
    std::vector<uint8_t> numbers(array.SliceCount() * array.SliceBytes());
    if (Mat_VarReadData(file_.get(), variable, numbers.data(), start.data(), stride.data(),
                        edge.data()) != 0) {
      throw InputError(array.name + ": damaged or cut short");
    }
    return numbers;
  }

  std::unique_ptr<mat_t, Free> file_;
  std::vector<ArrayInfo> arrays_;
  std::map<std::string, Place> places_;  // of arrays by name
  Variable opened_;
  std::string opened_name_;
  std::vector<uint8_t> whole_;
  std::string whole_name_;
};

}  // namespace

std::unique_ptr<ArrayFile> OpenMat(const std::filesystem::path& path) {
  return std::make_unique<MatFile>(path);
}

}  // namespace ossa::depth
