// SPDX-License-Identifier: MIT
// The map of a run as one file.
#include "drivers/mapfile/map_file.hpp"

#include <algorithm>
#include <utility>

#include "drivers/common/archive.hpp"
#include "drivers/common/has_maps.hpp"
#include "drivers/mapfile/byte_stream.hpp"

namespace unisim::mapfile {
namespace {

constexpr const char* kAbout = "about";
constexpr const char* kSession = "session";
constexpr const char* kPredictor = "predictor";
constexpr const char* kLeft = "left";
constexpr const char* kWindows = "windows";
constexpr int32_t kMostText = 4096;

void archive_text(drivers::Archive* io, std::string* text) {
  auto size = static_cast<int32_t>(std::min<size_t>(text->size(), kMostText));
  io->number(size, 0, kMostText);
  text->resize(static_cast<size_t>(size));
  io->bytes(text->data(), text->size());
}

void archive_about(drivers::Archive* io, About* about) {
  io->part("part about");
  for (std::string* text : {&about->program, &about->predictor, &about->sequence}) {
    archive_text(io, text);
  }
  for (int32_t* number : {&about->image_width, &about->image_height, &about->keyframes}) {
    io->number(*number, 0, drivers::kMostKeyframeId);
  }
}

int32_t keyframes_of(const unisim_session* session) {
  unisim_session_info info{};
  info.struct_size = sizeof info;
  return unisim_get_info(session, &info) == UNISIM_OK ? info.keyframes : -1;
}

/// Why the session did not take its part.
std::string load_problem(const unisim_session* session, unisim_status status) {
  unisim_load_report report{};
  report.struct_size = sizeof report;
  if (unisim_get_load_report(session, &report) != UNISIM_OK) return unisim_status_string(status);
  std::string where = report.section[0] != '\0' ? std::string(report.section) + ": " : "";
  switch (report.problem) {
    case UNISIM_LOAD_CAPACITY:
    case UNISIM_LOAD_SETTING:
      return where + "it needs session." + report.setting + " = " + std::to_string(report.needed) +
             ", here it is " + std::to_string(report.given);
    case UNISIM_LOAD_VERSION:
      return where + "a later version wrote it; use a newer program";
    case UNISIM_LOAD_END:
      return where + "ends too early";
    default:
      return where + unisim_status_string(status);
  }
}

}  // namespace

void save_map(const std::string& path, About about, const unisim_session* session,
              unisim_predictor* predictor, Bytes left, Bytes windows) {
  if (!drivers::has_maps(*predictor)) {
    throw Error(Error::Kind::kInput, std::string("maps are kept by the geometric predictor; the ") +
                                         predictor->name + " predictor has none");
  }
  about.predictor = predictor->name;
  about.keyframes = keyframes_of(session);
  Bytes of_about;
  drivers::Archive io(append_bytes, &of_about);
  archive_about(&io, &about);
  Bytes of_session;
  const unisim_status status = unisim_save_map(session, append_bytes, &of_session);
  if (status != UNISIM_OK) {
    throw Error(Error::Kind::kInput,
                path + ": part session cannot be saved: " + unisim_status_string(status));
  }
  Bytes of_predictor;
  if (predictor->save_map(predictor, append_bytes, &of_predictor) != UNISIM_PREDICTION_OK) {
    throw Error(Error::Kind::kInput,
                path + ": part predictor cannot be saved: " + predictor->message(predictor));
  }
  std::vector<Section> sections = {{kAbout, std::move(of_about)},
                                   {kSession, std::move(of_session)},
                                   {kPredictor, std::move(of_predictor)}};
  if (!left.empty()) sections.push_back({kLeft, std::move(left)});
  if (!windows.empty()) sections.push_back({kWindows, std::move(windows)});
  write_sections(path, sections);
}

MapFile::MapFile(const std::string& path) : path_(path), sections_(read_sections(path)) {
  ByteSource source{part(kAbout)};
  try {
    drivers::Archive io(take_bytes, &source);
    archive_about(&io, &about_);
  } catch (const drivers::ArchiveError& error) {
    fail(error.what());
  }
}

void MapFile::fail(const std::string& why) const {
  throw Error(Error::Kind::kInput, path_ + ": " + why);
}

const Bytes* MapFile::find(const char* name) const {
  const auto found = std::find_if(sections_.begin(), sections_.end(),
                                  [&](const Section& section) { return section.name == name; });
  return found == sections_.end() ? nullptr : &found->bytes;
}

const Bytes& MapFile::part(const char* name) const {
  const Bytes* const found = find(name);
  if (found == nullptr) fail(std::string("part ") + name + " is missing");
  return *found;
}

Bytes MapFile::optional(const char* name) const {
  const Bytes* const found = find(name);
  return found != nullptr ? *found : Bytes();
}

Bytes MapFile::left() const { return optional(kLeft); }

Bytes MapFile::windows() const { return optional(kWindows); }

int32_t MapFile::load_session(unisim_session* session) const {
  ByteSource source{part(kSession)};
  const unisim_status status = unisim_load_map(session, take_bytes, &source);
  if (status != UNISIM_OK) fail("part session: " + load_problem(session, status));
  if (source.at != source.bytes.size()) fail("part session: there is more in it than a map");
  return keyframes_of(session);
}

int32_t MapFile::load_predictor(unisim_predictor* predictor) const {
  if (!drivers::has_maps(*predictor) || about_.predictor != predictor->name) {
    fail("is a map of the " + about_.predictor + " predictor, not of the " + predictor->name +
         " predictor");
  }
  ByteSource source{part(kPredictor)};
  int32_t next = -1;
  if (predictor->load_map(predictor, take_bytes, &source, &next) != UNISIM_PREDICTION_OK) {
    fail(std::string("part predictor: ") + predictor->message(predictor));
  }
  if (source.at != source.bytes.size()) fail("part predictor: there is more in it than a map");
  return next;
}

void MapFile::hand_over(unisim_session* session, unisim_predictor* predictor) {
  const int32_t of_session = load_session(session);
  const int32_t of_predictor = load_predictor(predictor);
  if (of_session != of_predictor) {
    fail("part session ends with keyframe " + std::to_string(of_session - 1) +
         ", part predictor with keyframe " + std::to_string(of_predictor - 1));
  }
  sections_.clear();
}

}  // namespace unisim::mapfile
