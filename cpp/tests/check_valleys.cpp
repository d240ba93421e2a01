// Refinement of a start over a single shape, also where a scan over the domain cannot see the
// minimum.

#include <cmath>
#include <string>
#include <vector>

#include "check.hpp"
#include "identify/solve/scale.hpp"
#include "identify/solve/separable.hpp"

namespace jointid::tests {
namespace {

/// A penalty of only one shape: a wide valley of depth 1, and far from it one of depth 0.6. The
/// floor of the second has a gap of depth 1 that is too narrow for the scan.
class Valleys : public identify::PenaltyFunction {
 public:
  explicit Valleys(bool mirrored) : mirrored_(mirrored) {}

  static constexpr double kCleft = 16.5 / 64.0;  // between two points of the scan

  [[nodiscard]] const std::vector<std::string>& names() const override { return names_; }
  [[nodiscard]] Eigen::Index coefficients() const override { return 0; }
  [[nodiscard]] identify::Residual residual() const override { return identify::Residual::torque; }
  [[nodiscard]] Eigen::Index gain_index() const override { return -1; }
  [[nodiscard]] bool is_cheap() const override { return true; }
  void columns(const Eigen::VectorXd& /*shapes*/, Eigen::MatrixXd& result,
               const base::Cancel* /*cancel*/) const override {
    result.resize(1, 0);
  }
  [[nodiscard]] const Eigen::VectorXd& target() const override { return target_; }
  double operator()(const Eigen::VectorXd& theta, const base::Cancel* /*cancel*/) const override {
    return sum(at(theta[0]), false);
  }
  void residuals(const Eigen::VectorXd& theta, Eigen::VectorXd& residual, Eigen::MatrixXd* jacobian,
                 const base::Cancel* /*cancel*/) const override {
    const double root = std::sqrt(sum(at(theta[0]), false));
    residual = Eigen::VectorXd::Constant(1, root);
    if (jacobian == nullptr) return;
    const double slope = (mirrored_ ? -1.0 : 1.0) * sum(at(theta[0]), true);
    *jacobian = Eigen::MatrixXd::Constant(1, 1, 0.5 * slope / root);
  }
  void evaluate(const Eigen::MatrixXd& candidates, Eigen::VectorXd& penalties,
                base::Pool& /*pool*/) const override {
    for (Eigen::Index i = 0; i < candidates.cols(); ++i) {
      penalties[i] = (*this)(candidates.col(i), nullptr);
    }
  }

 private:
  [[nodiscard]] double at(double shape) const { return mirrored_ ? 1.0 - shape : shape; }

  /// The penalty or its slope.
  static double sum(double x, bool slope) {
    double total = slope ? 0.0 : 2.0;
    const auto dig = [&](double depth, double where, double width) {
      const double away = (x - where) / width;
      const double here = depth * std::exp(-away * away);
      total += slope ? 2.0 * here * away / width : -here;
    };
    dig(1.0, 0.75, 0.1);
    dig(0.6, 0.25, 0.1);
    dig(1.0, kCleft, 0.003);
    return total;
  }

  bool mirrored_;
  std::vector<std::string> names_{"stribeck_velocity"};
  Eigen::VectorXd target_ = Eigen::VectorXd::Zero(1);
};

CHECK_CASE("separable: a start's own valley counts, also one that the scan steps over") {
  const search::Domain domain{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)};
  base::Pool pool(1);
  for (const bool mirrored : {false, true}) {
    const Valleys penalty(mirrored);
    const auto place = [&](double x) { return mirrored ? 1.0 - x : x; };
    const auto scanned = identify::minimise_separable(penalty, domain, pool);
    CHECK_CLOSE(scanned.best[0], place(0.75), 1e-4);
    const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, place(Valleys::kCleft + 0.002));
    const auto found = identify::refine_separable(penalty, domain, start, pool, true);
    CHECK_CLOSE(found.best[0], place(Valleys::kCleft), 1e-5);
    CHECK(found.penalty < 0.41);
  }
}

CHECK_CASE("separable: a root's scale needs bounds of at least 0, otherwise its steps are even") {
  const identify::Scale root(1.0, 9.0, true);
  CHECK(root.is_root() && root.at(0.5) == 4.0 && root.share(4.0) == 0.5);
  const identify::Scale even(-1.0, 9.0, true);
  CHECK(!even.is_root() && even.at(0.5) == 4.0 && even.share(4.0) == 0.5);
}

}  // namespace
}  // namespace jointid::tests
