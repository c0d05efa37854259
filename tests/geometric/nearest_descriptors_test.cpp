// SPDX-License-Identifier: MIT
// The nearest of many binary descriptors, and the nearest of another group.
#include "drivers/geometric/places/nearest_descriptors.hpp"

#include <random>

#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

namespace {

OrbDescriptor random_descriptor(std::mt19937* random) {
  OrbDescriptor out;
  for (uint8_t& byte : out) byte = static_cast<uint8_t>((*random)());
  return out;
}

int32_t distance(const OrbDescriptor& a, const uint8_t* b) {
  int32_t out = 0;
  for (size_t k = 0; k < a.size(); ++k) {
    for (int differ = a[k] ^ b[k]; differ != 0; differ &= differ - 1) ++out;
  }
  return out;
}

}  // namespace

TEST_CASE("the nearest descriptor and the nearest of another group are those of a plain search") {
  std::mt19937 random(GENERATE(1U, 2U, 3U));
  std::vector<OrbDescriptor> descriptors;
  std::vector<int32_t> groups;
  for (int32_t k = 0; k < 300; ++k) {
    descriptors.push_back(random_descriptor(&random));
    groups.push_back(k / 7);
  }
  for (int round = 0; round < 50; ++round) {
    OrbDescriptor query = descriptors[random() % descriptors.size()];
    for (int k = 0; k < 20; ++k) query[random() % query.size()] ^= 1;
    const NearestDescriptors found = nearest_descriptors(descriptors, groups, query.data());
    NearestDescriptors plain;
    for (size_t k = 0; k < descriptors.size(); ++k) {
      if (distance(descriptors[k], query.data()) >= plain.distance) continue;
      plain.distance = distance(descriptors[k], query.data());
      plain.group = groups[k];
    }
    for (size_t k = 0; k < descriptors.size(); ++k) {
      if (groups[k] == plain.group) continue;
      plain.runner_up = std::min(plain.runner_up, distance(descriptors[k], query.data()));
    }
    CHECK(found.group == plain.group);
    CHECK(found.distance == plain.distance);
    CHECK(found.runner_up == plain.runner_up);
  }
}

TEST_CASE("one group alone has no runner-up, no descriptor at all no nearest") {
  const OrbDescriptor query{};
  OrbDescriptor other{};
  other[3] = 7;
  NearestDescriptors found = nearest_descriptors({other, query}, {4, 4}, query.data());
  CHECK(found.group == 4);
  CHECK(found.distance == 0);
  CHECK(found.runner_up == kFarther);
  found = nearest_descriptors({}, {}, query.data());
  CHECK(found.group == -1);
  CHECK(found.distance == kFarther);
}

}  // namespace unisim::geometric::test
