#pragma once
// The separable optimum from the direct sums, without compressing them first.

#include <optional>
#include <string>

#include "base/pool.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/solve/separable.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// Result of the projected search, or the reason why the compressed penalty must be minimised
/// instead.
struct Projected {
  std::optional<SeparableResult> found;
  std::string reason;  ///< empty if an optimum was found
};

/// Scans the shapes' ranges over some of the windows, then makes Gauss-Newton steps over all
/// windows from each valley. Finds nothing if some windows cannot separate the valleys: an optimum
/// at the end of a range, a penalty that is nearly constant, too few windows, many valleys. Also
/// finds nothing without a free shape, with running sums, or if the balance is not linear. Minimise
/// the compressed penalty then.
Projected minimise_projected(const Penalty& penalty, const search::Domain& domain,
                             base::Pool& pool);

}  // namespace jointid::identify
