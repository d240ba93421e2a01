#include <utility>
#include <vector>

#include "identify/balance/interval_residual.hpp"
#include "identify/penalty/penalty_parts.hpp"

// Residuals of a part's windows at one parameter vector, without columns if none are needed.

namespace jointid::identify {

PenaltyParts::Residuals PenaltyParts::residuals(std::size_t index,
                                                const Eigen::VectorXd& theta) const {
  const std::size_t from = first_[index];
  const std::size_t to = first_[index + 1];
  Residuals result;
  result.windows = std::span(windows_).subspan(from, to - from);
  result.recording_of = std::span(recording_of_).subspan(from, to - from);
  const bool apart = coefficients_ != static_cast<Eigen::Index>(frame_.terms_.size());
  if (frame_.load_ >= 0 || frame_.cumulative_ || apart) {
    const Penalty whole = part(index);
    whole.residuals(theta, result.torque, nullptr);
    if (divisor_ >= 0) result.torque *= theta[divisor_];
    result.duration = whole.usable_duration();
    return result;
  }
  frame_.check(theta);
  std::vector<KnownTerm> terms;
  for (std::size_t j = 0; j < frame_.terms_.size(); ++j) {
    terms.push_back({frame_.terms_[j], theta[static_cast<Eigen::Index>(j)], {}});
  }
  for (const auto& shaped : frame_.shaped_) {
    auto& shapes = terms[static_cast<std::size_t>(shaped.coefficient)].shapes;
    shapes.resize(static_cast<Eigen::Index>(shaped.shapes.size()));
    for (std::size_t i = 0; i < shaped.shapes.size(); ++i) {
      shapes[static_cast<Eigen::Index>(i)] = theta[coefficients_ + shaped.shapes[i]];
    }
  }
  const Term duration = find_term("torque_offset");
  const auto rows = static_cast<Eigen::Index>(to - from);
  result.torque.resize(rows);
  result.duration.resize(rows);
  for (std::size_t w = 0; w < result.windows.size();) {
    std::size_t end = w;
    while (end < result.windows.size() && result.recording_of[end] == result.recording_of[w]) ++end;
    const auto& masked = *recordings_[static_cast<std::size_t>(result.recording_of[w])];
    const auto windows = result.windows.subspan(w, end - w);
    const auto first = static_cast<Eigen::Index>(w);
    const auto count = static_cast<Eigen::Index>(end - w);
    integrate_residual(terms, gear_ratio_, masked.recording(), masked.usable(), windows,
                       result.torque.segment(first, count));
    integrate(duration, gear_ratio_, masked.recording(), masked.usable(), windows,
              result.duration.segment(first, count));
    w = end;
  }
  return result;
}

}  // namespace jointid::identify
