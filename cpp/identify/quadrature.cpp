#include "identify/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace jointid::identify {

namespace {

constexpr std::size_t kBlock = 2048;  // nodes: two buffers stay in the first-level cache

/// Sum over a window's usable intervals of value(k), k the interval k -> k+1.
template <class Value>
void sum_intervals(const std::vector<std::uint8_t>& usable, const std::vector<Window>& windows,
                   Eigen::Ref<Eigen::VectorXd> result, Value value) {
  for (std::size_t w = 0; w < windows.size(); ++w) {
    double sum = 0.0;
    for (auto k = windows[w].begin; k < windows[w].end; ++k) {
      if (usable[static_cast<std::size_t>(k)] != 0) sum += value(k);
    }
    result[static_cast<Eigen::Index>(w)] = sum;
  }
}

template <class Sample>
void trapezoid(const Recording& r, const std::vector<std::uint8_t>& usable,
               const std::vector<Window>& windows, Eigen::Ref<Eigen::VectorXd> result,
               Sample sample) {
  sum_intervals(usable, windows, result, [&](Eigen::Index k) {
    return 0.5 * (sample(k) + sample(k + 1)) * (r.time[k + 1] - r.time[k]);
  });
}

double sign(double v) {
  return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
}

}  // namespace

void integrate(Integral integral, const Recording& r, const std::vector<std::uint8_t>& usable,
               const std::vector<Window>& windows, Eigen::Ref<Eigen::VectorXd> result) {
  switch (integral) {
    case Integral::velocity_change:
      sum_intervals(usable, windows, result,
                    [&](Eigen::Index k) { return r.velocity[k + 1] - r.velocity[k]; });
      return;
    case Integral::displacement:
      sum_intervals(usable, windows, result,
                    [&](Eigen::Index k) { return r.position[k + 1] - r.position[k]; });
      return;
    case Integral::duration:
      sum_intervals(usable, windows, result,
                    [&](Eigen::Index k) { return r.time[k + 1] - r.time[k]; });
      return;
    case Integral::cosine:
      trapezoid(r, usable, windows, result,
                [&](Eigen::Index k) { return base::cos(r.position[k]); });
      return;
    case Integral::sine:
      trapezoid(r, usable, windows, result,
                [&](Eigen::Index k) { return base::sin(r.position[k]); });
      return;
    case Integral::sensor:
      trapezoid(r, usable, windows, result, [&](Eigen::Index k) { return r.sensor[k]; });
      return;
    case Integral::friction:
      break;
  }
  FrictionNodes nodes;
  append_nodes(r, usable, windows, nodes);
  integrate_friction(model::SpeedBasis::one, nodes, 0.0, nullptr, result);
}

void integrate_torque(const Recording& r, const std::vector<std::uint8_t>& usable,
                      const std::vector<Window>& windows, Eigen::Ref<Eigen::VectorXd> result) {
  if (r.torque_hold == Hold::linear) {
    trapezoid(r, usable, windows, result, [&](Eigen::Index k) { return r.torque[k]; });
  } else {
    sum_intervals(usable, windows, result,
                  [&](Eigen::Index k) { return r.torque[k] * (r.time[k + 1] - r.time[k]); });
  }
}

void append_nodes(const Recording& r, const std::vector<std::uint8_t>& usable,
                  const std::vector<Window>& windows, FrictionNodes& nodes) {
  for (const auto& window : windows) {
    double carried = 0.0;  // weight that the previous interval left on this interval's first sample
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
      double before =
          1.0;  // share of the interval before the reversal belongs to sample k, the rest to k + 1
      double after = 1.0;
      if (v0 * v1 < 0.0) {
        before = std::fabs(v0) / (std::fabs(v0) + std::fabs(v1));
        after = 1.0 - before;
        push(0.0, half * (sign(v0) * before + sign(v1) * after));
      }
      push(std::fabs(v0), carried + half * sign(v0) * before);
      carried = half * sign(v1) * after;
    }
    push(std::fabs(r.velocity[window.end]), carried);
    nodes.first.push_back(nodes.speed.size());
  }
}

void integrate_friction(model::SpeedBasis basis, const FrictionNodes& nodes, double shape,
                        const base::Cancel* cancel, Eigen::Ref<Eigen::VectorXd> column,
                        Eigen::VectorXd* slope) {
  std::array<double, kBlock> value;
  std::array<double, kBlock> change;
  const std::size_t windows = nodes.first.size() - 1;
  const std::size_t total = nodes.speed.size();
  std::size_t w = 0;
  double sum = 0.0;
  double slope_sum = 0.0;
  const auto finish = [&](std::size_t reached) {
    while (w < windows && nodes.first[w + 1] <= reached) {
      column[static_cast<Eigen::Index>(w)] = sum;
      if (slope != nullptr) (*slope)[static_cast<Eigen::Index>(w)] = slope_sum;
      sum = slope_sum = 0.0;
      ++w;
    }
  };
  finish(0);  // windows without a node
  for (std::size_t begin = 0; begin < total; begin += kBlock) {
    if (cancel != nullptr) cancel->check();
    const std::size_t count = std::min(kBlock, total - begin);
    const double* speed = nodes.speed.data() + begin;
    const double* weight = nodes.weight.data() + begin;
    for (std::size_t i = 0; i < count; ++i)
      value[i] = weight[i] * model::basis_value(basis, speed[i], shape);
    if (slope != nullptr) {
      for (std::size_t i = 0; i < count; ++i)
        change[i] = weight[i] * model::basis_slope(basis, speed[i], shape);
    }
    std::size_t i = 0;
    while (i < count) {
      const std::size_t stop = std::min(count, nodes.first[w + 1] - begin);
      for (std::size_t j = i; j < stop; ++j) sum += value[j];
      if (slope != nullptr) {
        for (std::size_t j = i; j < stop; ++j) slope_sum += change[j];
      }
      i = stop;
      finish(begin + i);
    }
  }
}

}  // namespace jointid::identify
