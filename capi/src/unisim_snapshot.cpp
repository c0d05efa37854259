// SPDX-License-Identifier: MIT
// Maps saved and loaded: argument checks and calls into core.
#include "capi/src/handle.hpp"
#include "capi/src/read_write.hpp"
#include "capi/src/struct_size.hpp"

using unisim::check_session;
using unisim::core;
using unisim::LoadProblem;
using unisim::LoadReport;
using unisim::to_c;

static_assert(UNISIM_LOAD_OK == static_cast<int>(LoadProblem::kNone) &&
                  UNISIM_LOAD_END == static_cast<int>(LoadProblem::kEnd) &&
                  UNISIM_LOAD_MAGIC == static_cast<int>(LoadProblem::kMagic) &&
                  UNISIM_LOAD_VERSION == static_cast<int>(LoadProblem::kVersion) &&
                  UNISIM_LOAD_CHECKSUM == static_cast<int>(LoadProblem::kChecksum) &&
                  UNISIM_LOAD_CONTENT == static_cast<int>(LoadProblem::kContent) &&
                  UNISIM_LOAD_CAPACITY == static_cast<int>(LoadProblem::kCapacity) &&
                  UNISIM_LOAD_SETTING == static_cast<int>(LoadProblem::kSetting),
              "numbers of load problems");

namespace {

/// The rest of `to` is zero.
template <size_t kSize>
void copy_text(const char* from, char (&to)[kSize]) {
  for (size_t k = 0; k + 1 < kSize && from[k] != '\0'; ++k) to[k] = from[k];
}

}  // namespace

unisim_status unisim_save_map(const unisim_session* session, unisim_write_fn write, void* context) {
  const unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  if (write == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->save(write, context));
}

unisim_status unisim_load_map(unisim_session* session, unisim_read_fn read, void* context) {
  const unisim_status status = check_session(session);
  if (status != UNISIM_OK) return status;
  if (read == nullptr) return UNISIM_ERR_INVALID_ARGUMENT;
  return to_c(core(session)->load(read, context));
}

unisim_status unisim_get_load_report(const unisim_session* session, unisim_load_report* report) {
  unisim_status status = check_session(session);
  if (status == UNISIM_OK) status = unisim::check_output(report);
  if (status != UNISIM_OK) return status;
  const LoadReport& found = core(session)->load_report();
  unisim_load_report r = {};
  r.problem = static_cast<int32_t>(found.problem);
  copy_text(found.section, r.section);
  copy_text(found.setting, r.setting);
  r.needed = found.needed;
  r.given = found.given;
  unisim::write_struct(r, unisim::struct_size_of(report), report);
  return UNISIM_OK;
}
