// Own terms: series of the recording, one coefficient each.

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/pool.hpp"
#include "check.hpp"
#include "identify/balance/quadrature.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "identify/solve/separable.hpp"
#include "synthetic.hpp"

namespace jointid::tests {
namespace own_terms {

using identify::MaskedRecording;
using identify::Penalty;
using identify::Recording;
using identify::RecordingView;
using identify::Residual;
using identify::Window;

/// Series with rises that no other term has, and their recording.
struct Own {
  explicit Own(int count, double torque_of_each = 0.0) : recording(moving(4000, 0.001, true, 7)) {
    add_torque(recording, Truth{}, false);
    const Eigen::Index n = recording.samples();
    for (int i = 0; i < count; ++i) {
      names.push_back("scale_of_s" + std::to_string(i));
      Eigen::VectorXd rise = Eigen::VectorXd::Zero(n);
      for (Eigen::Index k = 0; k + 1 < n; ++k) {
        const double step = recording.time[k + 1] - recording.time[k];
        const double mean = std::sin((3.0 + 1.7 * i) * recording.time[k]);
        rise[k + 1] = rise[k] + mean * step;
        recording.torque[k] += torque_of_each * (i + 1) * mean;
      }
      series.push_back(rise);
    }
  }
  [[nodiscard]] RecordingView view() const {
    RecordingView result(recording);
    for (std::size_t i = 0; i < names.size(); ++i) {
      result.own.push_back({names[i], {series[i].data(), series[i].size()}});
    }
    return result;
  }
  [[nodiscard]] std::vector<std::string> terms(const std::vector<std::string>& others) const {
    std::vector<std::string> all = others;
    all.insert(all.end(), names.begin(), names.end());
    return all;
  }
  Recording recording;
  std::vector<std::string> names;
  std::vector<Eigen::VectorXd> series;
};

Penalty penalty_of(const Own& own, const std::vector<std::string>& terms) {
  const auto view = own.view();
  const Penalty::Masked masked{
      std::make_shared<const MaskedRecording>(view, identify::usable_intervals(view, true))};
  return {masked, terms, {400, 0.0}, Residual::torque};
}

search::Domain domain_of(const Penalty& penalty) {
  const Eigen::Index p = penalty.parameters();
  search::Domain domain{Eigen::VectorXd::Constant(p, -100.0), Eigen::VectorXd::Constant(p, 100.0)};
  for (Eigen::Index i = penalty.coefficients(); i < p; ++i) {
    domain.lower[i] = 5.0;
    domain.upper[i] = 200.0;
  }
  return domain;
}

CHECK_CASE("own terms: a row represents one term per signal, with its name and unit") {
  const auto term = identify::find_term("viscous_of_q6_rate");
  CHECK(identify::is_own(term) && !identify::is_friction(term) && !term.simulated);
  CHECK(term.name == "viscous_of_q6_rate" && term.unit == "N·m/[q6_rate]");
  CHECK(identify::is_parameter("viscous_of_q6_rate[1]"));
  CHECK(!identify::is_parameter("viscous_of") && !identify::is_parameter("viscous_of_"));
  CHECK(!identify::is_parameter("viscous_of_6") && !identify::is_parameter("viscous_of_a b"));
  CHECK_REFUSED(identify::find_term("viscosity_of_q6"), "viscous_of_<signal>");
}

CHECK_CASE("own terms: a window has the rise of the series over the usable intervals") {
  const Own own(1);
  const auto view = own.view();
  std::vector<std::uint8_t> usable(static_cast<std::size_t>(view.samples() - 1), 1);
  const std::vector<Window> windows{{10, 60}, {60, 100}};
  Eigen::VectorXd whole(2);
  Eigen::VectorXd part(2);
  const auto term = identify::find_term(own.names[0]);
  identify::integrate(term, 1.0, view, usable, windows, whole);
  CHECK_CLOSE(whole[0], own.series[0][60] - own.series[0][10], 1e-15);
  usable[70] = 0;
  identify::integrate(term, 1.0, view, usable, windows, part);
  CHECK(part[0] == whole[0]);
  CHECK_CLOSE(whole[1] - part[1], own.series[0][71] - own.series[0][70], 1e-15);
  CHECK_REFUSED(
      identify::integrate(identify::find_term("known_of_x"), 1.0, view, usable, windows, part),
      "needs a recording with its series");
}

CHECK_CASE("own terms: fifty of them are found, and the penalty stays compressed") {
  const Own own(50, 0.05);
  const auto direct =
      penalty_of(own, own.terms({"inertia", "coulomb", "static", "viscous", "torque_offset"}));
  const auto domain = domain_of(direct);
  base::Pool pool(2);
  const identify::CompressedPenalty compressed(direct, domain, pool);
  CHECK_WITH(compressed.exact(), compressed.reason());
  const auto found = identify::minimise_separable(compressed, domain, pool);
  for (Eigen::Index i = 0; i < 50; ++i) {
    CHECK_CLOSE(found.best[5 + i], 0.05 * static_cast<double>(i + 1), 1e-6);
  }
  Eigen::VectorXd residual;
  compressed.residuals(found.best, residual, nullptr);
  // One row per parameter, not per window: no part of the search reads samples or windows.
  CHECK(residual.size() < direct.window_count());
  CHECK_CLOSE(compressed(found.best), direct(found.best), 1e-9 * (1e-3 + direct(found.best)));
}

}  // namespace own_terms
}  // namespace jointid::tests
