// SPDX-License-Identifier: MIT
// Walks through a prediction file and reads single records of it, every checksum checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "drivers/recorded/record_format.hpp"
#include "drivers/recorded/record_writer.hpp"

namespace unisim::recorded {

/// Where a record lies.
struct RecordRef {
  std::uint64_t offset = 0;  ///< of its head in the file
  RecordHead head{};
};

/// Bytes aligned for every type of a record.
class AlignedBytes {
 public:
  void resize(std::size_t size) { words_.resize((size + 7) / 8); }
  unsigned char* data() { return reinterpret_cast<unsigned char*>(words_.data()); }
  const unsigned char* data() const {
    return reinterpret_cast<const unsigned char*>(words_.data());
  }
  std::size_t capacity_bytes() const { return words_.capacity() * sizeof(std::uint64_t); }

 private:
  std::vector<std::uint64_t> words_;
};

class RecordReader {
 public:
  enum class Step { kRecord, kCutOff, kEndOfFile, kDamaged };

  RecordReader() = default;
  ~RecordReader();
  RecordReader(const RecordReader&) = delete;
  RecordReader& operator=(const RecordReader&) = delete;

  /// Opens the file and reads its header. @return false: see problem()
  bool open(const std::string& path);

  const FileInfo& info() const { return info_; }

  /// Head and key of the next record. kCutOff: the rest is no whole record, what came before is
  /// good.
  Step next(RecordRef* record, AlignedBytes* key);

  /// Data of a record. @return false: see problem()
  bool read_data(const RecordRef& record, AlignedBytes* data);

  /// One line with file, offset and what is wrong.
  const std::string& problem() const { return problem_; }

  /// Sets problem() for a place in the file. @return false
  bool damaged(std::uint64_t offset, const std::string& what);

 private:
  bool read_at(std::uint64_t offset, void* out, std::size_t size);
  bool read_header();
  bool parse_header(const AlignedBytes& bytes, std::size_t size);

  std::string path_;
  std::string problem_;
  FileInfo info_;
  int descriptor_ = -1;
  std::uint64_t file_bytes_ = 0;
  std::uint64_t position_ = 0;
};

}  // namespace unisim::recorded
