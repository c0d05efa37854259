// SPDX-License-Identifier: MIT
// unisim-bench places: time of a search among many keyframes, and of adding one.
#include "tools/bench/places/places_command.hpp"

#include <memory>
#include <string>
#include <vector>

#include "tools/bench/process.hpp"
#include "tools/bench/times.hpp"
#include "tools/common/failure.hpp"
#include "tools/synth/random.hpp"
#include "unisim/places.h"
#include "unisim/unisim.h"

namespace unisim::bench {
namespace {

constexpr int32_t kMatches = 5;

void check(unisim_status status, const char* call) {
  if (status == UNISIM_OK) return;
  throw tools::Failure(tools::kExitOther, std::string(call) + ": " + unisim_status_string(status));
}

std::vector<int8_t> any_descriptor(int32_t dimension, synth::Random* random) {
  std::vector<int8_t> out;
  for (int32_t k = 0; k < dimension; ++k) {
    out.push_back(static_cast<int8_t>(random->uniform(-100.0, 100.0)));
  }
  return out;
}

}  // namespace

int places_command(const PlacesSettings& settings) {
  unisim_places_config config;
  check(unisim_places_config_init(&config, sizeof config), "unisim_places_config_init");
  config.capacity = settings.keyframes;
  size_t size = 0;
  check(unisim_places_arena_size(&config, &size), "unisim_places_arena_size");
  const std::unique_ptr<char[]> arena(new char[size]);
  unisim_places* places = nullptr;
  check(unisim_places_create(&places, &config, arena.get(), size), "unisim_places_create");
  synth::Random random(7);
  std::vector<double> add_ms;
  for (int32_t id = 0; id < settings.keyframes; ++id) {
    const std::vector<int8_t> descriptor = any_descriptor(config.dimension, &random);
    const double start = process_cpu_ms();
    check(unisim_places_add(places, id, descriptor.data(), nullptr), "unisim_places_add");
    add_ms.push_back(process_cpu_ms() - start);
  }
  std::vector<double> query_ms;
  for (int32_t k = 0; k < settings.repeat; ++k) {
    const std::vector<int8_t> descriptor = any_descriptor(config.dimension, &random);
    unisim_places_question question = {};
    question.struct_size = sizeof question;
    question.id = settings.keyframes;
    question.gap = 20;
    question.spread = 4;
    question.descriptor = descriptor.data();
    unisim_places_match matches[kMatches];
    int32_t count = 0;
    const double start = process_cpu_ms();
    check(unisim_places_query(places, &question, matches, kMatches, &count), "unisim_places_query");
    query_ms.push_back(process_cpu_ms() - start);
  }
  unisim_places_destroy(places);
  print_result({{"keyframes", settings.keyframes},
                {"dimension", config.dimension},
                {"arena_bytes", size},
                {"query_ms", times_json(query_ms)},
                {"add_ms", times_json(add_ms)}},
               settings.json);
  return tools::kExitDone;
}

}  // namespace unisim::bench
