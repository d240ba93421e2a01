#include "identify/balance/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

#include "base/clones.hpp"
#include "base/scans.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kShort = 256;   // samples of a window whose nodes are made at once
constexpr std::size_t kBlock = 1024;  // intervals whose values are made at once

/// Whether windows have usable intervals only. They come in order: what is known of one run of
/// usable intervals serves all windows in it.
class Whole {
 public:
  Whole(const std::vector<std::uint8_t>& usable, std::span<const Window> windows)
      : flags_(usable.data()), last_(windows.empty() ? 0 : windows.back().end) {}

  bool operator()(const Window& window) {
    if (window.begin < from_ || window.begin > until_) {
      from_ = window.begin;
      const auto count = static_cast<std::size_t>(std::max(last_, window.end) - from_);
      const void* found = std::memchr(flags_ + from_, 0, count);
      until_ = found == nullptr ? from_ + static_cast<std::int64_t>(count)
                                : static_cast<const std::uint8_t*>(found) - flags_;
    }
    return window.end <= until_;
  }

  /// Where the run of the last window asked for ends: the next ones are whole if they end before.
  [[nodiscard]] std::int64_t until() const { return until_; }

 private:
  const std::uint8_t* flags_;
  std::int64_t last_;
  std::int64_t from_ = 0;
  std::int64_t until_ = -1;  ///< the intervals from_ .. until_ - 1 are usable
};

/// Adds values one after the other.
double add_all(double sum, const double* value, const double* end) {
  for (; end - value >= 4; value += 4) {  // fewer steps of the loop; the order stays
    sum += value[0];
    sum += value[1];
    sum += value[2];
    sum += value[3];
  }
  for (; value < end; ++value) sum += *value;
  return sum;
}

/// Whether the velocity keeps one sign over a window, ends included. They come in order, too.
class OneSided {
 public:
  OneSided(const RecordingView::Signal& velocity, std::span<const Window> windows)
      : velocity_(velocity.data()), last_(windows.empty() ? 0 : windows.back().end) {}

  /// The sign, or 0.
  double operator()(const Window& window) {
    if (window.begin < from_ || window.begin >= until_) {
      from_ = window.begin;
      const auto count = static_cast<std::size_t>(std::max(last_, window.end) - from_) + 1;
      until_ = from_ + static_cast<std::int64_t>(base::one_sided(velocity_ + from_, count));
    }
    if (window.end >= until_) return 0.0;
    return velocity_[window.begin] > 0.0 ? 1.0 : -1.0;
  }

 private:
  const double* velocity_;
  std::int64_t last_;
  std::int64_t from_ = 0;
  std::int64_t until_ = 0;  ///< the samples from_ .. until_ - 1 have one sign
};

/// Sum over a window's usable intervals of values that `fill(k, count, values)` gives for the
/// intervals from k on.
template <class Fill>
void sum_intervals(const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                   Eigen::Ref<Eigen::VectorXd> result, Fill fill) {
  if (windows.empty()) return;
  Whole whole(usable, windows);
  std::array<double, kBlock> values;
  const std::int64_t last = windows.back().end;
  std::int64_t from = 0;
  std::int64_t to = 0;  // of the intervals in `values`
  const auto sum_of = [&](const Window& window, bool all) {
    double sum = 0.0;
    for (auto k = window.begin; k < window.end;) {
      if (k < from || k >= to) {
        from = k;
        to = std::min(k + static_cast<std::int64_t>(kBlock), std::max(last, window.end));
        fill(from, static_cast<std::size_t>(to - from), values.data());
      }
      const auto stop = std::min(window.end, to);
      const double* value = values.data() + (k - from);
      if (all) {
        sum = add_all(sum, value, value + (stop - k));
        k = stop;
      } else {
        for (; k < stop; ++k, ++value) {
          if (usable[static_cast<std::size_t>(k)] != 0) sum += *value;
        }
      }
    }
    return sum;
  };
  for (std::size_t w = 0; w < windows.size();) {
    const bool all = whole(windows[w]);
    result[static_cast<Eigen::Index>(w)] = sum_of(windows[w], all);
    const Window* next = windows.data() + ++w;
    if (!all) continue;
    // Short windows are many: those of the same run whose values are there, without a question.
    const std::int64_t until = std::min(to, whole.until());
    double* sum = result.data() + w;
    for (; w < windows.size() && next->end <= until && next->begin >= from; ++w, ++next, ++sum) {
      *sum = add_all(0.0, values.data() + (next->begin - from), values.data() + (next->end - from));
    }
  }
}

/// Of signals between samples: by the trapezoid rule, and held.
JOINTID_CLONES void trapezoids(const double* signal, const double* time, std::size_t count,
                               double* values) {
  for (std::size_t i = 0; i < count; ++i) {
    values[i] = 0.5 * (signal[i] + signal[i + 1]) * (time[i + 1] - time[i]);
  }
}

