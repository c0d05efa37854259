// SPDX-License-Identifier: MIT
// Walks through a prediction file and reads single records of it.
#include "drivers/recorded/record_reader.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/recorded/crc32c.hpp"

namespace unisim::recorded {

RecordReader::~RecordReader() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool RecordReader::damaged(std::uint64_t offset, const std::string& what) {
  problem_ = path_ + ": byte " + std::to_string(offset) + ": " + what;
  return false;
}

bool RecordReader::open(const std::string& path) {
  path_ = path;
  descriptor_ = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat status{};
  if (descriptor_ < 0 || ::fstat(descriptor_, &status) != 0) {
    problem_ = path + ": cannot be read: " + std::strerror(errno);
    return false;
  }
  if (!S_ISREG(status.st_mode)) {
    problem_ = path + ": not a file; give the file that --record wrote";
    return false;
  }
  file_bytes_ = static_cast<std::uint64_t>(status.st_size);
  return read_header();
}

bool RecordReader::read_at(std::uint64_t offset, void* out, std::size_t size) {
  auto* bytes = static_cast<unsigned char*>(out);
  while (size > 0) {
    const ssize_t got = ::pread(descriptor_, bytes, size, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return damaged(offset, std::string("cannot be read: ") + std::strerror(errno));
    if (got == 0) return damaged(offset, "the file has become shorter while it was read");
    bytes += got;
    offset += static_cast<std::uint64_t>(got);
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

bool RecordReader::read_header() {
  if (file_bytes_ == 0) return damaged(0, "the file is empty: nothing was recorded");
  FileHead head{};
  const auto start =
      file_bytes_ < sizeof head ? static_cast<std::size_t>(file_bytes_) : sizeof head;
  if (!read_at(0, &head, start)) return false;
  if (std::memcmp(head.magic.data(), kMagic.data(), kMagic.size()) != 0) {
    return damaged(0, "not a prediction file; give the file that --record wrote");
  }
  if (start < sizeof head) return damaged(start, "cut off inside the header: nothing to read");
  if (head.version != kVersion) {
    return damaged(8, "format version " + std::to_string(head.version) + ", this program reads " +
                          std::to_string(kVersion) + ": use a newer program or record again");
  }
  const std::size_t size = head.header_bytes;
  if (size < sizeof head + 16 || size > kMaxHeaderBytes || size % 8 != 0) {
    return damaged(12, "header length " + std::to_string(size) + " is impossible: file damaged");
  }
  if (size > file_bytes_) return damaged(file_bytes_, "cut off inside the header: nothing to read");
  AlignedBytes bytes;
  bytes.resize(size);
  return read_at(0, bytes.data(), size) && parse_header(bytes, size);
}

bool RecordReader::parse_header(const AlignedBytes& bytes, std::size_t size) {
  std::uint32_t stored = 0;
  std::memcpy(&stored, bytes.data() + size - sizeof stored, sizeof stored);
  if (crc32c(bytes.data(), size - sizeof stored) != stored) {
    return damaged(0, "checksum of the header is wrong: file damaged");
  }
  FileHead head{};
  std::memcpy(&head, bytes.data(), sizeof head);
  info_.image_width = head.image_width;
  info_.image_height = head.image_height;
  info_.keyframe_count = head.keyframe_count;
  info_.concurrent_windows = head.concurrent_windows != 0;
  std::size_t at = sizeof head;
  for (std::string* text : {&info_.creator, &info_.sequence, &info_.predictor}) {
    std::uint32_t length = 0;
    const std::size_t left = size - sizeof stored - at;
    if (left < sizeof length) return damaged(at, "header has too few texts: file damaged");
    std::memcpy(&length, bytes.data() + at, sizeof length);
    if (length > left - sizeof length) return damaged(at, "text too long: file damaged");
    text->assign(reinterpret_cast<const char*>(bytes.data()) + at + sizeof length, length);
    at += sizeof length + length;
  }
  position_ = size;
  return true;
}

RecordReader::Step RecordReader::next(RecordRef* record, AlignedBytes* key) {
  const std::uint64_t left = file_bytes_ - position_;
  if (left == 0) return Step::kEndOfFile;
  if (left < kHeadBytes) return Step::kCutOff;
  record->offset = position_;
  RecordHead& head = record->head;
  if (!read_at(position_, &head, sizeof head)) return Step::kDamaged;
  const bool possible =
      head.key_bytes <= kMaxKeyBytes && head.key_bytes % 8 == 0 && head.data_bytes % 8 == 0;
  if (possible && head.key_bytes > left - kHeadBytes) return Step::kCutOff;
  std::uint32_t crc = 0;
  if (possible) {
    key->resize(head.key_bytes);
    if (!read_at(position_ + kHeadBytes, key->data(), head.key_bytes)) return Step::kDamaged;
    crc = crc32c(&head, offsetof(RecordHead, head_crc));
    crc = crc32c(key->data(), head.key_bytes, crc);
  }
  if (!possible || crc != head.head_crc) {
    damaged(position_, "checksum of a record is wrong: file damaged");
    return Step::kDamaged;
  }
  const std::uint64_t left_for_data = left - kHeadBytes - head.key_bytes;
  if (head.data_bytes > left_for_data) return Step::kCutOff;
  position_ += kHeadBytes + head.key_bytes + head.data_bytes;
  return Step::kRecord;
}

bool RecordReader::read_data(const RecordRef& record, AlignedBytes* data) {
  const auto size = static_cast<std::size_t>(record.head.data_bytes);
  data->resize(size);
  const std::uint64_t offset = record.offset + kHeadBytes + record.head.key_bytes;
  if (!read_at(offset, data->data(), size)) return false;
  if (crc32c(data->data(), size) == record.head.data_crc) return true;
  return damaged(record.offset, "checksum of the record's data is wrong: file damaged");
}

}  // namespace unisim::recorded
