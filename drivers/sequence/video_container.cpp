// SPDX-License-Identifier: MIT
// What a video file says of itself that OpenCV does not hand on.
#include "drivers/sequence/video_container.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <string_view>

namespace unisim::sequence {
namespace {

using namespace std::string_view_literals;

// Less than this share of a track shown is an edit; above, it is the rounding of its times.
constexpr double kWholeShare = 0.99;

/// Numbers of a file; zeros behind its end.
class File {
 public:
  explicit File(const std::string& path) : stream_(path, std::ios::binary | std::ios::ate) {
    if (stream_) size_ = static_cast<uint64_t>(stream_.tellg());
  }

  uint64_t size() const { return size_; }

  std::string text(uint64_t at, size_t bytes) {
    std::string found(bytes, '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(found.data(), static_cast<std::streamsize>(bytes));
    return found;
  }

  uint64_t big(uint64_t at, size_t bytes) {
    uint64_t value = 0;
    for (const char c : text(at, bytes)) value = value << 8 | static_cast<uint8_t>(c);
    return value;
  }

  uint64_t little(uint64_t at, size_t bytes) {
    const std::string found = text(at, bytes);
    uint64_t value = 0;
    for (size_t k = bytes; k-- > 0;) value = value << 8 | static_cast<uint8_t>(found[k]);
    return value;
  }

 private:
  std::ifstream stream_;
  uint64_t size_ = 0;
};

/// A box of MP4 and MOV: its content lies from `begin` to `end`, which may be behind the file.
struct Box {
  std::string type;
  uint64_t begin = 0;
  uint64_t end = 0;
};

Box read_box(File* file, uint64_t at) {
  uint64_t size = file->big(at, 4);
  uint64_t head = 8;
  if (size == 1) {
    size = file->big(at + 8, 8);
    head = 16;
  }
  if (size == 0) size = file->size() - at;  // to the end of the file
  // One too small for its own head or too large to be added up ends the walk.
  const bool possible = size >= head && size < UINT64_MAX / 2;
  return {file->text(at + 4, 4), at + head, possible ? at + size : UINT64_MAX};
}

/// Calls `visit` with each box from `begin` to `end`.
template <class Visit>
void each_box(File* file, uint64_t begin, uint64_t end, Visit visit) {
  for (uint64_t at = begin; at + 8 <= end && at + 8 <= file->size();) {
    const Box box = read_box(file, at);
    if (box.end == UINT64_MAX) return;
    visit(box);
    at = box.end;
  }
}

/// The first box of a type; an empty one where there is none.
Box find_box(File* file, const Box& parent, std::string_view type) {
  Box found;
  each_box(file, parent.begin, parent.end, [&](const Box& box) {
    if (found.type.empty() && box.type == type) found = box;
  });
  return found;
}

struct Span {
  uint64_t timescale = 0;
  uint64_t duration = 0;
};

/// Of mvhd and mdhd, which begin alike.
Span read_span(File* file, const Box& box) {
  if (box.type.empty()) return {};
  const bool wide = file->big(box.begin, 1) == 1;
  const uint64_t at = box.begin + (wide ? 20 : 12);
  return {file->big(at, 4), file->big(at + 4, wide ? 8 : 4)};
}

/// What the edits of a track show of it, in units of the whole film.
uint64_t shown_duration(File* file, const Box& edits) {
  const bool wide = file->big(edits.begin, 1) == 1;
  const size_t bytes = wide ? 8 : 4;
  const uint64_t entry = 2 * bytes + 4;
  const uint64_t nowhere = wide ? UINT64_MAX : UINT32_MAX;
  uint64_t shown = 0;
  for (uint64_t at = edits.begin + 8; at + entry <= edits.end && at < file->size(); at += entry) {
    if (file->big(at + bytes, bytes) != nowhere) shown += file->big(at, bytes);
  }
  return shown;
}

bool shows_all(File* file, const Box& track, const Span& film) {
  const Box media = find_box(file, track, "mdia");
  const Span span = read_span(file, find_box(file, media, "mdhd"));
  if (span.timescale == 0 || span.duration == 0 || film.timescale == 0) return false;
  const Box edits = find_box(file, find_box(file, track, "edts"), "elst");
  if (edits.type.empty()) return true;
  const double shown =
      static_cast<double>(shown_duration(file, edits)) / static_cast<double>(film.timescale);
  const double whole = static_cast<double>(span.duration) / static_cast<double>(span.timescale);
  return shown >= kWholeShare * whole;
}

ContainerFacts of_mp4(File* file) {
  ContainerFacts facts;
  each_box(file, 0, file->size(), [&](const Box& box) {
    if (box.end > file->size()) facts.cut_off = true;
    if (box.type != "moov") return;
    const Span film = read_span(file, find_box(file, box, "mvhd"));
    each_box(file, box.begin, box.end, [&](const Box& track) {
      if (track.type != "trak") return;
      const Box handler = find_box(file, find_box(file, track, "mdia"), "hdlr");
      if (!handler.type.empty() && file->text(handler.begin + 8, 4) == "vide") {
        facts.counts_shown_frames = shows_all(file, track, film);
      }
    });
  });
  return facts;
}

/// One RIFF after the other.
ContainerFacts of_avi(File* file) {
  ContainerFacts facts;
  for (uint64_t at = 0; file->text(at, 4) == "RIFF";) {
    at += 8 + file->little(at + 4, 4);
    if (at > file->size()) facts.cut_off = true;
  }
  return facts;
}

/// A Matroska number that says by its leading zeros how long it is. @return its bytes, 0: none
size_t read_length(File* file, uint64_t at, uint64_t* value) {
  const uint64_t first = file->big(at, 1);
  size_t bytes = 1;
  while (bytes <= 8 && (first >> (8 - bytes)) == 0) ++bytes;
  if (bytes > 8) return 0;
  const uint64_t all = (uint64_t{1} << (7 * bytes)) - 1;
  *value = file->big(at, bytes) & all;
  return *value == all ? 0 : bytes;  // all ones: not known
}

/// A head, then one segment.
ContainerFacts of_matroska(File* file) {
  uint64_t head = 0;
  uint64_t segment = 0;
  const size_t bytes = read_length(file, 4, &head);
  const uint64_t at = 4 + bytes + head;
  if (bytes == 0 || at > file->size() || file->text(at, 4) != "\x18\x53\x80\x67"sv) return {};
  const size_t more = read_length(file, at + 4, &segment);
  ContainerFacts facts;
  facts.cut_off = more > 0 && segment > file->size() - std::min(file->size(), at + 4 + more);
  return facts;
}

}  // namespace

ContainerFacts read_container(const std::string& path) {
  File file(path);
  if (file.text(0, 4) == "\x1A\x45\xDF\xA3"sv) return of_matroska(&file);
  if (file.text(0, 4) == "RIFF") return of_avi(&file);
  if (file.text(4, 4) == "ftyp") return of_mp4(&file);
  return {};
}

}  // namespace unisim::sequence
