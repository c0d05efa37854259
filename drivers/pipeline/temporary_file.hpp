// SPDX-License-Identifier: MIT
// Bytes that grow with a run, kept on disk under no name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

namespace unisim::pipeline {

/// A file without a name: it goes with the process, however that ends. What the disk does not take
/// (full, no such folder) stays in memory, so that a run loses nothing.
class TemporaryFile {
 public:
  /// @param folder on whose disk the bytes go; "": all of them stay in memory
  explicit TemporaryFile(const std::string& folder);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  /// A block at size(), or one that was written before again.
  void write(int64_t offset, const void* bytes, size_t count);
  /// @return false where there is less
  bool read(int64_t offset, void* bytes, size_t count) const;
  int64_t size() const { return on_disk_ + static_cast<int64_t>(rest_.size()); }

 private:
  bool write_disk(int64_t offset, const char* bytes, size_t count) const;

  int file_ = -1;
  int64_t on_disk_ = 0;
  std::vector<char> rest_;  // bytes from on_disk_ on
};

/// Records of one type by index, on a temporary file. Those never put are as made by Record().
template <typename Record>
class RecordFile {
  static_assert(std::is_trivially_copyable_v<Record>);

 public:
  explicit RecordFile(const std::string& folder) : file_(folder) {}

  int64_t size() const { return file_.size() / kBytes; }
  void put(int64_t index, const Record& record) {
    for (int64_t gap = size(); gap < index; ++gap) write(gap, Record());
    write(index, record);
  }
  void append(const Record& record) { write(size(), record); }
  /// Record() for an index never reached.
  Record get(int64_t index) const {
    Record record;
    if (index < 0 || !file_.read(index * kBytes, &record, sizeof record)) record = Record();
    return record;
  }

 private:
  static constexpr auto kBytes = static_cast<int64_t>(sizeof(Record));
  void write(int64_t index, const Record& record) {
    file_.write(index * kBytes, &record, sizeof record);
  }

  TemporaryFile file_;
};

}  // namespace unisim::pipeline
