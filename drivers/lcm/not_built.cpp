// SPDX-License-Identifier: MIT
// What publisher.h, subscriber.h and odometry_listener.hpp say in a build without LCM.
#include <cstdio>

#include "drivers/lcm/error.hpp"
#include "drivers/lcm/odometry_listener.hpp"
#include "drivers/lcm/publisher.h"
#include "drivers/lcm/subscriber.h"

namespace {

constexpr const char* kWhy =
    "built without LCM; install liblcm-dev and liblcm-bin, then configure and build again";

void refuse(int32_t* problem, char* message, size_t capacity) {
  if (problem != nullptr) *problem = UNISIM_LCM_NOT_BUILT;
  if (message == nullptr || capacity == 0) return;
  std::snprintf(message, capacity, "lcm: %s", kWhy);
}

}  // namespace

unisim_source* unisim_lcm_subscribe(const unisim_lcm_subscriber_config*, int32_t* problem,
                                    char* message, size_t capacity) {
  refuse(problem, message, capacity);
  return nullptr;
}

const char* unisim_lcm_subscriber_note(const unisim_source*, int32_t) { return nullptr; }

void unisim_lcm_subscriber_get_counts(const unisim_source*, unisim_lcm_subscriber_counts*) {}

unisim_lcm_publisher* unisim_lcm_publisher_create(const unisim_lcm_publisher_config*,
                                                  int32_t* problem, char* message,
                                                  size_t capacity) {
  refuse(problem, message, capacity);
  return nullptr;
}

void unisim_lcm_publisher_destroy(unisim_lcm_publisher*) {}

void unisim_lcm_publisher_flush(unisim_lcm_publisher*) {}

int unisim_lcm_publisher_set_unit(unisim_lcm_publisher*, int32_t, double) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_pose(unisim_lcm_publisher*, int64_t, const unisim_sim3*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_keyframe(unisim_lcm_publisher*, const unisim_pose*, int32_t, const double*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_correction(unisim_lcm_publisher*, const unisim_lcm_correction*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_trajectory(unisim_lcm_publisher*, int64_t, int32_t, const unisim_pose*,
                                  int32_t, int32_t, int32_t) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_status(unisim_lcm_publisher*, const unisim_lcm_status*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_points(unisim_lcm_publisher*, const unisim_lcm_points*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_publish_image(unisim_lcm_publisher*, int64_t, const unisim_image*) {
  return UNISIM_LCM_REFUSED;
}

int unisim_lcm_next_request(unisim_lcm_publisher*, int32_t*) { return 0; }

void unisim_lcm_publisher_get_counts(const unisim_lcm_publisher*, unisim_lcm_publisher_counts*) {}

namespace unisim::lcm {

class OdometryListener::Impl {};

OdometryListener::OdometryListener(const OdometryListenerConfig&, pipeline::DistanceInbox*) {
  throw LcmError(UNISIM_LCM_NOT_BUILT, kWhy);
}

OdometryListener::~OdometryListener() = default;

OdometryCounts OdometryListener::counts() const { return {}; }

}  // namespace unisim::lcm
