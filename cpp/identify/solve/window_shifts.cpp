#include "identify/solve/window_shifts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "base/gram.hpp"
#include "identify/penalty/penalty_parts.hpp"
#include "identify/solve/refit.hpp"

namespace jointid::identify {

namespace {

constexpr double kSmallest =
    1e-14;  // of a column's square: a smaller value is rounding of the products
constexpr double kShare = 0.02;  // of a shift, which is itself a part of an error
constexpr std::int64_t kKeptSamples =
    1 << 20;  // samples up to which the parts are kept between steps

/// Windows, and the first window of each group, followed by the number of windows.
struct Nested {
  CutWindows halves;
  std::vector<std::size_t> pairs;  ///< halves of two neighbouring windows each
  CutWindows joined;
};

bool any_usable(const MaskedRecording& recording, const Window& window) {
  const auto begin = recording.usable().begin();
  return std::any_of(begin + window.begin, begin + window.end,
                     [](std::uint8_t flag) { return flag != 0; });
}

Nested nested(const Penalty& penalty, const Penalty::Masked& recordings) {
  const auto& windows = penalty.windows();
  const auto& run = penalty.recording_of();
  Nested result;
  result.halves.windows.reserve(2 * windows.size());
  result.halves.recording_of.reserve(2 * windows.size());
  const auto add = [](CutWindows& cut, const Window& window, int recording) {
    cut.windows.push_back(window);
    cut.recording_of.push_back(recording);
  };
  std::vector<std::int64_t> places;
  for (std::size_t w = 0; w < windows.size(); ++w) {
    const Window& window = windows[w];
    const auto number = static_cast<std::size_t>(run[w]);
    const bool begins = w == 0 || run[w] != run[w - 1];
    if (begins) {
      const auto end = std::upper_bound(run.begin(), run.end(), run[w]);
      const auto own =
          std::span(windows).subspan(w, static_cast<std::size_t>(end - run.begin()) - w);
      const auto found =
          places_of(recordings[number]->recording(), own, penalty.cut_durations()[number]);
      places.insert(places.end(), found.begin(), found.end());
    }
    // The windows of twice the duration, from two neighbours or from one alone.
    if (places[w] % 2 != 0 && !begins && windows[w - 1].end == window.begin) {
      result.joined.windows.back().end = window.end;
    } else {
      result.pairs.push_back(result.halves.windows.size());
      add(result.joined, window, run[w]);
    }
    const std::int64_t middle = (window.begin + window.end) / 2;
    for (const auto& half : {Window{window.begin, middle}, Window{middle, window.end}}) {
      if (any_usable(*recordings[number], half)) add(result.halves, half, run[w]);
    }
  }
  result.pairs.push_back(result.halves.windows.size());
  return result;
}

/// Sums of the rows between neighbouring entries of `first`, which counts from `from`.
Eigen::MatrixXd joined(const Eigen::MatrixXd& rows, const std::size_t* first, std::size_t count) {
  Eigen::MatrixXd result(static_cast<Eigen::Index>(count), rows.cols());
  for (Eigen::Index j = 0; j < rows.cols(); ++j) {
    const double* value = rows.col(j).data();
    for (std::size_t i = 0; i < count; ++i) {
      double sum = 0.0;
      for (std::size_t row = first[i]; row < first[i + 1]; ++row) sum += value[row - first[0]];
      result(static_cast<Eigen::Index>(i), j) = sum;
    }
  }
  return result;
}

/// A triangle with these inner products. Columns that others imply have a zero diagonal.
Eigen::MatrixXd root(Eigen::MatrixXd products) {
  const Eigen::Index size = products.cols();
  const Eigen::VectorXd square = products.diagonal();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    if (!(products(k, k) > kSmallest * square[k])) continue;
    result.row(k).tail(size - k) = products.row(k).tail(size - k) / std::sqrt(products(k, k));
    for (Eigen::Index j = k + 1; j < size; ++j) {
      products.col(j).segment(k + 1, j - k) -=
          result(k, j) * result.row(k).segment(k + 1, j - k).transpose();
    }
  }
  return result;
}

/// The halves in parts, and the rows of both windowings.
class Halves {
 public:
  Halves(const Nested& cut, PenaltyParts parts, Eigen::Index gain, base::Pool* pool)
      : cut_(cut), parts_(std::move(parts)), gain_(gain), pool_(pool) {
    if (parts_.samples() > kKeptSamples) return;
    kept_.resize(parts_.count());
    for_each(parts_.count(), pool,
             [&](std::size_t i) { kept_[i] = std::make_unique<Penalty>(parts_.part(i)); });
  }

