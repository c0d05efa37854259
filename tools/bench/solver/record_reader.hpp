// SPDX-License-Identifier: MIT
// One line of a graph file, read field by field; what is wrong is said with file and line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/lie/sim3.hpp"
#include "drivers/sequence/text_file.hpp"

namespace unisim::bench {

/// Ids as in the file to places in PoseGraph::nodes.
using NodeIndex = std::unordered_map<int64_t, int32_t>;

class RecordReader {
 public:
  /// @param path for messages; it and the line outlive the reader
  RecordReader(const std::string& path, const sequence::TextLine& line);

  [[noreturn]] void fail(const std::string& what) const;
  bool at_end() const { return next_ == fields_.size(); }
  void expect_end() const;
  std::string_view word();
  double number();
  int64_t integer();
  /// Place of a node that stood before in the file.
  int32_t node(const NodeIndex& index);
  /// Rotation by four numbers x y z w, brought to length 1.
  Quat rotation();
  Vec3 vector();

 private:
  const std::string& path_;
  const sequence::TextLine& line_;
  std::vector<std::string_view> fields_;
  size_t next_ = 0;
};

}  // namespace unisim::bench
