// SPDX-License-Identifier: MIT
// The stream of a saved map: layout, checksum, ranges.
#include "core/snapshot/archive.hpp"

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/catch.hpp"

using namespace unisim;

namespace {

struct Stream {
  std::vector<unsigned char> bytes;
  size_t at = 0;

  static int32_t write(void* context, const void* from, size_t size) {
    const auto* data = static_cast<const unsigned char*>(from);
    static_cast<Stream*>(context)->bytes.insert(static_cast<Stream*>(context)->bytes.end(), data,
                                                data + size);
    return 1;
  }
  static int32_t read(void* context, void* to, size_t size) {
    auto* self = static_cast<Stream*>(context);
    if (self->bytes.size() - self->at < size) return 0;
    std::memcpy(to, self->bytes.data() + self->at, size);
    self->at += size;
    return 1;
  }
};

/// One section that `visit` fills, saved.
template <class Visit>
Stream saved(const Visit& visit) {
  Stream stream;
  Archive archive(Stream::write, &stream);
  archive.section("part", [&] { visit(&archive); });
  REQUIRE(archive.ok());
  return stream;
}

template <class Visit>
LoadReport loaded(Stream stream, const Visit& visit) {
  Archive archive(Stream::read, &stream);
  archive.section("part", [&] { visit(&archive); });
  return archive.report();
}

/// How a number that was saved fares when it is loaded with this check.
template <class T, class Check>
LoadProblem check(T value, const Check& check) {
  const Stream stream = saved([&](Archive* archive) { archive->value(&value); });
  return loaded(stream, [&](Archive* archive) { check(archive, &value); }).problem;
}

}  // namespace

TEST_CASE("the checksum is the CRC-32 of the standards") {
  Crc32 crc;
  CHECK(crc.value() == 0U);
  const std::string text = "123456789";
  const auto* bytes = reinterpret_cast<const unsigned char*>(text.data());
  crc.add(bytes, 4);
  crc.add(bytes + 4, 5);
  CHECK(crc.value() == 0xcbf43926U);
}

TEST_CASE("a section is name, version, checksum, size and little-endian numbers") {
  const Stream stream = saved([](Archive* archive) {
    int32_t number = -2;
    double half = -0.5;
    bool yes = true;
    archive->value(&number);
    archive->value(&half);
    archive->flag(&yes);
  });
  const std::vector<unsigned char> expected = {
      'p',  'a',  'r',  't',  0, 0, 0, 0,                          // name
      1,    0,    0,    0,                                         // version
      0x5a, 0x5a, 0x5a, 0x5a,                                      // checksum, below
      13,   0,    0,    0,    0, 0, 0, 0,                          // size
      0xfe, 0xff, 0xff, 0xff, 0, 0, 0, 0, 0, 0, 0xe0, 0xbf, 0x01,  // -2, -0.5, true
  };
  REQUIRE(stream.bytes.size() == expected.size());
  for (size_t k = 0; k < expected.size(); ++k) {
    if (k < 12 || k >= 16) CHECK(stream.bytes[k] == expected[k]);
  }
  Crc32 crc;
  crc.add(stream.bytes.data() + 24, 13);
  crc.add(stream.bytes.data(), 12);
  crc.add(stream.bytes.data() + 16, 8);
  for (size_t k = 0; k < 4; ++k) CHECK(stream.bytes[12 + k] == (crc.value() >> (8 * k) & 0xffU));
}

TEST_CASE("what was saved is loaded, longer than any buffer") {
  std::vector<double> numbers(1000);
  for (size_t k = 0; k < numbers.size(); ++k) numbers[k] = 1.0 / static_cast<double>(k);
  const auto visit = [](std::vector<double>* all) {
    return [all](Archive* archive) {
      for (double& number : *all) archive->value(&number);
    };
  };
  const std::vector<double> before = numbers;
  const Stream stream = saved(visit(&numbers));
  CHECK(numbers == before);
  std::vector<double> out(numbers.size());
  CHECK(loaded(stream, visit(&out)).problem == LoadProblem::kNone);
  CHECK(out == before);
}

