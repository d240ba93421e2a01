#include "identify/balance/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "base/clones.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kShort = 256;  // samples of a window whose nodes are made at once

/// Whether every interval of a window is usable.
bool whole(const std::vector<std::uint8_t>& usable, const Window& window) {
  const std::uint8_t* flags = usable.data() + window.begin;
  const auto count = static_cast<std::size_t>(window.end - window.begin);
  if (count > 16) return std::memchr(flags, 0, count) == nullptr;
  if (count < 8) return std::all_of(flags, flags + count, [](std::uint8_t f) { return f != 0; });
  // The usual window, without a call: eight flags at either end, which may overlap.
  const auto has_zero = [&](std::size_t from) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags + from, sizeof eight);
    return ((eight - 0x0101010101010101U) & ~eight & 0x8080808080808080U) != 0;
  };
  return !has_zero(0) && !has_zero(count - 8);
}

/// Sum over a window's usable intervals of value(k), k the interval k -> k+1.
template <class Value>
void sum_intervals(const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                   Eigen::Ref<Eigen::VectorXd> result, Value value) {
  for (std::size_t w = 0; w < windows.size(); ++w) {
    double sum = 0.0;
    if (whole(usable, windows[w])) {
      for (auto k = windows[w].begin; k < windows[w].end; ++k) sum += value(k);
    } else {
      for (auto k = windows[w].begin; k < windows[w].end; ++k) {
        if (usable[static_cast<std::size_t>(k)] != 0) sum += value(k);
      }
    }
    result[static_cast<Eigen::Index>(w)] = sum;
  }
}

/// The change of a signal over each window's usable intervals.
void sum_changes(const RecordingView::Signal& signal, const std::vector<std::uint8_t>& usable,
                 std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto [begin, end] = windows[w];
    double sum = 0.0;
    if (whole(usable, windows[w])) {
      sum = signal[end] - signal[begin];
    } else {
      for (auto k = begin; k < end; ++k) {
        if (usable[static_cast<std::size_t>(k)] != 0) sum += signal[k + 1] - signal[k];
      }
    }
    result[static_cast<Eigen::Index>(w)] = sum;
  }
}

/// 1 or -1 if all velocities of a window have that sign, else 0.
double common_sign(const RecordingView::Signal& velocity, const Window& window) {
  const double* v = velocity.data();
  const double side = v[window.begin] > 0.0 ? 1.0 : -1.0;
  for (auto k = window.begin; k <= window.end; ++k) {
    if (!(side * v[k] > 0.0)) return 0.0;
  }
  return side;
}

/// The series of that name.
const RecordingView::Signal& own_series(const RecordingView& r, const std::string& name) {
  for (const auto& own : r.own) {
    if (own.name == name) return own.series;
  }
  throw std::invalid_argument("the term '" + name + "' needs a recording with its series");
}

template <class Sample>
void trapezoid(const RecordingView& r, const std::vector<std::uint8_t>& usable,
               std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result, Sample sample) {
  sum_intervals(usable, windows, result, [&](Eigen::Index k) {
    return 0.5 * (sample(k) + sample(k + 1)) * (r.time[k + 1] - r.time[k]);
  });
}

double sign(double v) {
  return v > 0.0 ? 1.0 : (v < 0.0 ? -1.0 : 0.0);
}

/// Signs of the velocity at an interval's ends, each times the share of the interval on its side of
/// a reversal (1 without one): half the interval times these are the ends' weights.
struct Shares {
  double before;
  double after;
};
Shares shares(double v0, double v1) {
  if (!(v0 * v1 < 0.0)) return {sign(v0), sign(v1)};
  const double before = std::fabs(v0) / (std::fabs(v0) + std::fabs(v1));
  return {sign(v0) * before, sign(v1) * (1.0 - before)};
}

/// Coulomb friction of windows: the time it acts, signed. Those that are cut or hold a reversal are
/// summed over their nodes.
void integrate_sign(const Term& term, const RecordingView& r,
                    const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                    Eigen::Ref<Eigen::VectorXd> result) {
  FrictionNodes nodes;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    const double direction = common_sign(r.velocity, windows[w]);
    if (direction == 0.0 || !whole(usable, windows[w])) {
      nodes.clear();
      append_nodes(r, usable, windows.subspan(w, 1), nodes);
      integrate_friction(term, nodes_of(term.direction, nodes), nullptr, nullptr,
                         result.segment(row, 1));
      continue;
    }
    const bool acts = term.direction == model::Direction::both ||
                      (term.direction == model::Direction::positive) == (direction > 0.0);
    const double time = r.time[windows[w].end] - r.time[windows[w].begin];
    result[row] = acts ? direction * time : 0.0;
  }
}

}  // namespace

