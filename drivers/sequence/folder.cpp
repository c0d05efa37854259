// SPDX-License-Identifier: MIT
// Looking into folders: existence, listing, natural order, patterns.
#include "drivers/sequence/folder.hpp"

#include <glob.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "drivers/sequence/text_file.hpp"

namespace unisim::sequence {
namespace {

mode_t file_type(const std::string& path) {
  struct stat info{};
  return stat(path.c_str(), &info) == 0 ? info.st_mode & S_IFMT : 0;
}

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// End of the run of digits at `at`, leading zeros passed over: `first` is where the value begins.
size_t digits_end(std::string_view text, size_t at, size_t* first) {
  size_t end = at;
  while (end < text.size() && is_digit(text[end])) ++end;
  *first = at;
  while (*first + 1 < end && text[*first] == '0') ++*first;
  return end;
}

}  // namespace

bool is_folder(const std::string& path) { return file_type(path) == S_IFDIR; }

bool is_file(const std::string& path) { return file_type(path) == S_IFREG; }

std::string join(const std::string& folder, std::string_view name) {
  std::string path = folder;
  if (!path.empty() && path.back() != '/') path += '/';
  return path.append(name);
}

std::string base_name(const std::string& path) {
  const size_t last = path.find_last_not_of('/');
  if (last == std::string::npos) return "/";
  const size_t slash = path.find_last_of('/', last);
  const size_t first = slash == std::string::npos ? 0 : slash + 1;
  return path.substr(first, last + 1 - first);
}

std::string parent(const std::string& path) {
  const std::filesystem::path folder =
      std::filesystem::path(path.substr(0, path.find_last_not_of('/') + 1)).parent_path();
  return folder.empty() ? "." : folder.string();
}

bool is_hidden(std::string_view name) { return name.substr(0, 1) == "."; }

bool has_image_ending(std::string_view name) {
  const size_t dot = name.find_last_of('.');
  if (dot == std::string_view::npos) return false;
  std::string ending(name.substr(dot + 1));
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::string_view kEndings[] = {"png", "jpg", "jpeg", "bmp", "pgm",
                                           "ppm", "tif", "tiff", "webp"};
  return std::find(std::begin(kEndings), std::end(kEndings), ending) != std::end(kEndings);
}

bool natural_less(std::string_view a, std::string_view b) {
  size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      size_t first_a, first_b;
      const size_t end_a = digits_end(a, i, &first_a);
      const size_t end_b = digits_end(b, j, &first_b);
      if (end_a - first_a != end_b - first_b) return end_a - first_a < end_b - first_b;
      const int order =
          a.substr(first_a, end_a - first_a).compare(b.substr(first_b, end_b - first_b));
      if (order != 0) return order < 0;
      i = end_a;
      j = end_b;
    } else if (a[i] != b[j]) {
      return a[i] < b[j];
    } else {
      ++i;
      ++j;
    }
  }
  if (i < a.size() || j < b.size()) return j < b.size();
  return a < b;
}

std::vector<std::string> list_folder(const std::string& path) {
  std::error_code error;
  std::vector<std::string> names;
  std::filesystem::directory_iterator entry(path, error);
  for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
    std::string name = entry->path().filename().string();
    // macOS leaves "._NAME" beside each file on disks of other systems.
    if (!is_hidden(name)) names.push_back(std::move(name));
  }
  if (error) throw InputError(path + ": cannot list the folder: " + error.message());
  std::sort(names.begin(), names.end(), natural_less);
  return names;
}

std::vector<std::string> list_images(const std::string& path) {
  if (!is_folder(path)) return {};
  std::vector<std::string> names = list_folder(path);
  const auto other = [](const std::string& name) { return !has_image_ending(name); };
  names.erase(std::remove_if(names.begin(), names.end(), other), names.end());
  return names;
}

std::vector<std::string> list_pattern(const std::string& pattern) {
  glob_t matches{};
  const int status = glob(pattern.c_str(), GLOB_NOSORT, nullptr, &matches);
  std::vector<std::string> paths(matches.gl_pathv, matches.gl_pathv + matches.gl_pathc);
  globfree(&matches);
  if (status != 0 && status != GLOB_NOMATCH)
    throw InputError(pattern + ": cannot list what matches");
  std::sort(paths.begin(), paths.end(), natural_less);
  return paths;
}

}  // namespace unisim::sequence