  [[nodiscard]] const PenaltyParts& parts() const { return parts_; }

  /// The part of the reading in each half that the motion explains, by the first stage of either
  /// windowing.
  void project(const Instruments& instruments) {
    const Eigen::Index size = instruments.size();
    std::array<std::vector<Eigen::MatrixXd>, 2> products;
    for (auto& each : products) each.resize(parts_.count());
    std::vector<Eigen::MatrixXd> rows(kept_.empty() ? 0 : parts_.count());
    const auto rows_of = [&](std::size_t i) {
      return of(i, [&](const Penalty& part) {
        Eigen::MatrixXd both(part.window_count(), size + 1);
        both.leftCols(size) = part.instrument_rows(instruments, {0, part.windows().size()});
        both.col(size) = part.reading();
        return both;
      });
    };
    for_each(parts_.count(), pool_, [&](std::size_t i) {
      Eigen::MatrixXd both = rows_of(i);
      for (const bool pairs : {false, true})
        products[pairs ? 1 : 0][i] = of_windows(i, both, pairs);
      if (!rows.empty()) rows[i].swap(both);
    });
    std::array<Eigen::VectorXd, 2> weights;
    for (const bool pairs : {false, true}) {
      auto& own = products[pairs ? 1 : 0];
      for (std::size_t i = 1; i < own.size(); ++i) own[0] += own[i];
      const auto windows =
          static_cast<Eigen::Index>((pairs ? cut_.joined : cut_.halves).windows.size());
      weights[pairs ? 1 : 0] =
          solve_first_stage(instruments, root(std::move(own[0])), windows).weights;
    }
    explained_.resize(parts_.count());
    for_each(parts_.count(), pool_, [&](std::size_t i) {
      const Eigen::MatrixXd both = rows.empty() ? rows_of(i) : std::move(rows[i]);
      explained_[i].resize(both.rows(), 2);
      for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
        explained_[i].col(static_cast<Eigen::Index>(k)).noalias() =
            both.leftCols(size) * weights[k];
      }
    });
  }

