// SPDX-License-Identifier: MIT
// A recorded run is the run itself, bit for bit.
#include <cstring>
#include <memory>

#include "drivers/recorded/record_writer.hpp"
#include "drivers/recorded/recorded.h"
#include "tests/recorded/scripted_predictor.hpp"
#include "tests/recorded/transcript.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/text.hpp"

using namespace unisim::test;

namespace {

struct Destroy {
  void operator()(unisim_predictor* predictor) const { predictor->destroy(predictor); }
};
using Owned = std::unique_ptr<unisim_predictor, Destroy>;

Owned open_recorded(const std::string& path) {
  char message[300];
  Owned predictor(unisim_recorded_open(path.c_str(), message, sizeof message));
  INFO(message);
  REQUIRE(predictor != nullptr);
  return predictor;
}

}  // namespace

TEST_CASE("the recorder changes nothing of what it passes through") {
  const TempFolder folder;
  const Owned plain(make_scripted_predictor());
  CHECK(std::string(unisim_predictor_origin(plain.get())) == "scripted");
  const Transcript expected = run_predictor(plain.get());
  const Transcript seen = record_scripted(folder.file("run.usr"));
  CHECK(seen.answers == expected.answers);
  CHECK(seen.messages == expected.messages);
}

TEST_CASE("the recorder carries the name and the wishes of the predictor inside") {
  const TempFolder folder;
  Owned inner(make_scripted_predictor());
  const Owned recorder(
      unisim_recorder_create(inner.release(), folder.file("r.usr").c_str(), nullptr, nullptr, 0));
  REQUIRE(recorder != nullptr);
  CHECK(std::string(recorder->name) == "scripted");
  CHECK(recorder->needs_images == 1);
  CHECK(std::string(unisim_recorder_problem(recorder.get())).empty());
}

TEST_CASE("a recorded run repeats every answer at its time, bit for bit") {
  const TempFolder folder;
  const Transcript expected = record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  CHECK(recorded->needs_images == 0);
  const Transcript repeated = run_predictor(recorded.get());
  CHECK(repeated.answers == expected.answers);
  CHECK(repeated.messages == expected.messages);
  CHECK(repeated.failed == 0);
  REQUIRE(expected.answers.size() > 60);  // pairs, windows, revisions, poses were really asked for
}

TEST_CASE("a recording of a recorded run repeats it and names the first predictor") {
  const TempFolder folder;
  record_scripted(folder.file("first.usr"));
  char message[300];
  unisim_predictor* inner = unisim_recorded_open(folder.file("first.usr").c_str(), message, 300);
  unisim_predictor* recorder =
      unisim_recorder_create(inner, folder.file("second.usr").c_str(), "a sequence", message, 300);
  REQUIRE(recorder != nullptr);
  CHECK(std::string(unisim_predictor_origin(recorder)) == "scripted");
  run_predictor(recorder);
  recorder->destroy(recorder);
  const Owned again = open_recorded(folder.file("second.usr"));
  const Owned first = open_recorded(folder.file("first.usr"));
  CHECK(std::string(unisim_predictor_origin(again.get())) == "scripted");
  CHECK(run_predictor(again.get()).answers == run_predictor(first.get()).answers);
}

TEST_CASE("a recording says how large the images were, and hands it on without them") {
  const TempFolder folder;
  record_scripted(folder.file("first.usr"));
  unisim_predictor* inner = open_recorded(folder.file("first.usr")).release();
  const std::string second = folder.file("second.usr");
  unisim_predictor* recorder = unisim_recorder_create(inner, second.c_str(), "", nullptr, 0);
  REQUIRE(recorder != nullptr);
  unisim_frame frame{};
  unisim_motion motion{};
  REQUIRE(recorder->observe(recorder, &frame, &motion) == UNISIM_PREDICTION_OK);
  recorder->destroy(recorder);
  int32_t width = 0;
  int32_t height = 0;
  CHECK(unisim_predictor_recorded_size(open_recorded(second).get(), &width, &height) == 1);
  CHECK(width == 640);
  CHECK(height == 480);
  const Owned plain(make_scripted_predictor());
  CHECK(unisim_predictor_recorded_size(plain.get(), &width, &height) == 0);
}

