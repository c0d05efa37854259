// SPDX-License-Identifier: MIT
// Metadata of a model: read, or refused with the key's name.
#include "drivers/onnx/model/contract.hpp"

#include <map>

#include "drivers/onnx/error.hpp"
#include "tests/support/catch.hpp"

using namespace unisim::onnx;

namespace {

using Metadata = std::map<std::string, std::string>;

Metadata good() {
  return {{"unisim.contract", "1"},       {"unisim.kind", "multiview"},
          {"unisim.model", "a model"},    {"unisim.model_license", "MIT"},
          {"unisim.height", "112"},       {"unisim.width", "154"},
          {"unisim.min_views", "2"},      {"unisim.max_views", "16"},
          {"unisim.multiple", "14"},      {"unisim.mean", "[0.485, 0.456, 0.406]"},
          {"unisim.std", "0.5 0.25 0.2"}, {"unisim.resize", "crop"},
          {"unisim.pad_value", "0.5"},    {"unisim.confidence", "expp1"},
          {"unisim.scale", "metric"},     {"unisim.shared_scale", "1"},
          {"unisim.pixel_center", "0.5"}, {"unisim.reference_view", "none"}};
}

Contract read(const Metadata& metadata) {
  return read_contract("m.onnx", [&](const std::string& key) -> std::optional<std::string> {
    const auto found = metadata.find(key);
    if (found == metadata.end()) return std::nullopt;
    return found->second;
  });
}

std::string refusal(const Metadata& metadata) {
  try {
    read(metadata);
  } catch (const OnnxError& error) {
    CHECK(error.problem() == UNISIM_ONNX_BAD_MODEL);
    return error.what();
  }
  return "";
}

Metadata changed(const std::string& key, const std::string& value) {
  Metadata metadata = good();
  metadata["unisim." + key] = value;
  return metadata;
}

}  // namespace

TEST_CASE("metadata of a model is read") {
  const Contract contract = read(good());
  CHECK(contract.kind == Kind::kMultiview);
  CHECK(contract.model == "a model");
  CHECK(contract.height == 112);
  CHECK(contract.width == 154);
  CHECK(contract.min_views == 2);
  CHECK(contract.max_views == 16);
  CHECK(contract.mean == std::array<float, 3>{0.485f, 0.456f, 0.406f});
  CHECK(contract.std == std::array<float, 3>{0.5f, 0.25f, 0.2f});
  CHECK(contract.resize == Resize::kCrop);
  CHECK(contract.pad_value == 0.5f);
  CHECK(contract.pixel_center == 0.5);
  CHECK(contract.metric);
}

TEST_CASE("a key that is needed and missing is named with the file") {
  for (const char* key :
       {"contract", "kind", "model", "model_license", "height", "width", "min_views", "max_views",
        "multiple", "mean", "std", "resize", "confidence", "pixel_center"}) {
    Metadata metadata = good();
    metadata.erase(std::string("unisim.") + key);
    const std::string line = refusal(metadata);
    INFO(key << ": " << line);
    CHECK(line.find("m.onnx: unisim." + std::string(key) + " is missing") == 0);
  }
}

TEST_CASE("a value that makes no sense is named") {
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"contract", "2"},      {"kind", "stereo"},      {"height", "0"},
      {"width", "15.5"},      {"height", "tall"},      {"min_views", "-1"},
      {"max_views", "1"},     {"multiple", ""},        {"mean", "0 0"},
      {"std", "1 1 0"},       {"std", "1 1 1 1"},      {"resize", "squash"},
      {"pad_value", "white"}, {"confidence", "log"},   {"scale", "inches"},
      {"shared_scale", "0"},  {"peak_bytes", "lots"},  {"peak_bytes", "16:1 2:1"},
      {"input", "pixels"},    {"pixel_center", "0.3"}, {"mean", "0 0 0 junk"},
      {"std", "nan 1 1"}};
  for (const auto& [key, value] : wrong) {
    const std::string line = refusal(changed(key, value));
    INFO(key << " = " << value << ": " << line);
    CHECK(line.find("unisim." + key + " ") != std::string::npos);
    CHECK(line.find('\n') == std::string::npos);
  }
}

TEST_CASE("a pair model takes two views and says so") {
  Metadata metadata = changed("kind", "pair");
  CHECK(refusal(metadata).find("unisim.max_views") != std::string::npos);
  metadata["unisim.max_views"] = "2";
  CHECK(read(metadata).kind == Kind::kPair);
}

TEST_CASE("stated memory is read") {
  CHECK(read(good()).peaks.empty());
  const Contract contract = read(changed("peak_bytes", "2:1000 16:9000"));
  REQUIRE(contract.peaks.size() == 2);
  CHECK(contract.peaks[1].views == 16);
  CHECK(contract.peaks[1].bytes == 9000);
}

TEST_CASE("a model that takes features and an encoder say which encoder") {
  Metadata metadata = changed("input", "features");
  CHECK(refusal(metadata).find("unisim.encoder is missing") != std::string::npos);
  metadata["unisim.encoder"] = "0123abcd";
  CHECK(read(metadata).takes_features);
  CHECK(read(metadata).encoder == "0123abcd");
  metadata["unisim.encoder"] = "not hex";
  CHECK(refusal(metadata).find("unisim.encoder is \"not hex\"") != std::string::npos);
  metadata = changed("kind", "encoder");
  CHECK(refusal(metadata).find("unisim.encoder is missing") != std::string::npos);
  metadata["unisim.encoder"] = "0123abcd";
  CHECK(read(metadata).kind == Kind::kEncoder);
  CHECK_FALSE(read(metadata).takes_features);
}
