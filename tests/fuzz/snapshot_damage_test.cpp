// SPDX-License-Identifier: MIT
// Snapshots that are cut, damaged or made up: refused by the name of the part, or a map that holds.
#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "tests/support/catch.hpp"
#include "tests/support/owned_session.hpp"
#include "tests/support/proper_pose.hpp"
#include "tests/support/random_config.hpp"
#include "tests/support/random_session.hpp"
#include "tests/support/snapshot_bytes.hpp"

using namespace unisim::test;

namespace {

Habits habits_until(int32_t keyframes) {
  Habits habits;
  habits.keyframes = keyframes;
  habits.metres = 0.3;
  return habits;
}

/// What a session of this configuration saves after some random calls.
SnapshotBytes snapshot_of(const unisim_config& config, uint32_t seed, int32_t keyframes) {
  OwnedSession owned(config);
  RandomCaller caller(owned.session, config, seed, habits_until(keyframes));
  while (caller.step()) {
  }
  return save(owned.session);
}

unisim_config small_config() {
  unisim_config config = {};
  REQUIRE(unisim_config_init(&config, sizeof config) == UNISIM_OK);
  config.window_size = 4;
  config.window_overlap = 1;
  config.window_submaps = 2;
  config.skeleton_capacity = 8;
  config.max_keyframes = 2;
  config.max_loops = 4;
  config.depth_grid_width = 5;
  config.depth_grid_height = 4;
  return config;
}

unisim_session_info info_of(const unisim_session* session) {
  unisim_session_info info = {};
  info.struct_size = sizeof info;
  REQUIRE(unisim_get_info(session, &info) == UNISIM_OK);
  return info;
}

bool is_fresh(const unisim_session* session) {
  const unisim_session_info info = info_of(session);
  return info.keyframes == 0 && info.submaps == 0 && info.loops == 0 && info.segments == 0 &&
         info.state == UNISIM_STATE_INIT;
}

/// Are all poses that come out such?
bool has_poses(const unisim_session* session) {
  const unisim_session_info info = info_of(session);
  for (int32_t id = info.first_keyframe; id < info.keyframes; ++id) {
    unisim_pose pose = {};
    pose.struct_size = sizeof pose;
    const bool there = unisim_get_pose(session, id, &pose) == UNISIM_OK;
    if (there && !is_pose(pose.T_world_kf)) return false;
  }
  return true;
}

const SnapshotSection* section_at(const std::vector<SnapshotSection>& sections, size_t at) {
  for (const SnapshotSection& section : sections) {
    if (at >= section.header && at < section.end) return &section;
  }
  return nullptr;
}

/// Write something over a number of the snapshot.
void make_up(std::mt19937* random, size_t at, size_t end, std::vector<unsigned char>* bytes) {
  const auto put = [&](const auto& value) {
    std::memcpy(bytes->data() + at, &value, std::min(sizeof value, end - at));
  };
  int32_t number = 0;
  std::memcpy(&number, bytes->data() + at, std::min(sizeof number, end - at));
  switch ((*random)() % 8) {
    case 0:
      return put(static_cast<int32_t>(static_cast<uint32_t>(number) + 1U));
    case 1:
      return put(static_cast<int32_t>(static_cast<uint32_t>(number) - 1U));
    case 2:
      return put((*random)() % 2 == 0 ? std::numeric_limits<int32_t>::max() : -1);
    case 3:
      return put(static_cast<int32_t>((*random)() % 64));
    case 4:
      return put(std::numeric_limits<double>::quiet_NaN());
    case 5:
      return put((*random)() % 2 == 0 ? 1e29 : -1e300);
    case 6:
      (*bytes)[at] ^= static_cast<unsigned char>(1U << ((*random)() % 8));
      return;
    default:
      return put((*random)());
  }
}

}  // namespace

TEST_CASE("a snapshot cut anywhere is refused by the section it ends in") {
  const unisim_config config = small_config();
  const SnapshotBytes whole = snapshot_of(config, 3U, 60);
  const std::vector<SnapshotSection> sections = sections_of(whole.bytes);
  REQUIRE(sections.size() == 10);
  REQUIRE(sections.back().end == whole.bytes.size());
  OwnedSession owned(config);
  for (size_t size = 0; size < whole.bytes.size(); ++size) {
    SnapshotBytes cut;
    cut.bytes.assign(whole.bytes.begin(), whole.bytes.begin() + static_cast<std::ptrdiff_t>(size));
    const unisim_status status = load(owned.session, &cut);
    const unisim_load_report report = load_report(owned.session);
    const SnapshotSection* section = section_at(sections, size);
    const std::string expected = section == nullptr ? "start" : section->name;
    if (status != UNISIM_ERR_IO || report.problem != UNISIM_LOAD_END ||
        expected != report.section || !is_fresh(owned.session)) {
      FAIL("cut at " << size << ": " << status << " in " << report.section);
    }
  }
  SnapshotBytes all = whole;
  CHECK(load(owned.session, &all) == UNISIM_OK);
}

