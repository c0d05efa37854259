// SPDX-License-Identifier: MIT
// A file of named parts, each with its size and checksum; whole or not there.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace unisim::mapfile {

/// Why a map was not read or written: one line with the file and the part.
class Error : public std::runtime_error {
 public:
  enum class Kind {
    kInput,  ///< the file is not there, not a map, damaged, or does not fit
    kDevice  ///< it could not be written: full, read-only
  };
  Error(Kind kind, const std::string& line) : std::runtime_error(line), kind_(kind) {}
  Kind kind() const { return kind_; }

 private:
  Kind kind_;
};

using Bytes = std::vector<uint8_t>;

struct Section {
  std::string name;  ///< 1..16 characters
  Bytes bytes;
};

/// Writes a file beside `path` and puts it in its place: whoever looks, and whenever the process
/// ends, finds the old file or the new one. Throws Error.
void write_sections(const std::string& path, const std::vector<Section>& sections);

/// Throws Error where `path` could not be written, so that it is known before hours of work.
void check_writable(const std::string& path);

/// Reads a whole file whose checksums all hold. Throws Error.
std::vector<Section> read_sections(const std::string& path);

}  // namespace unisim::mapfile
