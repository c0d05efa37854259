// SPDX-License-Identifier: MIT
// A fresh folder for one test, removed at its end; and whole files as text.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

/// @return "" for a file that is not there
inline std::string read_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class TempFolder {
 public:
  TempFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "unisim-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~TempFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

  /// Writes a file, making the folders above it. @return its path
  std::string write(const std::string& name, const std::string& content) const {
    make_parent(name);
    std::ofstream file(*this / name, std::ios::binary);
    file << content;
    if (!file) throw std::runtime_error("cannot write " + name);
    return *this / name;
  }

  void make_parent(const std::string& name) const {
    std::filesystem::create_directories(std::filesystem::path(*this / name).parent_path());
  }

 private:
  std::string path_;
};