JOINTID_CLONES void rectangles(const double* signal, const double* time, std::size_t count,
                               double* values) {
  for (std::size_t i = 0; i < count; ++i) values[i] = signal[i] * (time[i + 1] - time[i]);
}

/// Nodes of a whole window in which the velocity keeps one sign: the same without a question a
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

/// The change of a signal over each window's usable intervals.
void sum_changes(const RecordingView::Signal& signal, const std::vector<std::uint8_t>& usable,
                 std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  Whole whole(usable, windows);
  const double* x = signal.data();
  const Window* window = windows.data();
  const Window* const behind = window + windows.size();
  double* change = result.data();
  while (window < behind) {
    if (whole(*window)) {
      const std::int64_t from = window->begin;
      const std::int64_t until = whole.until();
      do {  // those of one run without a question
        *change++ = x[window->end] - x[window->begin];
        ++window;
      } while (window < behind && window->end <= until && window->begin >= from);
      continue;
    }
    double sum = 0.0;
    for (auto k = window->begin; k < window->end; ++k) {
      if (usable[static_cast<std::size_t>(k)] != 0) sum += x[k + 1] - x[k];
    }
    *change++ = sum;
    ++window;
  }
}

/// The series of that name.
const RecordingView::Signal& own_series(const RecordingView& r, const std::string& name) {
  for (const auto& own : r.own) {
    if (own.name == name) return own.series;
  }
  throw std::invalid_argument("the term '" + name + "' needs a recording with its series");
}

/// The trapezoid rule for a function of the position.
template <class Function>
void integrate_position(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                        std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result,
                        Function function) {
  std::array<double, kBlock + 1> samples;
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    const double* position = r.position.data() + k;
    for (std::size_t i = 0; i <= count; ++i) samples[i] = function(position[i]);
    trapezoids(samples.data(), r.time.data() + k, count, values);
  });
}

/// The trapezoid rule for a signal.
void integrate_signal(const RecordingView::Signal& signal, const RecordingView& r,
                      const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                      Eigen::Ref<Eigen::VectorXd> result) {
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    trapezoids(signal.data() + k, r.time.data() + k, count, values);
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
  Whole whole(usable, windows);
  OneSided one_sided(r.velocity, windows);
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const auto row = static_cast<Eigen::Index>(w);
    const double direction = one_sided(windows[w]);
    if (direction == 0.0 || !whole(windows[w])) {
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
      integrate_position(r, usable, windows, result,
                         [&](double angle) { return base::cos(frequency * angle); });
      return;
    case Integral::sine:
      integrate_position(r, usable, windows, result,
                         [&](double angle) { return base::sin(frequency * angle); });
      return;
    case Integral::sensor:
      integrate_signal(r.sensor, r, usable, windows, result);
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
    integrate_signal(r.torque, r, usable, windows, result);
    return;
  }
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    rectangles(r.torque.data() + k, r.time.data() + k, count, values);
  });
}

void sum_torque_steps(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  sum_changes(r.torque, usable, windows, result);
}

void integrate_bending(const Term& term, const Eigen::VectorXd& shapes, const RecordingView& r,
                       const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                       Eigen::Ref<Eigen::VectorXd> result) {
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    const auto intervals = static_cast<Eigen::Index>(count);
    const Eigen::VectorXd velocity = r.velocity.segment(k, intervals + 1);
    const auto before = velocity.head(intervals);
    const auto after = velocity.tail(intervals);
    const Eigen::VectorXd at = friction_basis(term, velocity, shapes);
    const Eigen::VectorXd between = friction_basis(term, 0.5 * (after + before), shapes);
    const auto bent =
        (2.0 * between.array() - at.tail(intervals).array() - at.head(intervals).array()) / 3.0;
    const auto lasting = (r.time.segment(k + 1, intervals) - r.time.segment(k, intervals)).array();
    Eigen::Map<Eigen::ArrayXd>(values, intervals) =
        (after.array() * before.array() > 0.0).select(bent * lasting, 0.0);
  });
}

void append_nodes(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                  std::span<const Window> windows, FrictionNodes& nodes) {
  std::array<double, kBlock> speeds;
  std::array<double, kBlock> weights;
  std::size_t made = 0;  // nodes that wait in the two
  const auto store = [&] {
    nodes.speed.insert(nodes.speed.end(), speeds.begin(), speeds.begin() + made);
    nodes.weight.insert(nodes.weight.end(), weights.begin(), weights.begin() + made);
    made = 0;
  };
  Whole whole(usable, windows);
  OneSided one_sided(r.velocity, windows);
  for (const auto& window : windows) {
    const auto count = static_cast<std::size_t>(window.end - window.begin);
    const double direction = count <= kShort ? one_sided(window) : 0.0;
    if (direction != 0.0 && count > 0 && whole(window)) {
      if (made + count + 1 > kBlock) store();
      whole_nodes(r.time.data() + window.begin, r.velocity.data() + window.begin, count, direction,
                  speeds.data() + made, weights.data() + made);
      made += count + 1;
      nodes.first.push_back(nodes.speed.size() + made);
      continue;
    }
    store();
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
