// SPDX-License-Identifier: MIT
// Maps of a predictor in memory.
#include "tests/geometric/map_bytes.hpp"

#include <cstring>

#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

int try_save(unisim_predictor* table, MapBytes* out, size_t room) {
  struct Sink {
    MapBytes* out;
    size_t room;
  } sink = {out, room};
  out->clear();
  const auto write = [](void* context, const void* bytes, size_t size) -> int32_t {
    auto* to = static_cast<Sink*>(context);
    if (size > to->room - to->out->size()) return 0;
    const auto* from = static_cast<const uint8_t*>(bytes);
    to->out->insert(to->out->end(), from, from + size);
    return 1;
  };
  return table->save_map(table, write, &sink);
}

MapBytes save(unisim_predictor* table) {
  MapBytes out;
  REQUIRE(try_save(table, &out) == UNISIM_PREDICTION_OK);
  return out;
}

int try_load(unisim_predictor* table, const MapBytes& map, int32_t* next_keyframe) {
  struct Source {
    const MapBytes* map;
    size_t at;
  } source = {&map, 0};
  const auto read = [](void* context, void* bytes, size_t size) -> int32_t {
    auto* from = static_cast<Source*>(context);
    if (size > from->map->size() - from->at) return 0;
    std::memcpy(bytes, from->map->data() + from->at, size);
    from->at += size;
    return 1;
  };
  const int status = table->load_map(table, read, &source, next_keyframe);
  if (status == UNISIM_PREDICTION_OK) CHECK(source.at == map.size());
  return status;
}

int32_t load(unisim_predictor* table, const MapBytes& map) {
  int32_t next = -1;
  const int status = try_load(table, map, &next);
  INFO(table->message(table));
  REQUIRE(status == UNISIM_PREDICTION_OK);
  return next;
}

int locate(unisim_predictor* table, const GrayImage& image, unisim_location* out) {
  unisim_frame frame{};
  frame.image = {image.data(), kWidth, kHeight, kWidth, UNISIM_PIXEL_GRAY8};
  return table->locate(table, &frame, out);
}

}  // namespace unisim::geometric::test
