// SPDX-License-Identifier: MIT
// After warm-up the driver takes no memory: what the runtime does inside is counted apart.
#include "drivers/onnx/predict/role.hpp"
#include "tests/alloc/malloc_counter.hpp"
#include "tests/onnx/predictor_fixture.hpp"

using namespace unisim;
using namespace unisim::testing;

namespace {

onnx::RunOptions run_options() {
  onnx::RunOptions run;
  run.provider = "cpu";
  run.threads = 1;
  run.memory_bytes = int64_t{1} << 30;
  return run;
}

onnx::MemoryBudget plenty() {
  onnx::MemoryBudget budget;
  budget.bytes = int64_t{1} << 30;
  return budget;
}

}  // namespace

TEST_CASE("an inference makes no heap call of ours") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const auto model = std::make_shared<onnx::Model>(onnx::Runtime::open(""),
                                                   model_file("multiview.onnx"), run_options());
  model->warm_up(2, 6, plenty());
  const auto views =
      std::make_shared<onnx::Views>(model->contract(), nullptr, model->view_floats(), 10);
  views->set_image_size(32, 24);
  onnx::Role role(model, views, 6, 0.5);
  const int32_t ids[] = {0, 1, 2, 3};
  const std::vector<Image> images = {colourful(32, 24, 0), colourful(32, 24, 1),
                                     colourful(32, 24, 2), colourful(32, 24, 3)};
  for (int32_t id = 0; id < 4; ++id) views->add(id, images[static_cast<size_t>(id)].view);
  REQUIRE(role.predict(ids, 4).problem.empty());

  int64_t before = test::heap_calls();
  views->add(4, images[0].view);
  CHECK(test::heap_calls() - before == 0);

  before = test::heap_calls();
  const bool ran = model->run(4).empty();
  const int64_t of_the_runtime = test::heap_calls() - before;
  REQUIRE(ran);

  before = test::heap_calls();
  const bool predicted = role.predict(ids, 4).problem.empty();
  const int64_t of_all = test::heap_calls() - before;
  REQUIRE(predicted);
  CHECK(of_all == of_the_runtime);
}

TEST_CASE("encoding a keyframe makes no heap call of ours") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const auto encoder = std::make_shared<onnx::Encoder>(
      onnx::Runtime::open(""), model_file("split.encoder.onnx"), run_options());
  encoder->warm_up(plenty());
  const auto floats = static_cast<int64_t>(encoder->features().size());
  onnx::Views views(encoder->contract(), encoder, floats, 10);
  views.set_image_size(32, 24);
  const Image image = colourful(32, 24, 0);
  std::vector<float> view(encoder->features().size());
  REQUIRE(views.add(0, image.view).problem.empty());

  int64_t before = test::heap_calls();
  const bool ran = encoder->run().problem.empty();
  const int64_t of_the_runtime = test::heap_calls() - before;
  REQUIRE(ran);

  before = test::heap_calls();
  const bool added = views.add(12345678, image.view).problem.empty();
  const bool found = views.copy(12345678, view.data()).empty();
  const int64_t of_all = test::heap_calls() - before;
  REQUIRE(added);
  REQUIRE(found);
  CHECK(of_all == of_the_runtime);
}
