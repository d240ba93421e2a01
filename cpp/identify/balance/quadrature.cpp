#include "identify/balance/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include "base/clones.hpp"
#include "identify/balance/interval_residual.hpp"
#include "identify/balance/window_runs.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kIntervals = 1024;  // intervals per block of values

/// Adds values one after the other.
double add_all(double sum, const double* value, const double* end) {
  for (; end - value >= 4; value += 4) {  // fewer loop steps; the order of the sum stays
    sum += value[0];
    sum += value[1];
    sum += value[2];
    sum += value[3];
  }
  for (; value < end; ++value) sum += *value;
  return sum;
}

/// Sums, over a window's usable intervals, the values that `fill(k, count, values)` computes for
/// the intervals from k on.
template <class Fill>
void sum_intervals(const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                   Eigen::Ref<Eigen::VectorXd> result, Fill fill) {
  if (windows.empty()) return;
  WholeWindows whole(usable, windows);
  std::array<double, kIntervals> values;
  const std::int64_t last = windows.back().end;
  std::int64_t from = 0;
  std::int64_t to = 0;  // range of the intervals in `values`
  const auto sum_of = [&](const Window& window, bool all) {
    double sum = 0.0;
    for (auto k = window.begin; k < window.end;) {
      if (k < from || k >= to) {
        from = k;
        to = std::min(k + static_cast<std::int64_t>(kIntervals), std::max(last, window.end));
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
    // Short windows are numerous. Windows in one usable run with computed values need no checks.
    const std::int64_t until = std::min(to, whole.until());
    double* sum = result.data() + w;
    for (; w < windows.size() && next->end <= until && next->begin >= from; ++w, ++next, ++sum) {
      *sum = add_all(0.0, values.data() + (next->begin - from), values.data() + (next->end - from));
    }
  }
}

/// Integrals of signals between samples: by the trapezoidal rule, or held.
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

JOINTID_CLONES void middles(const double* velocity, std::size_t count, double* middle) {
  for (std::size_t i = 0; i < count; ++i) middle[i] = 0.5 * (velocity[i + 1] + velocity[i]);
}

/// Excess of friction over its straight line, by Simpson's rule; 0 over a reversal.
JOINTID_CLONES void bends(const double* velocity, const double* time, const double* at,
                          const double* between, std::size_t count, double* values) {
  for (std::size_t i = 0; i < count; ++i) {
    const double bent = (2.0 * between[i] - at[i + 1] - at[i]) / 3.0;
    const double lasting = time[i + 1] - time[i];
    values[i] = velocity[i + 1] * velocity[i] > 0.0 ? bent * lasting : 0.0;
  }
}

/// The change of a signal over each window's usable intervals.
void sum_changes(const RecordingView::Signal& signal, const std::vector<std::uint8_t>& usable,
                 std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  WholeWindows whole(usable, windows);
  const double* x = signal.data();
  const Window* window = windows.data();
  const Window* const behind = window + windows.size();
  double* change = result.data();
  while (window < behind) {
    if (whole(*window)) {
      const std::int64_t from = window->begin;
      const std::int64_t until = whole.until();
      do {  // windows of one run need no checks
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

/// The trapezoidal rule for a function of the position.
template <class Function>
void integrate_position(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                        std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result,
                        Function function) {
  std::array<double, kIntervals + 1> samples;
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    const double* position = r.position.data() + k;
    for (std::size_t i = 0; i <= count; ++i) samples[i] = function(position[i]);
    trapezoids(samples.data(), r.time.data() + k, count, values);
  });
}

/// The trapezoidal rule for a signal.
void integrate_signal(const RecordingView::Signal& signal, const RecordingView& r,
                      const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                      Eigen::Ref<Eigen::VectorXd> result) {
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    trapezoids(signal.data() + k, r.time.data() + k, count, values);
  });
}

/// Coulomb friction of windows: the signed time of motion. Windows that are cut or hold a reversal
/// are summed over their nodes.
void integrate_sign(const Term& term, const RecordingView& r,
                    const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                    Eigen::Ref<Eigen::VectorXd> result) {
  FrictionNodes nodes;
  WholeWindows whole(usable, windows);
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

/// The speed beyond which a term's decay is negligible against 1; infinite without a decay.
double vanished_beyond(const Term& term, const Eigen::VectorXd& shapes) {
  if (term.basis == model::SpeedBasis::gaussian) return std::sqrt(vanishing_at(shapes[0]));
  if (term.basis != model::SpeedBasis::general) return HUGE_VAL;
  const double power = vanishing_at(1.0);
  return shapes[0] * base::exp(base::log(power) / shapes[1]);
}

}  // namespace

const RecordingView::Signal& own_series(const RecordingView& r, const std::string& name) {
  for (const auto& own : r.own) {
    if (own.name == name) return own.series;
  }
  throw std::invalid_argument("the term '" + name + "' needs a recording with its series");
}

bool has_vanished(double rate, const double* velocity, std::size_t count) {
  const double slowest = base::least_sizes(velocity, count).any;
  return slowest * slowest > vanishing_at(rate);
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
  if (term.basis == model::SpeedBasis::constant) {
    integrate_sign(term, r, usable, windows, result);
    return;
  }
  // A few windows at a time, so that their nodes stay in the cache.
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

void integrate_residual(const std::vector<KnownTerm>& terms, double gear_ratio,
                        const RecordingView& r, const std::vector<std::uint8_t>& usable,
                        std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  static_assert(kIntervals <= detail::kMostIntervals);
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    detail::interval_residuals(terms, gear_ratio, r, k, count, values);
  });
}

void sum_torque_steps(const RecordingView& r, const std::vector<std::uint8_t>& usable,
                      std::span<const Window> windows, Eigen::Ref<Eigen::VectorXd> result) {
  sum_changes(r.torque, usable, windows, result);
}

void integrate_bending(const Term& term, const Eigen::VectorXd& shapes, const RecordingView& r,
                       const std::vector<std::uint8_t>& usable, std::span<const Window> windows,
                       Eigen::Ref<Eigen::VectorXd> result) {
  const double vanished = needs_load(term) ? HUGE_VAL : vanished_beyond(term, shapes);
  const auto part = [&](std::int64_t k, std::size_t count, double* values) {
    const auto intervals = static_cast<Eigen::Index>(count);
    const double* velocity = r.velocity.data() + k;
    if (base::least_sizes(velocity, count + 1).any > vanished) {
      Eigen::Map<Eigen::ArrayXd>(values, intervals).setZero();
      return;
    }
    const Eigen::VectorXd at = friction_basis(term, r.velocity.segment(k, intervals + 1), shapes);
    Eigen::VectorXd between(intervals);
    middles(velocity, count, between.data());
    between = friction_basis(term, between, shapes);
    bends(velocity, r.time.data() + k, at.data(), between.data(), count, values);
  };
  constexpr std::size_t kTogether = 64;  // intervals per check whether all are too fast for a decay
  sum_intervals(usable, windows, result, [&](std::int64_t k, std::size_t count, double* values) {
    for (std::size_t i = 0; i < count; i += kTogether) {
      part(k + static_cast<std::int64_t>(i), std::min(kTogether, count - i), values + i);
    }
  });
}

}  // namespace jointid::identify