TEST_CASE("a file that names no frames and no keyframes needs the images to choose them") {
  const TempFolder folder;
  {
    unisim::recorded::RecordWriter writer;
    REQUIRE(writer.open(folder.file("bare.usr").c_str()));
    writer.write_header({});
  }
  CHECK(open_recorded(folder.file("bare.usr"))->needs_images == 1);
}

TEST_CASE("a file may be recorded over while it is read") {
  const TempFolder folder;
  const std::string path = folder.file("run.usr");
  const Transcript expected = record_scripted(path);
  char message[300];
  unisim_predictor* inner = unisim_recorded_open(path.c_str(), message, sizeof message);
  unisim_predictor* recorder = unisim_recorder_create(inner, path.c_str(), "", message, 300);
  REQUIRE(recorder != nullptr);
  CHECK(run_predictor(recorder).answers == expected.answers);
  recorder->destroy(recorder);
  CHECK(run_predictor(open_recorded(path).get()).answers == expected.answers);
}

TEST_CASE("the recording advises its own keyframes") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  const Transcript repeated = run_predictor(recorded.get());
  for (size_t frame = 0; frame < repeated.advice.size(); ++frame) {
    CHECK(repeated.advice[frame] == (frame % 2 == 0 ? 1 : -1));
  }
}

TEST_CASE("the final figures of the predictor are kept") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  unisim_predictor_info info{};
  recorded->info(recorded.get(), &info);
  CHECK(info.focal_px == 525.5);
  CHECK(info.focal_sigma_px == 1.0 / 3.0);
  CHECK(info.radial_k1 == -0.033);
  CHECK(info.center_x_px == 2.5);
  CHECK(info.center_y_px == -1.25);
  CHECK(info.initialised == 1);
  CHECK(info.restarts == 2);
  CHECK(info.rotation_only == 3);
  CHECK(info.static_frames == 4);
  CHECK(info.state_bytes > 0);
}

TEST_CASE("a run with another stride is refused with the reason") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  RunOptions other;
  other.stride = 3;
  const Transcript transcript = run_predictor(recorded.get(), other);
  REQUIRE(transcript.failed > 0);
  CHECK(has(transcript.messages[0], "keyframe 1 is frame 3"));
  CHECK(has(transcript.messages[0], "--stride"));
}

TEST_CASE("a run with another window is told that the recording has other options") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  RunOptions other;
  other.window = 4;
  const Transcript transcript = run_predictor(recorded.get(), other);
  bool said = false;
  for (const std::string& message : transcript.messages) {
    said = said || (has(message, "recorded with other options"));
  }
  CHECK(said);
  CHECK(transcript.failed == 0);
}

TEST_CASE("a longer run takes from the recording what it holds") {
  const TempFolder folder;
  const Transcript expected = record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  RunOptions longer;
  longer.frames = 30;
  const Transcript transcript = run_predictor(recorded.get(), longer);
  CHECK(transcript.failed == 0);
  CHECK(has(transcript.messages.back(), "made with --from 0 --to 24"));
  CHECK(transcript.advice.back() == -1);
}

TEST_CASE("a recording of another sequence is recognised by its times") {
  const TempFolder folder;
  record_scripted(folder.file("run.usr"));
  const Owned recorded = open_recorded(folder.file("run.usr"));
  unisim_frame frame{};
  frame.index = 2;
  frame.timestamp_ns = 12345;
  unisim_motion motion{};
  CHECK(recorded->observe(recorded.get(), &frame, &motion) == UNISIM_PREDICTION_FAILED);
  CHECK(has(recorded->message(recorded.get()), "recorded from another sequence"));
}
