#pragma once
// Nodes of friction's integral: the samples (trapezoidal rule) and, in an interval with a reversal,
// the zero crossing of the interpolated velocity.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "identify/balance/terms.hpp"
#include "identify/recording/recording.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::identify {

/// The sign of the velocity at each end of an interval, times the share of the interval on that
/// side of a reversal (1 without a reversal). Half the interval times these shares gives the
/// weights of the ends.
struct Shares {
  double before;
  double after;
};
Shares shares(double v0, double v1);

/// Nodes of all windows in one array: the integral over window w of sgn v h(|v|) is the sum of
/// weight[i] h(speed[i]), first[w] <= i < first[w+1]. Samples in unusable intervals have no node.
/// Memory is two doubles per sample, or three with the logarithms that the general decay needs.
struct FrictionNodes {
  std::vector<double> speed;
  std::vector<double> logarithm;  ///< model::log_speed of each node, or empty
  std::vector<double> weight;
  std::vector<std::size_t> first{0};
  void clear();
  void take_logarithms();
};

/// Appends the nodes of a recording's windows.
void append_nodes(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                  std::span<const Window> windows, FrictionNodes& nodes);

/// The nodes at which the joint moves in this direction.
FrictionNodes nodes_of(model::Direction direction, const FrictionNodes& nodes);

}  // namespace jointid::identify
