// SPDX-License-Identifier: MIT
// What unisim-eval prints: the protocol, then the figures, as text or JSON.
#pragma once

#include <string>

#include "tools/common/json_text.hpp"
#include "tools/eval/ate.hpp"
#include "tools/eval/cloud_metrics.hpp"
#include "tools/eval/consistency.hpp"
#include "tools/eval/rpe.hpp"
#include "tools/eval/truth_cloud.hpp"

namespace unisim::eval {

using tools::Json;

/// How two trajectories were compared.
struct Protocol {
  const Trajectory& ground_truth;
  const Trajectory& estimate;
  Alignment alignment;
  double max_dt_s;
};

Json ate_json(const Protocol& protocol, const Ate& ate);
Json rpe_json(const Protocol& protocol, const RpeStep& step, const Rpe& rpe);

Json consistency_json(const Protocol& protocol, const Consistency& consistency);

/// How two clouds were compared.
struct CloudProtocol {
  const Cloud& ground_truth;
  const Cloud& estimate;
  Similarity T_truth_estimate;
  double max_distance;
  double voxel;  ///< 0: not thinned
};

Json cloud_json(const CloudProtocol& protocol, const CloudMetrics& metrics);
/// Where the true cloud is from.
Json truth_json(const DepthImages& found, const TruthOptions& options, const TruthCloud& truth);

/// The same as lines for people: the protocol on top, figures with their units below.
std::string text_of(const Json& result);

}  // namespace unisim::eval