TEST_CASE("any damaged byte is refused by the section it lies in") {
  const unisim_config config = small_config();
  const SnapshotBytes whole = snapshot_of(config, 4U, 60);
  const std::vector<SnapshotSection> sections = sections_of(whole.bytes);
  OwnedSession owned(config);
  SnapshotBytes damaged = whole;
  std::mt19937 random(1);
  for (size_t at = 0; at < whole.bytes.size(); ++at) {
    damaged.bytes[at] ^= static_cast<unsigned char>(1U << (random() % 8));
    const unisim_status status = load(owned.session, &damaged);
    const unisim_load_report report = load_report(owned.session);
    const SnapshotSection* section = section_at(sections, at);
    const std::string expected = section == nullptr ? "start" : section->name;
    if (status == UNISIM_OK || expected != report.section || !is_fresh(owned.session)) {
      FAIL("byte " << at << ": " << status << " in " << report.section << ", not " << expected);
    }
    damaged.bytes[at] = whole.bytes[at];
  }
}

TEST_CASE("what is foreign or of a later version says so") {
  const unisim_config config = small_config();
  const SnapshotBytes whole = snapshot_of(config, 5U, 20);
  const std::vector<SnapshotSection> sections = sections_of(whole.bytes);
  OwnedSession owned(config);
  SnapshotBytes foreign = whole;
  foreign.bytes[0] = 'U';
  CHECK(load(owned.session, &foreign) == UNISIM_ERR_DATA);
  CHECK(load_report(owned.session).problem == UNISIM_LOAD_MAGIC);
  SnapshotBytes later = whole;
  later.bytes[8] = 2;
  CHECK(load(owned.session, &later) == UNISIM_ERR_DATA);
  CHECK(load_report(owned.session).problem == UNISIM_LOAD_VERSION);
  later = whole;
  later.bytes[sections[3].header + 8] = 2;
  seal(sections[3], &later.bytes);
  CHECK(load(owned.session, &later) == UNISIM_ERR_DATA);
  CHECK(load_report(owned.session).problem == UNISIM_LOAD_VERSION);
  CHECK(load_report(owned.session).section == sections[3].name);
  SnapshotBytes damaged = whole;
  damaged.bytes[sections[2].header + 12] ^= 1U;
  CHECK(load(owned.session, &damaged) == UNISIM_ERR_DATA);
  CHECK(load_report(owned.session).problem == UNISIM_LOAD_CHECKSUM);
}

TEST_CASE("made-up snapshots with right checksums are refused or are maps") {
  int32_t refused = 0;
  int32_t taken = 0;
  for (uint32_t seed = 1; seed < 1 + fuzz_seeds(); ++seed) {
    const unisim_config config = seed % 3 == 0 ? random_config(seed) : small_config();
    const auto keyframes = static_cast<int32_t>(10 + seed * 13 % 120);
    const SnapshotBytes whole = snapshot_of(config, seed, keyframes);
    const std::vector<SnapshotSection> sections = sections_of(whole.bytes);
    OwnedSession owned(config);
    std::mt19937 random(seed);
    for (int32_t trial = 0; trial < 40; ++trial) {
      SnapshotBytes made_up = whole;
      const auto changes = 1 + random() % 3;
      for (uint32_t k = 0; k < changes; ++k) {
        const SnapshotSection& section = sections[random() % sections.size()];
        const size_t at = section.payload + random() % (section.end - section.payload);
        make_up(&random, at, section.end, &made_up.bytes);
        seal(section, &made_up.bytes);
      }
      REQUIRE(unisim_session_reset(owned.session) == UNISIM_OK);
      if (load(owned.session, &made_up) != UNISIM_OK) {
        ++refused;
        if (!is_fresh(owned.session)) FAIL("not as after reset, seed " << seed << "/" << trial);
        continue;
      }
      ++taken;
      const unisim_session_info info = info_of(owned.session);
      RandomCaller caller(owned.session, config, seed, habits_until(info.keyframes + 60));
      caller.go_on(info.keyframes, info.submaps + info.loops);
      while (caller.step()) {
      }
      if (caller.count(UNISIM_ERR_INTERNAL) != 0) FAIL("broken, seed " << seed << "/" << trial);
      if (!has_poses(owned.session)) FAIL("no proper pose, seed " << seed << "/" << trial);
    }
  }
  CHECK(refused > 2 * static_cast<int32_t>(fuzz_seeds()));
  CHECK(taken > 2 * static_cast<int32_t>(fuzz_seeds()));
}
