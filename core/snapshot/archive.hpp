// SPDX-License-Identifier: MIT
// A map as a stream of numbers: one visit of each class serves to save and to load.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "core/lie/sim3.hpp"
#include "core/snapshot/crc32.hpp"

namespace unisim {

/// Counts that are loaded are no larger, so that counting can go on.
inline constexpr int32_t kMostCount = std::numeric_limits<int32_t>::max() / 2;
/// The largest id.
inline constexpr int32_t kMostId = std::numeric_limits<int32_t>::max();

/// Where the bytes go to or come from. @return 1 done, 0 not
using ArchiveWrite = int32_t (*)(void* context, const void* bytes, size_t size);
using ArchiveRead = int32_t (*)(void* context, void* bytes, size_t size);

/// Numbers of UNISIM_LOAD_*.
enum class LoadProblem : int32_t {
  kNone = 0,
  kEnd = 1,       ///< the stream ended or failed
  kMagic = 2,     ///< no map
  kVersion = 3,   ///< of a later version
  kChecksum = 4,  ///< not the bytes that were written
  kContent = 5,   ///< numbers that no map has
  kCapacity = 6,  ///< a number of the configuration is too small
  kSetting = 7    ///< a setting of the configuration is another one
};

/// What was wrong with a stream.
struct LoadReport {
  LoadProblem problem = LoadProblem::kNone;
  const char* section = "";  ///< in which it was found
  const char* setting = "";  ///< of the configuration, for kCapacity and kSetting
  int64_t needed = 0;        ///< its value for this map
  int64_t given = 0;         ///< its value here
};

/// Saves what it visits or loads into it.
///
///     magic | version | section ...      section: name 8 | version 4 | crc 4 | size 8 | payload
///
/// All numbers are little-endian, doubles by their bits. The checksum is that of the payload
/// followed by name, version and size. To save, each section is visited twice: for its size and
/// checksum, then for its bytes; what is visited is read only.
///
/// To load, the first problem stays and everything after it reads as zero, none or false; nothing
/// is read beyond the section. Whoever visits checks what it has loaded before it uses it.
class Archive {
 public:
  Archive(ArchiveWrite write, void* context) : write_(write), context_(context) {}
  Archive(ArchiveRead read, void* context) : read_(read), context_(context) {}

  bool loading() const { return read_ != nullptr; }
  bool ok() const { return report_.problem == LoadProblem::kNone; }
  const LoadReport& report() const { return report_; }

  /// What the stream begins with.
  void magic();
  /// @param name  static text, 8 characters at most
  /// @param visit void(): visits what the section holds, the same each time
  template <class Visit>
  void section(const char* name, const Visit& visit) {
    open(name);
    visit();
    if (!loading()) {
      write_header();
      visit();
    }
    close();
  }

  // ---- numbers as they are
  void value(uint8_t* v);
  void value(uint16_t* v);
  void value(uint32_t* v);
  void value(uint64_t* v);
  void value(int32_t* v);
  void value(int64_t* v);
  void value(float* v);
  void value(double* v);

  // ---- checked ones
  void flag(bool* v);
  template <class Enum>
  void choice(Enum* v, Enum last) {
    auto number = static_cast<int32_t>(*v);
    index(&number, 0, static_cast<int32_t>(last));
    if (loading()) *v = static_cast<Enum>(number);
  }
  /// first <= v <= last; `first` where it is not
  void index(int32_t* v, int32_t first, int32_t last);
  void finite(double* v);
  /// Finite, and its exponential in the range of numbers.
  void log_ratio(double* v);
  /// In the range of numbers.
  void pose(Sim3* T);

  /// To load: what has been read must be so.
  void expect(bool holds) { require(holds, LoadProblem::kContent); }
  /// To load: the configuration must have room.
  void need(const char* setting, int64_t needed, int64_t given);
  /// To load: a setting of the configuration must be of the same kind.
  void fits(const char* setting, bool is_so, int64_t needed, int64_t given);
  /// A setting that must be the one of the session that saved.
  void same(const char* setting, int32_t ours);
  /// A setting that must be at least that of the session that saved.
  void at_least(const char* setting, int32_t ours);

 private:
  void require(bool holds, LoadProblem problem);
  void note(LoadProblem problem, const char* setting, int64_t needed, int64_t given);
  void open(const char* name);
  void write_header();
  void close();
  void bytes(unsigned char* data, size_t count);
  void flush();
  void fetch(unsigned char* data, size_t count);
  void close_checksum(const unsigned char* header);
  template <class Unsigned>
  void number(Unsigned* v);

  ArchiveWrite write_ = nullptr;
  ArchiveRead read_ = nullptr;
  void* context_ = nullptr;
  LoadReport report_;
  const char* name_ = "start";
  bool measuring_ = false;
  Crc32 crc_;
  uint64_t size_ = 0;  // of the section: so far while measuring, left while loading
  unsigned char header_[24] = {};
  unsigned char buffer_[512] = {};
  size_t buffer_begin_ = 0;
  size_t buffer_end_ = 0;
};

}  // namespace unisim
