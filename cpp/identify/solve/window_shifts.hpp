#pragma once
// Shift of the minimum when each window is halved, and when neighbours are joined in pairs.

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identify/penalty/penalty.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// Minima over other windows; none if there are no such windows, or fewer than unknowns.
struct WindowShifts {
  std::optional<Eigen::VectorXd> halved;
  std::optional<Eigen::VectorXd> doubled;
};

/// The minima near that of a penalty. Its windows must be neither cumulative nor loaded.
///
/// Both windowings nest: the halves' rows at `best` are summed to those of the joined windows, so
/// friction is integrated once for both. `recordings`, `terms`, `gear_ratio` and `per_recording`
/// are those of the penalty.
WindowShifts window_shifts(const Penalty& penalty, const Penalty::Masked& recordings,
                           const std::vector<std::string>& terms, double gear_ratio,
                           const std::vector<std::string>& per_recording,
                           const search::Domain& domain, const Eigen::VectorXd& best,
                           base::Pool* pool);

}  // namespace jointid::identify
