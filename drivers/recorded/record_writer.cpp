// SPDX-License-Identifier: MIT
// Appends records to a prediction file.
#include "drivers/recorded/record_writer.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "drivers/recorded/crc32c.hpp"

namespace unisim::recorded {
namespace {

bool write_all(int descriptor, const unsigned char* data, std::size_t size) {
  while (size > 0) {
    const ssize_t written = ::write(descriptor, data, size);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    data += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

void put_text(RecordBytes& bytes, const std::string& text) {
  constexpr std::size_t kLongest = 4096;
  const std::size_t size = text.size() < kLongest ? text.size() : kLongest;
  bytes.put(static_cast<std::uint32_t>(size));
  bytes.put_array(text.data(), size);
}

}  // namespace

RecordWriter::~RecordWriter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool RecordWriter::open(const std::string& path) {
  path_ = path;
  // A file that is being read stays whole for its reader: the new one is another file.
  struct stat status{};
  const bool exists = ::lstat(path.c_str(), &status) == 0;
  if (exists && S_ISREG(status.st_mode)) ::unlink(path.c_str());
  descriptor_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor_ < 0) {
    problem_ = path + ": cannot be written: " + std::strerror(errno);
    return false;
  }
  return true;
}

void RecordWriter::write_header(const FileInfo& info) {
  if (!active()) return;
  FileHead head{};
  head.magic = kMagic;
  head.version = kVersion;
  head.image_width = info.image_width;
  head.image_height = info.image_height;
  head.keyframe_count = info.keyframe_count;
  head.concurrent_windows = info.concurrent_windows ? 1 : 0;
  bytes_.clear();
  bytes_.put(head);
  put_text(bytes_, info.creator);
  put_text(bytes_, info.sequence);
  put_text(bytes_, info.predictor);
  while (bytes_.size() % 8 != 4) bytes_.put('\0');
  head.header_bytes = static_cast<std::uint32_t>(bytes_.size() + sizeof(std::uint32_t));
  std::memcpy(bytes_.data(), &head, sizeof head);
  bytes_.put(crc32c(bytes_.data(), bytes_.size()));
  write_out();
}

void RecordWriter::begin(Kind kind) {
  kind_ = static_cast<std::uint32_t>(kind);
  bytes_.clear();
  bytes_.put(RecordHead{});
}

void RecordWriter::end_key() {
  bytes_.pad();
  key_end_ = bytes_.size();
}

void RecordWriter::end() {
  if (!active()) return;
  bytes_.pad();
  RecordHead head{};
  head.kind = kind_;
  head.key_bytes = static_cast<std::uint32_t>(key_end_ - kHeadBytes);
  head.data_bytes = bytes_.size() - key_end_;
  head.data_crc = crc32c(bytes_.data() + key_end_, bytes_.size() - key_end_);
  const std::uint32_t crc = crc32c(&head, offsetof(RecordHead, head_crc));
  head.head_crc = crc32c(bytes_.data() + kHeadBytes, head.key_bytes, crc);
  std::memcpy(bytes_.data(), &head, sizeof head);
  if (write_out()) ++record_count_;
}

bool RecordWriter::write_out() {
  if (write_all(descriptor_, bytes_.data(), bytes_.size())) {
    whole_bytes_ += static_cast<std::int64_t>(bytes_.size());
    return true;
  }
  const std::string reason = std::strerror(errno);
  // What stays ends with a whole record; where the file cannot be cut (a device) readers do it.
  const bool cut = ::ftruncate(descriptor_, whole_bytes_) == 0;
  stop(reason + (cut ? "" : " (last record incomplete)"));
  return false;
}

void RecordWriter::stop(const std::string& problem) {
  if (!problem_.empty()) return;
  problem_ = path_ + ": recording stopped after " + std::to_string(record_count_) +
             " records: " + problem + "; what is written stays readable, the run goes on";
}

}  // namespace unisim::recorded
