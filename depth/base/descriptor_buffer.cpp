#include <unistd.h>

#include <cerrno>
#include <cstdio>

#include "depth/base/descriptor_buffer_internal.h"

namespace ossa {

DescriptorBuffer::DescriptorBuffer(int descriptor) : descriptor_(descriptor) { Discard(); }

void DescriptorBuffer::Discard() { setp(bytes_.data(), bytes_.data() + bytes_.size()); }

int DescriptorBuffer::sync() {
  for (const char* at = pbase(); at < pptr();) {
    const ssize_t written = write(descriptor_, at, static_cast<size_t>(pptr() - at));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      Discard();
      return -1;
    }
    at += written;
  }
  Discard();
  return 0;
}

DescriptorBuffer::int_type DescriptorBuffer::overflow(int_type c) {
  if (sync() != 0) return traits_type::eof();
  if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
  return sputc(traits_type::to_char_type(c));
}

DescriptorBuffer::pos_type DescriptorBuffer::seekoff(off_type offset, std::ios::seekdir from,
                                                     std::ios::openmode) {
  if (sync() != 0) return pos_type(off_type(-1));
  const int whence = from == std::ios::beg ? SEEK_SET : from == std::ios::cur ? SEEK_CUR : SEEK_END;
  return lseek(descriptor_, offset, whence);
}

DescriptorBuffer::pos_type DescriptorBuffer::seekpos(pos_type place, std::ios::openmode which) {
  return seekoff(off_type(place), std::ios::beg, which);
}

}  // namespace ossa