  /// Sums over the halves, and over the pairs, at one point.
  [[nodiscard]] std::array<Balanced, 2> at(const Eigen::VectorXd& theta, bool halves,
                                           bool pairs) const {
    std::vector<std::array<Eigen::MatrixXd, 2>> products(parts_.count());
    for_each(parts_.count(), pool_, [&](std::size_t i) {
      Eigen::MatrixXd rows = of(i, [&](const Penalty& part) {
        Eigen::VectorXd residual;
        Eigen::MatrixXd jacobian;
        part.residuals(theta, residual, &jacobian);
        jacobian.conservativeResize(Eigen::NoChange, jacobian.cols() + 1);
        jacobian.rightCols(1) = residual;
        return jacobian;
      });
      for (const int k : {0, 1}) {
        if (!(k == 0 ? halves : pairs)) continue;
        replace_reading(i, k, theta, rows);
        products[i][static_cast<std::size_t>(k)] = of_windows(i, rows, k == 1);
      }
    });
    std::array<Balanced, 2> result;
    for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
      if (products[0][k].size() == 0) continue;
      Eigen::MatrixXd all = products[0][k];
      for (std::size_t i = 1; i < products.size(); ++i) all += products[i][k];  // in this order
      const Eigen::Index p = all.cols() - 1;
      result[k] = {all.topLeftCorner(p, p), all.topRightCorner(p, 1), all(p, p)};
    }
    return result;
  }

 private:
  template <class Work>
  [[nodiscard]] Eigen::MatrixXd of(std::size_t part, Work work) const {
    return kept_.empty() ? work(parts_.part(part)) : work(*kept_[part]);
  }

  /// Inner products of a part's rows and, if requested, of their sums over pairs.
  [[nodiscard]] Eigen::MatrixXd of_windows(std::size_t part, const Eigen::MatrixXd& rows,
                                           bool pairs) const {
    if (!pairs) return base::symmetric_products(rows, rows);
    const auto place = [&](std::size_t window) {
      const auto& first = cut_.pairs;
      return static_cast<std::size_t>(std::lower_bound(first.begin(), first.end(), window) -
                                      first.begin());
    };
    const std::size_t first = place(parts_.first(part));
    const std::size_t count = place(parts_.first(part + 1)) - first;
    const Eigen::MatrixXd sums = joined(rows, cut_.pairs.data() + first, count);
    return base::symmetric_products(sums, sums);
  }

  /// Replaces the reading, or an earlier projection, by the explained part of the reading.
  void replace_reading(std::size_t part, int stage, const Eigen::VectorXd& theta,
                       Eigen::MatrixXd& rows) const {
    if (explained_.empty()) return;
    const auto& own = explained_[part];
    rows.rightCols(1) -= theta[gain_] * (own.col(stage) + rows.col(gain_));
    rows.col(gain_) = -own.col(stage);
  }

  const Nested& cut_;
  PenaltyParts parts_;
  Eigen::Index gain_;
  base::Pool* pool_;
  std::vector<std::unique_ptr<Penalty>> kept_;
  std::vector<Eigen::MatrixXd> explained_;  ///< of each part, one column per windowing
};

Eigen::Index unknowns(const Penalty& penalty) {
  const auto& terms = penalty.terms();
  const auto given =
      std::count_if(terms.begin(), terms.end(), [](const Term& t) { return t.given; });
  return std::max<Eigen::Index>(1, penalty.parameters() - given);
}

}  // namespace

WindowShifts window_shifts(const Penalty& penalty, const Penalty::Masked& recordings,
                           const std::vector<std::string>& terms, double gear_ratio,
                           const std::vector<std::string>& per_recording,
                           const search::Domain& domain, const Eigen::VectorXd& best,
                           base::Pool* pool) {
  domain.validate();
  const Eigen::VectorXd start = best.cwiseMax(domain.lower).cwiseMin(domain.upper);
  const Nested cut = nested(penalty, recordings);
  const auto possible = [&](const CutWindows& windows) {
    const auto count = static_cast<Eigen::Index>(windows.windows.size());
    return count != penalty.window_count() && count >= unknowns(penalty);
  };
  const bool halved = possible(cut.halves);
  const bool doubled = possible(cut.joined);
  WindowShifts result;
  if (!halved && !doubled) return result;
  Halves halves(cut,
                PenaltyParts(recordings, terms, cut.halves, cut.pairs, penalty.residual(),
                             gear_ratio, per_recording),
                penalty.gain_index(), pool);
  if (penalty.residual() == Residual::instruments) {
    halves.project(penalty.instruments(domain.free(), penalty.windows().size()));
  }
  const auto first = halves.at(start, halved, doubled);
  const auto moved = [&](bool pairs) {
    const auto at = [&](const Eigen::VectorXd& theta) {
      return halves.at(theta, !pairs, pairs)[pairs ? 1 : 0];
    };
    const auto& windows = (pairs ? cut.joined : cut.halves).windows;
    return descend(at, halves.parts(), static_cast<Eigen::Index>(windows.size()), domain, start,
                   first[pairs ? 1 : 0], kShare);
  };
  if (halved) result.halved = moved(false);
  if (doubled) result.doubled = moved(true);
  return result;
}

}  // namespace jointid::identify
