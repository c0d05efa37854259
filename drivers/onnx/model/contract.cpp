// SPDX-License-Identifier: MIT
// Reading of the metadata.
#include "drivers/onnx/model/contract.hpp"

#include <cmath>
#include <locale>
#include <sstream>
#include <utility>
#include <vector>

#include "drivers/onnx/error.hpp"
#include "drivers/predictor.h"

namespace unisim::onnx {
namespace {

constexpr int32_t kMaxSide = 8192;

class Reader {
 public:
  Reader(const std::string& path, const MetadataLookup& lookup) : path_(path), lookup_(lookup) {}

  std::string text(const std::string& key) const {
    const auto value = lookup_("unisim." + key);
    if (!value) fail(key, "is missing; export the model with tools/export/");
    return *value;
  }

  std::string text_or(const std::string& key, const std::string& otherwise) const {
    return lookup_("unisim." + key).value_or(otherwise);
  }

  int32_t whole(const std::string& key, int32_t low, int32_t high) const {
    const double value = numbers(key, text(key), 1)[0];
    if (value < low || value > high || value != std::floor(value)) {
      fail(key, "is " + text(key) + ", not a whole number from " + std::to_string(low) + " to " +
                    std::to_string(high));
    }
    return static_cast<int32_t>(value);
  }

  /// Numbers between spaces or commas, in brackets or not; without regard to the locale.
  std::vector<double> numbers(const std::string& key, std::string value, size_t count) const {
    for (char& letter : value) {
      if (letter == ',' || letter == '[' || letter == ']') letter = ' ';
    }
    std::istringstream stream(value);
    stream.imbue(std::locale::classic());
    std::vector<double> read;
    for (double number = 0; stream >> number;) read.push_back(number);
    if (read.size() != count || !stream.eof()) {
      fail(key, "is \"" + value + "\", not " + std::to_string(count) + " number(s)");
    }
    return read;
  }

  std::array<float, 3> channels(const std::string& key) const {
    const std::vector<double> read = numbers(key, text(key), 3);
    return {static_cast<float>(read[0]), static_cast<float>(read[1]), static_cast<float>(read[2])};
  }

  template <typename Value>
  Value one_of(const std::string& key, const std::string& given,
               const std::vector<std::pair<std::string, Value>>& known) const {
    std::string list;
    for (const auto& [name, value] : known) {
      if (name == given) return value;
      list += " " + name;
    }
    fail(key, "is \"" + given + "\"; this version knows" + list);
  }

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw OnnxError(UNISIM_ONNX_BAD_MODEL, path_ + ": unisim." + key + " " + what);
  }

 private:
  const std::string& path_;
  const MetadataLookup& lookup_;
};

void read_views(const Reader& reader, Contract* contract) {
  contract->min_views = reader.whole("min_views", 1, UNISIM_MAX_VIEWS);
  contract->max_views = reader.whole("max_views", 1, 65536);
  if (contract->max_views < std::max(contract->min_views, 2)) {
    reader.fail("max_views", "is less than unisim.min_views or 2");
  }
  if (contract->kind == Kind::kPair && (contract->min_views > 2 || contract->max_views > 2)) {
    reader.fail("max_views", "is not 2, but the model is of kind pair");
  }
  if (reader.text_or("shared_scale", "1") != "1") {
    reader.fail("shared_scale", "is not 1: depth and pose of one call must have one unit");
  }
  reader.one_of<int>("reference_view", reader.text_or("reference_view", "0"),
                     {{"0", 0}, {"none", 0}});
  reader.one_of<int>("confidence", reader.text("confidence"),
                     {{"expp1", 0}, {"sigmoid", 0}, {"raw", 0}});
  contract->metric = reader.one_of<bool>("scale", reader.text_or("scale", "relative"),
                                         {{"relative", false}, {"metric", true}});
  contract->pixel_center = reader.one_of<double>("pixel_center", reader.text("pixel_center"),
                                                 {{"0", 0.0}, {"0.5", 0.5}});
}

/// Which encoder's features a split model takes, or which encoder this is.
void read_split(const Reader& reader, Contract* contract) {
  const bool is_encoder = contract->kind == Kind::kEncoder;
  if (!is_encoder && contract->kind != Kind::kDescriptor) {
    contract->takes_features = reader.one_of<bool>("input", reader.text_or("input", "images"),
                                                   {{"images", false}, {"features", true}});
  }
  if (!is_encoder && !contract->takes_features) return;
  contract->encoder = reader.text("encoder");
  if (contract->encoder.empty() ||
      contract->encoder.find_first_not_of("0123456789abcdef") != std::string::npos) {
    reader.fail("encoder", "is \"" + contract->encoder + "\", not digits 0-9 and a-f");
  }
}

void read_peak_bytes(const Reader& reader, Contract* contract) {
  const std::string text = reader.text_or("peak_bytes", "");
  if (text.empty()) return;
  const auto peaks = read_peaks(text);
  if (!peaks) {
    reader.fail("peak_bytes",
                "is \"" + text + "\", not VIEWS:BYTES with rising views, as 2:1000000 16:8000000");
  }
  contract->peaks = *peaks;
}

}  // namespace

Contract read_contract(const std::string& path, const MetadataLookup& lookup) {
  const Reader reader(path, lookup);
  reader.one_of<int>("contract", reader.text("contract"), {{"1", 1}});
  Contract contract;
  contract.kind = reader.one_of<Kind>("kind", reader.text("kind"),
                                      {{"multiview", Kind::kMultiview},
                                       {"pair", Kind::kPair},
                                       {"descriptor", Kind::kDescriptor},
                                       {"encoder", Kind::kEncoder}});
  contract.model = reader.text("model");
  contract.license = reader.text("model_license");
  contract.height = reader.whole("height", 1, kMaxSide);
  contract.width = reader.whole("width", 1, kMaxSide);
  contract.multiple = reader.whole("multiple", 1, kMaxSide);
  contract.mean = reader.channels("mean");
  contract.std = reader.channels("std");
  for (const float value : contract.std) {
    if (!(value > 0)) reader.fail("std", "has a number that is not above 0");
  }
  contract.resize = reader.one_of<Resize>("resize", reader.text("resize"),
                                          {{"fit", Resize::kFit},
                                           {"crop", Resize::kCrop},
                                           {"pad", Resize::kPad},
                                           {"stretch", Resize::kStretch}});
  const std::string pad = reader.text_or("pad_value", "0");
  contract.pad_value = static_cast<float>(reader.numbers("pad_value", pad, 1)[0]);
  read_split(reader, &contract);
  read_peak_bytes(reader, &contract);
  if (contract.kind == Kind::kDescriptor || contract.kind == Kind::kEncoder) {
    contract.min_views = contract.max_views = 1;
  } else {
    read_views(reader, &contract);
  }
  return contract;
}

}  // namespace unisim::onnx
