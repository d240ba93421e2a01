// The first stage of the residual 'instruments': the columns that explain the reading, and the
// projection on them.

#include <algorithm>
#include <array>
#include <cstring>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/circle.hpp"
#include "base/clones.hpp"
#include "base/four.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/penalty/penalty_parts.hpp"

namespace jointid::identify {

namespace {

// Decays at these shares of the largest speed represent those of any shape well enough. Their
// columns must hold no more of the reading's noise than the balance's own columns do.
constexpr std::array<double, 8> kShares{0.6, 0.33, 0.18, 0.1, 0.055, 0.03, 0.017, 0.009};
constexpr std::size_t kRows = 4096;  // rows per block
constexpr std::size_t kKept =
    4;  // number of blocks up to which their rows are kept between the stages
// Each recording's link has its own columns if windows outnumber all columns by this factor.
constexpr std::size_t kPerColumn = 50;

/// In explicit vectors, because compilers keep such sums in memory.
JOINTID_CLONES void weighted_sums(const double* weight, const double* decays, std::size_t count,
                                  double* sums) {
  static_assert(kShares.size() == 2 * base::kFour);
  base::Four low;
  base::Four high;
  base::fill(low, 0.0);
  base::fill(high, 0.0);
  for (std::size_t i = 0; i < count; ++i, decays += 2 * base::kFour) {
    base::Four first;
    base::Four second;
    base::load(first, decays);
    base::load(second, decays + base::kFour);
    low = low + first * weight[i];
    high = high + second * weight[i];
  }
  base::store(sums, low);
  base::store(sums + base::kFour, high);
}

}  // namespace

std::vector<double> instrument_rates(double fastest) {
  std::vector<double> rates;
  if (fastest > 0.0) {
    for (const double share : kShares) rates.push_back(1.0 / (share * share * fastest * fastest));
  }
  return rates;
}

Instruments Penalty::instruments(const std::vector<Eigen::Index>& free, std::size_t windows) const {
  Instruments result;
  for (const auto i : free) {
    if (i >= coefficients() || i == gain_index_) continue;
    const auto shaped = std::find_if(shaped_.begin(), shaped_.end(),
                                     [&](const Shaped& s) { return s.coefficient == i; });
    if (shaped == shaped_.end()) {
      result.own.push_back(i);
    } else {
      result.shaped.push_back(static_cast<std::size_t>(shaped - shaped_.begin()));
    }
  }
  result.rates = instrument_rates(fastest_);
  result.runs = runs_;
  if (windows < kPerColumn * static_cast<std::size_t>(result.size())) result.runs = 1;
  return result;
}

std::vector<Stretch> Penalty::blocks() const {
  const std::size_t count = windows_.size();
  if (cumulative_ || count == 0) return {{0, count}};
  std::vector<Stretch> result;
  for (std::size_t begin = 0; begin < count; begin += kRows) {
    result.push_back({begin, std::min(count, begin + kRows)});
  }
  return result;
}

void Penalty::sum_decays(const FrictionNodes& nodes, const Stretch& windows,
                         const std::vector<double>& rates,
                         Eigen::Ref<Eigen::MatrixXd> columns) const {
  const DecayRates decays{2.0, rates};
  std::size_t others = windows.begin;  // windows from here on are not summed yet
  const auto sum_others = [&](std::size_t end) {
    if (others < end) {
      const auto rows = static_cast<Eigen::Index>(end - others);
      integrate_decays(nodes, {others, end}, decays, nullptr,
                       columns.middleRows(static_cast<Eigen::Index>(others - windows.begin), rows));
    }
    others = end + 1;
  };
  std::array<double, kShares.size()> sums;
  for (std::size_t w = windows.begin; w < windows.end && !decays_.empty(); ++w) {
    const auto& known = decays_[static_cast<std::size_t>(recording_of_[w])];
    const auto begin = static_cast<std::size_t>(windows_[w].begin);
    const std::size_t count = nodes.first[w + 1] - nodes.first[w];
    if (known == nullptr || count != static_cast<std::size_t>(windows_[w].end) - begin + 1 ||
        std::memcmp(known->speed.data() + begin, nodes.speed.data() + nodes.first[w],
                    count * sizeof(double)) != 0) {
      continue;  // a window that is cut or has a reversal
    }
    sum_others(w);
    weighted_sums(nodes.weight.data() + nodes.first[w],
                  known->values.data() + begin * kShares.size(), count, sums.data());
    for (std::size_t k = 0; k < kShares.size(); ++k) {
      columns(static_cast<Eigen::Index>(w - windows.begin), static_cast<Eigen::Index>(k)) = sums[k];
    }
  }
  sum_others(windows.end);
}

Eigen::MatrixXd Penalty::instrument_rows(const Instruments& instruments,
                                         const Stretch& windows) const {
  const auto first = static_cast<Eigen::Index>(windows.begin);
  const auto rows = static_cast<Eigen::Index>(windows.end - windows.begin);
  Eigen::MatrixXd result(rows, instruments.size());
  Eigen::Index to = 0;
  for (const auto j : instruments.own) result.col(to++) = columns_.col(j).segment(first, rows);
  const auto rates = static_cast<Eigen::Index>(instruments.rates.size());
  for (const auto number : instruments.shaped) {
    if (rates == 0) break;
    auto columns = result.middleCols(to, rates);
    sum_decays(nodes(shaped_[number].term.direction), windows, instruments.rates, columns);
    if (cumulative_) {
      for (Eigen::Index j = 0; j < rates; ++j) accumulate(columns.col(j));
    }
    to += rates;
  }
  auto link = result.rightCols(Instruments::kLink * instruments.runs);
  link.setZero();
  constexpr Eigen::Index kPosture = Instruments::kPosture;
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Eigen::Index run =
        instruments.runs > 1 ? recording_of_[static_cast<std::size_t>(first + row)] : 0;
    link.row(row).segment(kPosture * run, kPosture) = link_.row(first + row).head(kPosture);
    link(row, kPosture * instruments.runs + run) = link_(first + row, kPosture);
  }
  return result;
}

