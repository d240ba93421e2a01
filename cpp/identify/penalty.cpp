#include "identify/penalty.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace jointid::identify {

Penalty::Penalty(std::vector<Recording> recordings, const std::vector<std::string>& terms,
                 const WindowOptions& options, Residual residual, bool mask_standstill)
    : names_(terms), residual_(residual) {
  if (recordings.empty()) throw std::invalid_argument("a penalty needs at least one recording");
  if (terms.empty()) throw std::invalid_argument("a penalty needs at least one term");
  options.validate();
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const Term& term = find_term(terms[i]);
    if (std::count(terms.begin(), terms.end(), terms[i]) > 1) {
      throw std::invalid_argument("term '" + terms[i] + "' is listed twice");
    }
    if (term.integral == Integral::sensor) gain_index_ = static_cast<Eigen::Index>(i);
    if (term.shape.empty()) continue;
    const std::string shape(term.shape);
    auto found =
        std::find(names_.begin() + static_cast<std::ptrdiff_t>(terms.size()), names_.end(), shape);
    const auto index = found - names_.begin() - static_cast<std::ptrdiff_t>(terms.size());
    if (found == names_.end()) names_.push_back(shape);
    shaped_.push_back({static_cast<Eigen::Index>(i), index, term.basis});
  }
  if (residual == Residual::sensor && gain_index_ < 0) {
    throw std::invalid_argument("residual 'sensor' needs the term sensor_gain");
  }

  std::vector<UsableIntervals> usable;
  for (const auto& recording : recordings) {
    recording.validate();
    if (gain_index_ >= 0 && !recording.has_sensor()) {
      throw std::invalid_argument("the term sensor_gain needs a recording with a sensor signal");
    }
    usable.push_back(usable_intervals(recording, mask_standstill));
    standing_ += usable.back().standing;
    total_ += recording.samples();
    unusable_ +=
        std::count(usable.back().usable.begin(), usable.back().usable.end(), std::uint8_t{0});
  }
  // One duration for all recordings: the longest that any of them asks for.
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    auto choice = choose_window(recordings[i], usable[i].usable, parameters());
    if (options.count > 0) choice.duration = duration_for(recordings[i], options.count);
    if (options.duration > 0.0) choice.duration = options.duration;
    if (choice.duration >= choice_.duration) choice_ = choice;
  }
  std::vector<std::vector<Window>> cut;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const double length = recordings[i].time[recordings[i].samples() - 1] - recordings[i].time[0];
    if (choice_.duration > length) {
      throw std::invalid_argument("windows: duration " + std::to_string(choice_.duration) +
                                  " s is longer than the recording, " + std::to_string(length) +
                                  " s");
    }
    cut.push_back(cut_windows(recordings[i], usable[i].usable, choice_.duration));
    windows_.insert(windows_.end(), cut.back().begin(), cut.back().end());
    recording_of_.insert(recording_of_.end(), cut.back().size(), static_cast<int>(i));
  }
  const auto rows = static_cast<Eigen::Index>(windows_.size());
  if (rows == 0) {
    throw std::invalid_argument("the joint stands still or sticks throughout: record motion");
  }
  if (rows < parameters()) {
    throw std::invalid_argument(
        "windows: " + std::to_string(rows) + " windows with motion cannot determine " +
        std::to_string(parameters()) + " parameters; use more or shorter windows");
  }
  columns_.setZero(rows, static_cast<Eigen::Index>(terms.size()));
  target_.resize(rows);
  usable_duration_.resize(rows);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < recordings.size(); ++i) {
    const auto count = static_cast<Eigen::Index>(cut[i].size());
    integrate_torque(recordings[i], usable[i].usable, cut[i], target_.segment(row, count));
    integrate(Integral::duration, recordings[i], usable[i].usable, cut[i],
              usable_duration_.segment(row, count));
    for (std::size_t j = 0; j < terms.size(); ++j) {
      const Term& term = find_term(terms[j]);
      if (!term.shape.empty()) continue;
      integrate(term.integral, recordings[i], usable[i].usable, cut[i],
                columns_.col(static_cast<Eigen::Index>(j)).segment(row, count));
    }
    if (!shaped_.empty()) append_nodes(recordings[i], usable[i].usable, cut[i], nodes_);
    row += count;
  }
}

void Penalty::check(const Eigen::VectorXd& theta) const {
  if (theta.size() != parameters()) {
    throw std::invalid_argument("theta must have " + std::to_string(parameters()) +
                                " values, got " + std::to_string(theta.size()));
  }
  if (residual_ == Residual::sensor && theta[gain_index_] == 0.0) {
    throw std::invalid_argument("sensor_gain must not be 0 with residual 'sensor'");
  }
}

void Penalty::columns(const Eigen::VectorXd& shapes, Eigen::MatrixXd& result,
                      const base::Cancel* cancel) const {
  result = columns_;
  for (const auto& s : shaped_) {
    integrate_friction(s.basis, nodes_, shapes[s.shape], cancel, result.col(s.coefficient));
  }
}

double Penalty::operator()(const Eigen::VectorXd& theta, const base::Cancel* cancel) const {
  Eigen::VectorXd residual;
  residuals(theta, residual, nullptr, cancel);
  return residual.squaredNorm();
}

void Penalty::residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual,
                        Eigen::MatrixXd* jacobian, const base::Cancel* cancel) const {
  check(theta);
  const Eigen::Index p = coefficients();
  if (jacobian != nullptr) {
    jacobian->setZero(window_count(), parameters());
    jacobian->leftCols(p) = -columns_;
  }
  residual = target_;
  residual.noalias() -= columns_ * theta.head(p);
  Eigen::VectorXd column(shaped_.empty() ? 0 : window_count());
  Eigen::VectorXd slope(jacobian == nullptr ? 0 : column.size());
  for (const auto& s : shaped_) {
    integrate_friction(s.basis, nodes_, theta[p + s.shape], cancel, column,
                       jacobian == nullptr ? nullptr : &slope);
    residual.noalias() -= theta[s.coefficient] * column;
    if (jacobian != nullptr) {
      jacobian->col(s.coefficient) -= column;
      jacobian->col(p + s.shape) -= theta[s.coefficient] * slope;
    }
  }
  if (residual_ == Residual::torque) return;
  const double scale = 1.0 / theta[gain_index_];
  residual *= scale;
  if (jacobian != nullptr) {
    *jacobian *= scale;
    jacobian->col(gain_index_) -= scale * residual;
  }
}

void Penalty::evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                       base::Pool& pool) const {
  penalties.resize(candidates.cols());
  pool.for_each(
      static_cast<std::size_t>(candidates.cols()), [&](std::size_t begin, std::size_t end) {
        for (auto i = static_cast<Eigen::Index>(begin); i < static_cast<Eigen::Index>(end); ++i) {
          penalties[i] = (*this)(candidates.col(i), &pool.cancel());
        }
      });
}

}  // namespace jointid::identify
