// SPDX-License-Identifier: MIT
// Appends records to a prediction file; every record is one write to the system.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "drivers/recorded/record_format.hpp"

namespace unisim::recorded {

/// A record under construction; the storage is kept from record to record.
class RecordBytes {
 public:
  template <class T>
  void put(const T& value) {
    put_array(&value, 1);
  }

  template <class T>
  void put_array(const T* values, std::size_t count) {
    if (count == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + count * sizeof(T));
    std::memcpy(bytes_.data() + at, values, count * sizeof(T));
  }

  /// Zeros up to a multiple of 8.
  void pad() { bytes_.resize((bytes_.size() + 7) / 8 * 8); }

  void clear() { bytes_.clear(); }
  std::size_t size() const { return bytes_.size(); }
  unsigned char* data() { return bytes_.data(); }

 private:
  std::vector<unsigned char> bytes_;
};

/// What the start of a file says.
struct FileInfo {
  std::string creator;
  std::string sequence;
  std::string predictor;
  std::int32_t image_width = 0;   ///< pixels, 0 not known
  std::int32_t image_height = 0;  ///< pixels, 0 not known
  std::int32_t keyframe_count = -1;
  bool concurrent_windows = false;  ///< of the predictor
};

/// Writes one file. After the first failure nothing more is written and problem() says why.
class RecordWriter {
 public:
  RecordWriter() = default;
  ~RecordWriter();
  RecordWriter(const RecordWriter&) = delete;
  RecordWriter& operator=(const RecordWriter&) = delete;

  /// Makes the file, replacing one that exists. @return false: see problem()
  bool open(const std::string& path);

  void write_header(const FileInfo& info);

  /// A record: begin(), put the key, end_key(), put the data, end().
  void begin(Kind kind);
  RecordBytes& bytes() { return bytes_; }
  void end_key();
  void end();

  /// Nothing more is written from now on, for the reason given.
  void stop(const std::string& problem);

  bool active() const { return descriptor_ >= 0 && problem_.empty(); }
  const std::string& problem() const { return problem_; }
  std::int64_t record_count() const { return record_count_; }

 private:
  bool write_out();

  RecordBytes bytes_;
  std::string path_;
  std::string problem_;
  int descriptor_ = -1;
  std::size_t key_end_ = 0;
  std::uint32_t kind_ = 0;
  std::int64_t record_count_ = 0;
  std::int64_t whole_bytes_ = 0;
};

}  // namespace unisim::recorded