void Penalty::integrate_link(const RecordingView& recording, Eigen::Index first,
                             Eigen::Index count) {
  // Simpson's rule: an instrument need not be exact, only free of the reading's errors.
  Eigen::Array3Xd angle(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& window = windows_[static_cast<std::size_t>(first + i)];
    angle(0, i) = recording.position[window.begin];
    angle(1, i) = recording.position[(window.begin + window.end) / 2];
    angle(2, i) = recording.position[window.end];
  }
  Eigen::Array3Xd cosine(3, count);
  Eigen::Array3Xd sine(3, count);
  base::circle(angle.data(), static_cast<std::size_t>(angle.size()), cosine.data(), sine.data());
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = first + i;
    const auto& window = windows_[static_cast<std::size_t>(row)];
    const double sixth = usable_duration_[row] / 6.0;
    link_(row, 0) = sixth * (cosine(0, i) + 4.0 * cosine(1, i) + cosine(2, i));
    link_(row, 1) = sixth * (sine(0, i) + 4.0 * sine(1, i) + sine(2, i));
    link_(row, 2) = usable_duration_[row];
    link_(row, 3) = recording.velocity[window.end] - recording.velocity[window.begin];
  }
}

Eigen::MatrixXd Penalty::instrument_triangle(const Instruments& instruments, base::Pool* pool) {
  const auto parts = blocks();
  const Eigen::VectorXd observed = reading();
  std::vector<Eigen::MatrixXd> triangles(parts.size());
  kept_rows_.assign(parts.size() <= kKept ? parts.size() : 0, {});
  for_each(parts.size(), pool, [&](std::size_t i) {
    const auto rows = static_cast<Eigen::Index>(parts[i].end - parts[i].begin);
    Eigen::MatrixXd both(rows, instruments.size() + 1);
    Eigen::MatrixXd own = instrument_rows(instruments, parts[i]);
    both.leftCols(instruments.size()) = own;
    if (!kept_rows_.empty()) kept_rows_[i].swap(own);
    both.rightCols(1) = observed.segment(static_cast<Eigen::Index>(parts[i].begin), rows);
    triangles[i] = square_triangle(std::move(both));
  });
  return fold(triangles);
}

void Penalty::project_reading(const std::vector<Eigen::Index>& free, base::Pool* pool) {
  if (residual_ != Residual::instruments) {
    throw std::invalid_argument("only the residual 'instruments' projects the reading");
  }
  const Instruments chosen = instruments(free, windows_.size());
  project_reading(solve_first_stage(chosen, instrument_triangle(chosen, pool), window_count()),
                  pool);
}

void Penalty::project_reading(const FirstStage& stage, base::Pool* pool) {
  if (!first_stage_) reading_ = columns_.col(gain_index_);
  const auto parts = blocks();
  for_each(parts.size(), pool, [&](std::size_t i) {
    const auto rows = static_cast<Eigen::Index>(parts[i].end - parts[i].begin);
    auto column =
        columns_.col(gain_index_).segment(static_cast<Eigen::Index>(parts[i].begin), rows);
    if (kept_rows_.empty()) {
      column.noalias() = instrument_rows(stage.instruments, parts[i]) * stage.weights;
    } else {
      column.noalias() = kept_rows_[i] * stage.weights;
    }
  });
  kept_rows_.clear();
  first_stage_ = stage;
}

Eigen::VectorXd Penalty::reading() const {
  if (gain_index_ < 0) throw std::invalid_argument("a penalty without sensor_gain has no reading");
  return first_stage_ ? reading_ : Eigen::VectorXd(columns_.col(gain_index_));
}

void Penalty::observe(const Eigen::VectorXd& theta, Eigen::VectorXd& residual) const {
  if (!first_stage_) return;
  residual.noalias() -= theta[gain_index_] * (reading_ - columns_.col(gain_index_));
}

}  // namespace jointid::identify
