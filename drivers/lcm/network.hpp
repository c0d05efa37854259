// SPDX-License-Identifier: MIT
// Opens what an LCM URL names. Mistakes that liblcm answers with NULL are told apart here.
#pragma once

#include <lcm/lcm.h>

#include <cstdint>
#include <memory>
#include <string>

namespace unisim::lcm {

struct DestroyLcm {
  void operator()(lcm_t* handle) const { lcm_destroy(handle); }
};
using LcmPtr = std::unique_ptr<lcm_t, DestroyLcm>;

/// Until a thread that listens looks whether it is to end.
inline constexpr int kSliceMs = 100;
/// Largest time of a message that is one in nanoseconds too.
inline constexpr int64_t kLastMicrosecond = INT64_MAX / 1000;

enum class Direction { kPublish, kSubscribe };

/// A URL in its parts: provider://address?name=value&...
struct Url {
  std::string text;
  std::string provider;
  std::string address;
  int64_t receive_bytes = 0;  ///< recv_buf_size, 0 if not given
};

/// @param url NULL or "": the default
/// @throws LcmError when liblcm would not understand it, or it makes no sense in this direction
Url parse_url(const char* url, Direction direction);

/// @throws LcmError unless it is the name of one channel: liblcm takes it for a regular expression
void check_channel(const std::string& channel);

/// @throws LcmError when there is no route for multicast, no server, or liblcm cannot open it
LcmPtr open_network(const Url& url);

/// Bytes the system lets a socket have to receive: with no setting of its own, and at most.
/// 0: not known.
struct ReceiveLimits {
  int64_t usual = 0;
  int64_t most = 0;
};
ReceiveLimits receive_limits();

}  // namespace unisim::lcm
