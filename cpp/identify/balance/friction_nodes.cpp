#include "identify/balance/friction_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/clones.hpp"
#include "identify/balance/window_runs.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kShort =
    256;  // largest number of samples in a window whose nodes are made in one loop
constexpr std::size_t kStored = 1024;  // size of the buffer for nodes

/// Nodes of a whole window in which the velocity keeps one sign: the same without a check per
/// sample.
JOINTID_CLONES void whole_nodes(const double* time, const double* velocity, std::size_t count,
                                double direction, double* speeds, double* weights) {
  for (std::size_t i = 0; i <= count; ++i) speeds[i] = std::fabs(velocity[i]);
  weights[0] = 0.5 * (time[1] - time[0]) * direction;
  for (std::size_t i = 1; i < count; ++i) {
    weights[i] =
        0.5 * (time[i] - time[i - 1]) * direction + 0.5 * (time[i + 1] - time[i]) * direction;
  }
  weights[count] = 0.5 * (time[count] - time[count - 1]) * direction;
}

double sign(double v) {
  return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
}

}  // namespace

Shares shares(double v0, double v1) {
  if (!(v0 * v1 < 0.0)) return {sign(v0), sign(v1)};
  const double before = std::fabs(v0) / (std::fabs(v0) + std::fabs(v1));
  return {sign(v0) * before, sign(v1) * (1.0 - before)};
}

void FrictionNodes::clear() {
  speed.clear();
  logarithm.clear();
  weight.clear();
  first.assign(1, 0);
}

void append_nodes(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                  std::span<const Window> windows, FrictionNodes& nodes) {
  std::array<double, kStored> speeds;
  std::array<double, kStored> weights;
  std::size_t made = 0;  // nodes that wait in the two buffers
  const auto store = [&] {
    nodes.speed.insert(nodes.speed.end(), speeds.begin(), speeds.begin() + made);
    nodes.weight.insert(nodes.weight.end(), weights.begin(), weights.begin() + made);
    made = 0;
  };
  WholeWindows whole(usable, windows);
  OneSided one_sided(r.velocity, windows);
  for (const auto& window : windows) {
    const auto count = static_cast<std::size_t>(window.end - window.begin);
    const double direction = count <= kShort ? one_sided(window) : 0.0;
    if (direction != 0.0 && count > 0 && whole(window)) {
      if (made + count + 1 > kStored) store();
      whole_nodes(r.time.data() + window.begin, r.velocity.data() + window.begin, count, direction,
                  speeds.data() + made, weights.data() + made);
      made += count + 1;
      nodes.first.push_back(nodes.speed.size() + made);
      continue;
    }
    store();
    double carried = 0.0;  // weight of this interval's first sample from the previous interval
    const auto push = [&](double speed, double weight) {
      if (weight == 0.0) return;
      nodes.speed.push_back(speed);
      nodes.weight.push_back(weight);
    };
    for (auto k = window.begin; k < window.end; ++k) {
      const double v0 = r.velocity[k];
      const double v1 = r.velocity[k + 1];
      if (usable[static_cast<std::size_t>(k)] == 0) {
        push(std::fabs(v0), carried);
        carried = 0.0;
        continue;
      }
      const double half = 0.5 * (r.time[k + 1] - r.time[k]);
      const auto [before, after] = shares(v0, v1);
      if (v0 * v1 < 0.0) {  // a node on either side of rest, one for each direction
        push(0.0, half * before);
        push(0.0, half * after);
      }
      push(std::fabs(v0), carried + half * before);
      carried = half * after;
    }
    push(std::fabs(r.velocity[window.end]), carried);
    nodes.first.push_back(nodes.speed.size());
  }
  store();
}

FrictionNodes nodes_of(model::Direction direction, const FrictionNodes& nodes) {
  if (direction == model::Direction::both) return nodes;
  const double wanted = direction == model::Direction::positive ? 1.0 : -1.0;
  FrictionNodes result;
  for (std::size_t w = 0; w + 1 < nodes.first.size(); ++w) {
    for (std::size_t i = nodes.first[w]; i < nodes.first[w + 1]; ++i) {
      if (nodes.weight[i] * wanted <= 0.0) continue;
      result.speed.push_back(nodes.speed[i]);
      result.weight.push_back(nodes.weight[i]);
      if (!nodes.logarithm.empty()) result.logarithm.push_back(nodes.logarithm[i]);
    }
    result.first.push_back(result.speed.size());
  }
  return result;
}

}  // namespace jointid::identify
