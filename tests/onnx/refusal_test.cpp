// SPDX-License-Identifier: MIT
// Models, libraries and providers that are not right: one line that says what, where, what to do.
#include "tests/onnx/predictor_fixture.hpp"
#include "tests/replay/program.hpp"
#include "tests/support/temp_folder.hpp"
#include "tests/support/text.hpp"

using namespace unisim::testing;

namespace {

void require_refusal(const Opened& opened, int32_t problem, const std::string& part) {
  INFO(opened.message);
  CHECK(opened.predictor == nullptr);
  CHECK(opened.problem == problem);
  CHECK(has(opened.message, part));
  CHECK_FALSE(has(opened.message, "\n"));
}

}  // namespace

TEST_CASE("a model that breaks the contract is refused by name") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  require_refusal(open_model("no_metadata.onnx"), UNISIM_ONNX_BAD_MODEL,
                  "no_metadata.onnx: unisim.contract is missing");
  require_refusal(open_model("wrong_size.onnx"), UNISIM_ONNX_BAD_MODEL,
                  "input images has shape (1,V,3,12,16)");
  require_refusal(open_model("no_pose.onnx"), UNISIM_ONNX_BAD_MODEL, "has no output pose");
  require_refusal(open_model("pair.onnx"), UNISIM_ONNX_BAD_MODEL, "cannot predict windows");
  require_refusal(open_model("descriptor.onnx"), UNISIM_ONNX_BAD_MODEL, "cannot predict pairs");
}

TEST_CASE("a file that is no model, or not all of one, is refused") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string whole = read_file(model_file("multiview.onnx"));
  REQUIRE(whole.size() > 1000);
  require_refusal(open_model(folder / "missing.onnx"), UNISIM_ONNX_BAD_MODEL, "no such file");
  require_refusal(open_model(folder.write("half.onnx", whole.substr(0, whole.size() / 2))),
                  UNISIM_ONNX_BAD_MODEL, "half.onnx");
  require_refusal(open_model(folder.write("text.onnx", "this is no model\n")),
                  UNISIM_ONNX_BAD_MODEL, "text.onnx");
  require_refusal(open_model(folder.write("empty.onnx", "")), UNISIM_ONNX_BAD_MODEL, "empty.onnx");
}

TEST_CASE("a model with one byte changed is refused or runs, and never crashes") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  const TempFolder folder;
  const std::string whole = read_file(model_file("multiview.onnx"));
  const std::vector<Image> views = {colourful(16, 12, 0), colourful(16, 12, 1)};
  int32_t refused = 0;
  for (size_t at = 5; at < whole.size(); at += 61) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x15);
    const Opened opened = open_model(folder.write("damaged.onnx", damaged));
    if (opened.predictor == nullptr) {
      ++refused;
      CHECK(has(opened.message, "damaged.onnx"));
      continue;
    }
    add_keyframes(opened.predictor.get(), views);
    unisim_pair_prediction pair{};
    opened.predictor->two_view(opened.predictor.get(), 0, 1, &pair);
  }
  CHECK(refused > 0);
}

TEST_CASE("a provider the library does not have is named with those it has") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  unisim_onnx_config config = test_config();
  config.provider = "nonesuch";
  const Opened opened = open_model("multiview.onnx", config);
  require_refusal(opened, UNISIM_ONNX_NO_RUNTIME, "provider nonesuch of ONNX Runtime");
  CHECK(has(opened.message, "cpu"));
}

TEST_CASE("a library that is missing, something else or too old is named") {
  unisim_onnx_config config = test_config();
  config.library = "/nowhere/libonnxruntime.so";
  require_refusal(open_model("multiview.onnx", config), UNISIM_ONNX_NO_RUNTIME,
                  "/nowhere/libonnxruntime.so");
  config.library = "libm.so.6";
  require_refusal(open_model("multiview.onnx", config), UNISIM_ONNX_NO_RUNTIME,
                  "libm.so.6: is no ONNX Runtime");
  config.library = UNISIM_OLD_RUNTIME;
  const Opened old = open_model("multiview.onnx", config);
  require_refusal(old, UNISIM_ONNX_NO_RUNTIME, "ONNX Runtime 1.16.3");
  CHECK(has(old.message, "older than 1.21"));
  CHECK(has(old.message, "tools/bootstrap.sh"));
}

TEST_CASE("a configuration that makes no sense is refused by field") {
  unisim_onnx_config config = test_config();
  config.threads = -1;
  require_refusal(open_model("multiview.onnx", config), UNISIM_ONNX_BAD_CONFIG, "onnx.threads");
  config = test_config();
  config.window_size = 1;
  require_refusal(open_model("multiview.onnx", config), UNISIM_ONNX_BAD_CONFIG, "onnx.window_size");
  config = test_config();
  config.struct_size = 8;
  require_refusal(open_model("multiview.onnx", config), UNISIM_ONNX_BAD_CONFIG, "struct_size");
}

TEST_CASE("memory that the file states is not measured") {
  UNISIM_SKIP_WITHOUT_RUNTIME();
  // 2 views 1 MB, 16 views 1 GB: eight are 439 MB, nine 512 and some.
  unisim_onnx_config config = test_config();
  config.memory_mb = 512;
  const Opened opened = open_model("peak_stated.onnx", config);
  INFO(opened.message);
  REQUIRE(opened.predictor != nullptr);
  CHECK(unisim_onnx_window_size(opened.predictor.get()) == 8);
  const std::string costs = unisim_onnx_note(opened.predictor.get(), 2);
  INFO(costs);
  CHECK(has(costs, "1 MB, 8 view(s) 439 MB, memory as its file states"));
  config.memory_mb = 1;
  require_refusal(open_model("peak_stated.onnx", config), UNISIM_ONNX_NO_MEMORY,
                  "2 view(s) take 3 MB, more than the 1 MB");
}
