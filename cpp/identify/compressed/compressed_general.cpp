// The compressed penalty of the general decay, whose shapes are two.

#include <algorithm>
#include <cmath>

#include "base/elementary.hpp"
#include "identify/compressed/compressed_penalty.hpp"
#include "model/friction.hpp"

namespace jointid::identify {

namespace {

constexpr int kProbes = 9;
constexpr double kGoldenShare = 0.6180339887498949;

}  // namespace

void CompressedPenalty::build_general(const Penalty& penalty, const search::Domain& domain,
                                      base::Pool& pool) {
  const auto& shaped = penalty.shaped();
  const double* low = domain.lower.data() + coefficients_;
  const double* high = domain.upper.data() + coefficients_;
  for (const auto& one : shaped) {
    if (one.shapes == shaped.front().shapes) continue;
    reason_ = "its decaying terms have shapes of their own";
    return;
  }
  if (!(low[0] > 0.0) || !(low[1] > 0.0)) {
    reason_ = "stribeck_velocity and stribeck_exponent need bounds above 0";
    return;
  }
  double least = HUGE_VAL;
  double most = -HUGE_VAL;
  for (const auto& one : shaped) {
    for (const double speed : penalty.nodes(one.term.direction).logarithm) {
      if (speed < model::kRest) continue;
      least = std::min(least, speed);
      most = std::max(most, speed);
    }
  }
  const GeneralRange range{low[0], high[0], low[1], high[1]};
  const auto pieces = speed_pieces(range, std::min(least, most), most, reason_);
  if (!pieces) return;
  Probes probes;
  for (int i = 1; i <= kProbes; ++i) {
    const double share = i * kGoldenShare - std::floor(i * kGoldenShare);
    const double other = (i - 0.5) / kProbes;
    probes.push_back({low[0] * base::exp(other * base::log(high[0] / low[0])),
                      low[1] * base::exp(share * base::log(high[1] / low[1]))});
    for (std::size_t j = 0; j < 2; ++j)
      probes.back()[j] = std::clamp(probes.back()[j], low[j], high[j]);
  }
  const auto moments = speed_moments(penalty, *pieces, probes, pool);
  take_triangle(moments.triangle);
  order_ = {0, 1};
  passes_ = kProbes + 1;
  general_.emplace(range, *pieces, moments, shaped.size());
  target_.conservativeResizeLike(Eigen::VectorXd::Zero(general_->rows()));
  const auto size = static_cast<Eigen::Index>(shaped.size()) * rows_;
  const auto products = moments.expected.rows() - size;
  Eigen::MatrixXd found(moments.expected.rows(), moments.expected.cols());
  for (Eigen::Index i = 0; i < found.cols(); ++i) {
    general_->values(probes[static_cast<std::size_t>(i)].data(), found.col(i).data());
  }
  const double scale =
      std::max(1e-300, moments.expected.topRows(size).colwise().squaredNorm().maxCoeff() +
                           moments.expected.bottomRows(products).cwiseAbs().maxCoeff());
  compare(found, moments.expected, scale);
}

}  // namespace jointid::identify