TEST_CASE("a section is read to its end and no further") {
  int64_t eight = 8;
  Stream stream = saved([&](Archive* archive) { archive->value(&eight); });
  int32_t four = 0;
  const auto take = [&](int32_t times) {
    return [&four, times](Archive* archive) {
      for (int32_t k = 0; k < times; ++k) archive->value(&four);
    };
  };
  CHECK(loaded(stream, take(1)).problem == LoadProblem::kContent);
  CHECK(loaded(stream, take(2)).problem == LoadProblem::kNone);
  four = 7;
  CHECK(loaded(stream, take(3)).problem == LoadProblem::kContent);
  CHECK(four == 0);
  CHECK(std::string(loaded(stream, take(3)).section) == "part");
  Stream more = stream;
  more.bytes.push_back(1);
  Archive archive(Stream::read, &more);
  archive.section("part", [&] { take(2)(&archive); });
  CHECK(archive.ok());
  CHECK(more.at == stream.bytes.size());
}

TEST_CASE("numbers are held against their range") {
  const auto index = [](Archive* archive, int32_t* v) { archive->index(v, 2, 5); };
  CHECK(check(int32_t{2}, index) == LoadProblem::kNone);
  CHECK(check(int32_t{5}, index) == LoadProblem::kNone);
  CHECK(check(int32_t{1}, index) == LoadProblem::kContent);
  CHECK(check(int32_t{6}, index) == LoadProblem::kContent);
  constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();
  const auto finite = [](Archive* archive, double* v) { archive->finite(v); };
  CHECK(check(1e300, finite) == LoadProblem::kNone);
  CHECK(check(kNoNumber, finite) == LoadProblem::kContent);
  CHECK(check(std::numeric_limits<double>::infinity(), finite) == LoadProblem::kContent);
  const auto log_ratio = [](Archive* archive, double* v) { archive->log_ratio(v); };
  CHECK(check(-69.0, log_ratio) == LoadProblem::kNone);
  CHECK(check(71.0, log_ratio) == LoadProblem::kContent);
  CHECK(check(kNoNumber, log_ratio) == LoadProblem::kContent);
  const auto need = [](Archive* archive, int32_t* v) {
    archive->value(v);
    archive->need("max_loops", *v, 3);
  };
  CHECK(check(int32_t{3}, need) == LoadProblem::kNone);
  CHECK(check(int32_t{4}, need) == LoadProblem::kCapacity);
}

TEST_CASE("a pose has to be one") {
  const auto problem_of = [](const Sim3& pose) {
    Sim3 T = pose;
    const Stream stream = saved([&](Archive* archive) { archive->pose(&T); });
    Sim3 out;
    return loaded(stream, [&](Archive* archive) { archive->pose(&out); }).problem;
  };
  Sim3 T;
  T.t = Vec3(1.0, 2.0, 3.0);
  T.s = 0.5;
  CHECK(problem_of(T) == LoadProblem::kNone);
  Sim3 bad = T;
  bad.t[1] = std::numeric_limits<double>::quiet_NaN();
  CHECK(problem_of(bad) == LoadProblem::kContent);
  bad = T;
  bad.q = Quat(0.9, 0.0, 0.0, 0.0);
  CHECK(problem_of(bad) == LoadProblem::kContent);
  bad = T;
  bad.s = -1.0;
  CHECK(problem_of(bad) == LoadProblem::kContent);
  bad = T;
  bad.t[0] = 1e40;
  CHECK(problem_of(bad) == LoadProblem::kContent);
}

TEST_CASE("the first problem stays") {
  int32_t value = 9;
  const Stream stream = saved([&](Archive* archive) { archive->value(&value); });
  const LoadReport report = loaded(stream, [&](Archive* archive) {
    archive->value(&value);
    archive->need("max_keyframes", value, 4);
    archive->need("max_loops", value, 1);
    archive->expect(false);
  });
  CHECK(report.problem == LoadProblem::kCapacity);
  CHECK(std::string(report.setting) == "max_keyframes");
  CHECK(report.needed == 9);
  CHECK(report.given == 4);
}