void FrictionNodes::clear() {
  speed.clear();
  logarithm.clear();
  weight.clear();
  first.assign(1, 0);
}

void integrate(const Term& term, double gear_ratio, const RecordingView& r,
               const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
               Eigen::Ref<Eigen::VectorXd> result) {
  const double frequency = term.order * (term.harmonic == Harmonic::motor ? gear_ratio : 1.0);
  switch (term.integral) {
    case Integral::velocity_change:
      sum_changes(r.velocity, usable, windows, result);
      return;
    case Integral::displacement:
      sum_changes(r.position, usable, windows, result);
      return;
    case Integral::duration:
      sum_changes(r.time, usable, windows, result);
      return;
    case Integral::cosine:
      trapezoid(r, usable, windows, result,
                [&](Eigen::Index k) { return base::cos(frequency * r.position[k]); });
      return;
    case Integral::sine:
      trapezoid(r, usable, windows, result,
                [&](Eigen::Index k) { return base::sin(frequency * r.position[k]); });
      return;
    case Integral::sensor:
      trapezoid(r, usable, windows, result, [&](Eigen::Index k) { return r.sensor[k]; });
      return;
    case Integral::own:
      sum_changes(own_series(r, term.name), usable, windows, result);
      return;
    case Integral::load_friction:
    case Integral::link_friction:
      throw std::logic_error("load friction has no integral of its own");
    case Integral::friction:
      break;
  }
  if (term.basis == model::SpeedBasis::one) {
    integrate_sign(term, r, usable, windows, result);
    return;
  }
  // A few windows at a time: their nodes stay in the cache.
  constexpr std::size_t kWindows = 64;
  FrictionNodes nodes;
  for (std::size_t w = 0; w < windows.size(); w += kWindows) {
    const auto part = windows.subspan(w, std::min(kWindows, windows.size() - w));
    const auto rows =
        result.segment(static_cast<Eigen::Index>(w), static_cast<Eigen::Index>(part.size()));
    nodes.clear();
    append_nodes(r, usable, part, nodes);
    integrate_friction(term, nodes_of(term.direction, nodes), nullptr, nullptr, rows);
  }
}

void integrate_torque(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  if (r.torque_hold == Hold::linear) {
    trapezoid(r, usable, windows, result, [&](Eigen::Index k) { return r.torque[k]; });
  } else {
    sum_intervals(usable, windows, result,
                  [&](Eigen::Index k) { return r.torque[k] * (r.time[k + 1] - r.time[k]); });
  }
}

void sum_torque_steps(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  sum_changes(r.torque, usable, windows, result);
}

void append_nodes(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                  std::span<const Window> windows, FrictionNodes& nodes) {
  std::array<double, kShort + 1> speeds;
  std::array<double, kShort + 1> weights;
  for (const auto& window : windows) {
    const auto count = static_cast<std::size_t>(window.end - window.begin);
    const double direction = count <= kShort ? common_sign(r.velocity, window) : 0.0;
    if (direction != 0.0 && whole(usable, window)) {  // the same without a question a sample
      const double* time = r.time.data() + window.begin;
      const double* velocity = r.velocity.data() + window.begin;
      double left = 0.0;
      for (std::size_t i = 0; i < count; ++i) {
        const double half = 0.5 * (time[i + 1] - time[i]) * direction;
        speeds[i] = std::fabs(velocity[i]);
        weights[i] = left + half;
        left = half;
      }
      speeds[count] = std::fabs(velocity[count]);
      weights[count] = left;
      nodes.speed.insert(nodes.speed.end(), speeds.begin(), speeds.begin() + count + 1);
      nodes.weight.insert(nodes.weight.end(), weights.begin(), weights.begin() + count + 1);
      nodes.first.push_back(nodes.speed.size());
      continue;
    }
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
      const auto [before, after] = shares(v0, v1);
      if (v0 * v1 < 0.0) {  // a node either side of rest, so that each direction keeps its own
        push(0.0, half * before);
        push(0.0, half * after);
      }
      push(std::fabs(v0), carried + half * before);
      carried = half * after;
    }
    push(std::fabs(r.velocity[window.end]), carried);
    nodes.first.push_back(nodes.speed.size());
  }
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
