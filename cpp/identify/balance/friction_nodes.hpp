#pragma once
// Where friction's integral takes its values: at the samples (trapezoid), and in an interval with a
// reversal at the zero crossing of the interpolated velocity.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "identify/balance/terms.hpp"
#include "identify/recording/recording.hpp"
#include "identify/recording/windows.hpp"

namespace jointid::identify {

/// Signs of the velocity at an interval's ends, each times the share of the interval on its side of
/// a reversal (1 without one): half the interval times these are the ends' weights.
struct Shares {
  double before;
  double after;
};
Shares shares(double v0, double v1);

/// Nodes of all windows in a row: integral over window w of sgn v h(|v|) = sum of weight[i]
/// h(speed[i]), first[w] <= i < first[w+1]. Samples in unusable intervals have no node; memory is
/// two doubles a sample, three with the logarithms that the general decay needs.
struct FrictionNodes {
  std::vector<double> speed;
  std::vector<double> logarithm;  ///< model::log_speed of each, or empty
  std::vector<double> weight;
  std::vector<std::size_t> first{0};
  void clear();
  void take_logarithms();
};

/// Appends the nodes of a recording's windows.
void append_nodes(const RecordingView& recording, const std::vector<std::uint8_t>& usable,
                  std::span<const Window> windows, FrictionNodes& nodes);

/// The nodes at which the joint moves in one direction.
FrictionNodes nodes_of(model::Direction direction, const FrictionNodes& nodes);

}  // namespace jointid::identify
