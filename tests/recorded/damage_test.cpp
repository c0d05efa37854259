// SPDX-License-Identifier: MIT
// Cut-off, damaged, foreign and newer files: one line with the place, never a crash.
#include <cstring>
#include <memory>
#include <random>

#include "drivers/recorded/crc32c.hpp"
#include "drivers/recorded/record_format.hpp"
#include "drivers/recorded/recorded.h"
#include "tests/recorded/scripted_predictor.hpp"
#include "tests/recorded/transcript.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::test;
using unisim::recorded::RecordHead;

namespace {

struct Opened {
  std::string message;
  bool open = false;
  Transcript transcript;
};

Opened run_file(const std::string& path) {
  char message[300] = "untouched";
  unisim_predictor* predictor = unisim_recorded_open(path.c_str(), message, sizeof message);
  Opened opened;
  opened.message = message;
  opened.open = predictor != nullptr;
  if (predictor != nullptr) {
    opened.transcript = run_predictor(predictor);
    predictor->destroy(predictor);
  }
  return opened;
}

Opened run_bytes(const TempFolder& folder, const std::string& bytes) {
  write_bytes(folder.file("bytes.usr"), bytes);
  return run_file(folder.file("bytes.usr"));
}

bool one_line(const std::string& text) { return !text.empty() && !has(text, "\n"); }

/// Offset of the first record of a kind with data, and its head.
size_t find_record(const std::string& bytes, unisim::recorded::Kind kind, RecordHead* head) {
  uint32_t at = 0;
  std::memcpy(&at, bytes.data() + 12, sizeof at);
  size_t offset = at;
  for (;;) {
    REQUIRE(offset + sizeof *head <= bytes.size());
    std::memcpy(head, bytes.data() + offset, sizeof *head);
    if (head->kind == static_cast<uint32_t>(kind) && head->data_bytes > 64) return offset;
    offset += sizeof *head + head->key_bytes + static_cast<size_t>(head->data_bytes);
  }
}

/// Makes the checksums of a changed record right again.
void seal(std::string* bytes, size_t offset, RecordHead head) {
  const char* key = bytes->data() + offset + sizeof head;
  head.data_crc =
      unisim::recorded::crc32c(key + head.key_bytes, static_cast<size_t>(head.data_bytes));
  const uint32_t crc = unisim::recorded::crc32c(&head, offsetof(RecordHead, head_crc));
  head.head_crc = unisim::recorded::crc32c(key, head.key_bytes, crc);
  std::memcpy(bytes->data() + offset, &head, sizeof head);
}

}  // namespace

TEST_CASE("crc32c equals the published check values") {
  CHECK(unisim::recorded::crc32c("123456789", 9) == 0xe3069283u);
  const std::string zeros(32, '\0');
  CHECK(unisim::recorded::crc32c(zeros.data(), zeros.size()) == 0x8a9136aau);
  const uint32_t half = unisim::recorded::crc32c("1234", 4);
  CHECK(unisim::recorded::crc32c("56789", 5, half) == 0xe3069283u);
}

TEST_CASE("a file cut off anywhere is read up to its last whole record") {
  const TempFolder folder;
  const Transcript whole = record_scripted(folder.file("run.usr"), {});
  const std::string bytes = read_bytes(folder.file("run.usr"));
  uint32_t header_bytes = 0;
  std::memcpy(&header_bytes, bytes.data() + 12, sizeof header_bytes);
  size_t last_equal = 0;
  for (size_t size = 0; size < bytes.size(); size += 61) {
    const Opened opened = run_bytes(folder, bytes.substr(0, size));
    CAPTURE(size, opened.message);
    REQUIRE(one_line(opened.message));
    REQUIRE(opened.open == (size >= header_bytes));
    if (!opened.open) continue;
    CHECK(has(opened.message, "cut off"));
    size_t equal = 0;
    const auto& answers = opened.transcript.answers;
    while (equal < answers.size() && equal < whole.answers.size() &&
           answers[equal] == whole.answers[equal]) {
      ++equal;
    }
    CHECK(equal >= last_equal);
    last_equal = equal;
  }
  CHECK(last_equal > whole.answers.size() * 9 / 10);
}

TEST_CASE("a run without an end still gives its figures as unknown") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const std::string bytes = read_bytes(folder.file("run.usr"));
  write_bytes(folder.file("cut.usr"), bytes.substr(0, bytes.size() / 2));
  unisim_predictor* recorded = unisim_recorded_open(folder.file("cut.usr").c_str(), nullptr, 0);
  REQUIRE(recorded != nullptr);
  unisim_predictor_info info{};
  recorded->info(recorded, &info);
  CHECK(info.focal_px == 0.0);
  recorded->destroy(recorded);
}

TEST_CASE("what is no prediction file says so") {
  const TempFolder folder;
  CHECK(has(run_file(folder.file("absent.usr")).message, "absent.usr: cannot be read"));
  CHECK(has(run_file(folder.file("")).message, "not a file"));
  CHECK(has(run_bytes(folder, "").message, "byte 0: the file is empty"));
  CHECK(has(run_bytes(folder, "# timestamp tx ty tz\n").message, "not a prediction file"));
  CHECK(has(run_bytes(folder, std::string(5000, 'x')).message, "not a prediction file"));
}

