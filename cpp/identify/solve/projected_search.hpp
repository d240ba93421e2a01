#pragma once
// The separable optimum from the direct sums, without compressing them first.

#include <optional>
#include <string>

#include "base/pool.hpp"
#include "identify/penalty/penalty.hpp"
#include "identify/solve/separable.hpp"
#include "search/domain.hpp"

namespace jointid::identify {

/// What the projected search found, or why it leaves the penalty to the compressed one.
struct Projected {
  std::optional<SeparableResult> found;
  std::string reason;  ///< empty where something was found
};

/// A scan of the shapes' ranges over some of the windows, then Gauss-Newton steps over all of them
/// from each valley found. Nothing where some windows cannot tell the valleys: an optimum at the
/// end of a range, a penalty nearly the same everywhere, too few windows, many valleys. Nothing,
/// too, without a free shape, with running sums, and where the balance is not linear. Then minimise
/// the compressed penalty.
Projected minimise_projected(const Penalty& penalty, const search::Domain& domain,
                             base::Pool& pool);

}  // namespace jointid::identify
