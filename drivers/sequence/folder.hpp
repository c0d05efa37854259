// SPDX-License-Identifier: MIT
// Looking into folders: existence, listing, natural order, patterns.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace unisim::sequence {

bool is_folder(const std::string& path);
bool is_file(const std::string& path);

/// "a" + "b" with one slash between.
std::string join(const std::string& folder, std::string_view name);

/// Last part of a path; of "x/y/" it is "y".
std::string base_name(const std::string& path);

/// Folder above; "" becomes ".".
std::string parent(const std::string& path);

/// True for a name that begins with a dot: no input, except where it is asked for by name.
bool is_hidden(std::string_view name);

/// True for a name that ends like an image OpenCV reads, in small or capital letters.
bool has_image_ending(std::string_view name);

/// Order in which img2 comes before img10.
bool natural_less(std::string_view a, std::string_view b);

/// Names in a folder in natural order, without hidden ones.
/// @throws InputError when it is missing or may not be read
std::vector<std::string> list_folder(const std::string& path);

/// Names in a folder of files that end like an image, in natural order; none if there is no folder.
std::vector<std::string> list_images(const std::string& path);

/// Paths that match a pattern with * ? [], in natural order. @throws InputError when it cannot be
/// read
std::vector<std::string> list_pattern(const std::string& pattern);

}  // namespace unisim::sequence
