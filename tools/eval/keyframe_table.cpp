// SPDX-License-Identifier: MIT
// The keyframe table of unisim-replay, as far as its poses are to be judged.
#include "tools/eval/keyframe_table.hpp"

#include <algorithm>

namespace unisim::eval {
namespace {

// Unlike split_fields(): what is not known is an empty field, and reasons have blanks.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  for (const char c : line) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

class Table {
 public:
  explicit Table(const std::string& path) : path_(path), lines_(sequence::read_lines(path)) {
    if (lines_.empty()) throw InputError(path + ": empty; give keyframes.csv of a run");
    names_ = fields_of(lines_.front().text);
  }

  size_t column(const char* name) const {
    const auto found = std::find(names_.begin(), names_.end(), name);
    if (found == names_.end()) {
      throw InputError(path_ + ": no column " + name + "; give keyframes.csv of a run");
    }
    return static_cast<size_t>(found - names_.begin());
  }

  size_t rows() const { return lines_.size() - 1; }

  std::vector<std::string> row(size_t k) const {
    std::vector<std::string> fields = fields_of(lines_[k + 1].text);
    if (fields.size() != names_.size()) fail(k, "has not as many fields as the first line");
    return fields;
  }

  double number(size_t k, const std::string& text) const {
    double value = 0;
    if (!sequence::parse_number(text, &value)) fail(k, ("'" + text + "' is not a number").c_str());
    return value;
  }

 private:
  [[noreturn]] void fail(size_t k, const char* what) const {
    throw InputError(path_ + ":" + std::to_string(lines_[k + 1].number) + ": " + what);
  }

  std::string path_;
  std::vector<sequence::TextLine> lines_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<KeyframeClaim> read_keyframe_table(const std::string& path) {
  const Table table(path);
  const size_t time = table.column("timestamp"), segment = table.column("segment");
  const size_t confidence = table.column("confidence"), state = table.column("state");
  const size_t position = table.column("position_sigma");
  const size_t rotation = table.column("rotation_sigma");
  std::vector<KeyframeClaim> claims;
  for (size_t k = 0; k < table.rows(); ++k) {
    const std::vector<std::string> fields = table.row(k);
    const auto sigma = [&](size_t column) {
      return fields[column].empty() ? -1.0 : table.number(k, fields[column]);
    };
    KeyframeClaim claim;
    claim.time_s = table.number(k, fields[time]);
    claim.segment = static_cast<int64_t>(table.number(k, fields[segment]));
    claim.confidence = static_cast<int64_t>(table.number(k, fields[confidence]));
    claim.good = fields[state] == "tracking" || fields[state] == "relocalised";
    claim.position_sigma = sigma(position);
    claim.rotation_sigma = sigma(rotation);
    claims.push_back(claim);
  }
  return claims;
}

}  // namespace unisim::eval