TEST_CASE("a newer version is refused by its number") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  std::string bytes = read_bytes(folder.file("run.usr"));
  bytes[8] = 2;
  const Opened opened = run_bytes(folder, bytes);
  CHECK_FALSE(opened.open);
  CHECK(has(opened.message, "byte 8: format version 2"));
}

TEST_CASE("a flipped bit in a head is found when the file is opened") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const std::string good = read_bytes(folder.file("run.usr"));
  RecordHead head{};
  const size_t offset = find_record(good, unisim::recorded::Kind::kWindow, &head);
  for (const size_t at : {offset, offset + 8, offset + 20, offset + 30}) {
    std::string bytes = good;
    bytes[at] = static_cast<char>(bytes[at] ^ 4);
    const Opened opened = run_bytes(folder, bytes);
    CAPTURE(at, opened.message);
    CHECK_FALSE(opened.open);
    CHECK(has(opened.message, "byte " + std::to_string(offset) + ": checksum"));
  }
}

TEST_CASE("a flipped bit in a depth map is found when it is read") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  std::string bytes = read_bytes(folder.file("run.usr"));
  RecordHead head{};
  const size_t offset = find_record(bytes, unisim::recorded::Kind::kPair, &head);
  const size_t at = offset + sizeof head + head.key_bytes + 140;
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  const Opened opened = run_bytes(folder, bytes);
  REQUIRE(opened.open);
  REQUIRE(opened.transcript.failed > 0);
  CHECK(has(opened.transcript.messages[0],
            "byte " + std::to_string(offset) + ": checksum of the record's data"));
}

TEST_CASE("a prediction that is not a number is rejected with its place") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  std::string bytes = read_bytes(folder.file("run.usr"));
  RecordHead head{};
  const size_t offset = find_record(bytes, unisim::recorded::Kind::kPair, &head);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::memcpy(bytes.data() + offset + sizeof head + head.key_bytes + 24, &nan, sizeof nan);
  seal(&bytes, offset, head);
  const Opened opened = run_bytes(folder, bytes);
  REQUIRE(opened.open);
  CHECK(opened.transcript.failed == 0);
  CHECK(has(opened.transcript.messages[0], "byte " + std::to_string(offset) + ": pair 0,1"));
  CHECK(has(opened.transcript.messages[0], "not a number"));
}

TEST_CASE("a depth map larger than its record is refused") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  std::string bytes = read_bytes(folder.file("run.usr"));
  RecordHead head{};
  const size_t offset = find_record(bytes, unisim::recorded::Kind::kPair, &head);
  const int32_t width = 60000;
  const size_t depth_head = offset + sizeof head + head.key_bytes + 80;
  std::memcpy(bytes.data() + depth_head, &width, sizeof width);
  std::memcpy(bytes.data() + depth_head + 4, &width, sizeof width);
  seal(&bytes, offset, head);
  const Opened opened = run_bytes(folder, bytes);
  REQUIRE(opened.open);
  REQUIRE(opened.transcript.failed > 0);
  CHECK(has(opened.transcript.messages[0], "depth map larger than its record"));
}

TEST_CASE("a record taken out of the middle is noticed") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  std::string bytes = read_bytes(folder.file("run.usr"));
  RecordHead head{};
  const size_t offset = find_record(bytes, unisim::recorded::Kind::kRevision, &head);
  bytes.erase(offset, sizeof head + head.key_bytes + static_cast<size_t>(head.data_bytes));
  const Opened opened = run_bytes(folder, bytes);
  CHECK_FALSE(opened.open);
  CHECK(has(opened.message, "records are missing"));
}

TEST_CASE("random damage never crashes and never passes unseen") {
  const TempFolder folder;
  const Transcript whole = record_scripted(folder.file("run.usr"));
  const std::string good = read_bytes(folder.file("run.usr"));
  std::mt19937 random(7);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int change = 0; change < changes; ++change) {
      // Mostly the heads at the front, where the structure is.
      const size_t range = random() % 2 == 0 ? std::min<size_t>(600, bytes.size()) : bytes.size();
      const size_t at = random() % range;
      bytes[at] = static_cast<char>(static_cast<uint32_t>(bytes[at]) ^ (1u + random() % 255u));
    }
    const Opened opened = run_bytes(folder, bytes);
    CAPTURE(round, opened.message);
    const bool noticed = !opened.open || opened.transcript.failed > 0;
    CHECK((noticed || bytes == good));
    if (!opened.open) CHECK(one_line(opened.message));
  }
}

TEST_CASE("random records with right checksums never crash") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const std::string good = read_bytes(folder.file("run.usr"));
  std::mt19937 random(11);
  for (int round = 0; round < 400; ++round) {
    std::string bytes = good;
    RecordHead head{};
    uint32_t header_bytes = 0;
    std::memcpy(&header_bytes, bytes.data() + 12, sizeof header_bytes);
    for (size_t at = header_bytes; at < bytes.size();) {
      std::memcpy(&head, bytes.data() + at, sizeof head);
      const size_t payload = head.key_bytes + static_cast<size_t>(head.data_bytes);
      if (random() % 4 == 0 && payload > 0) {
        const size_t byte = at + sizeof head + random() % payload;
        bytes[byte] = static_cast<char>(random());
        seal(&bytes, at, head);
      }
      at += sizeof head + payload;
    }
    const Opened opened = run_bytes(folder, bytes);
    CHECK((opened.open || one_line(opened.message)));
  }
}
