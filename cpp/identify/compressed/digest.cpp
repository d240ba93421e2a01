#include "identify/compressed/digest.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <utility>

namespace jointid::identify {

namespace {

constexpr std::size_t kMerged = 32;  // parts at a time: the stack stays in the cache

/// Splits columns into their projections on the constant ones and inner products of the rest.
Digest split(const Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped) {
  const Eigen::Index m = constant.cols();
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(constant);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(constant.rows(), m);
  Digest result;
  result.triangle = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
  result.projections.noalias() = q.transpose() * columns;
  columns.noalias() -= q * result.projections;
  const Eigen::Index nodes = shaped > 0 ? columns.cols() / shaped : 0;
  result.remainders.resize(pairs(shaped), nodes);
  for (Eigen::Index node = 0; node < nodes; ++node) {
    Eigen::Index pair = 0;
    for (Eigen::Index j = 0; j < shaped; ++j) {
      for (Eigen::Index i = 0; i <= j; ++i) {
        result.remainders(pair++, node) =
            columns.col(node * shaped + i).dot(columns.col(node * shaped + j));
      }
    }
  }
  return result;
}

}  // namespace

Digest digest(Eigen::MatrixXd& constant, Eigen::MatrixXd& columns, Eigen::Index shaped) {
  const Eigen::Index m = constant.cols();
  if (constant.rows() < m) {  // rows of zeros change nothing, and give the triangle its size
    const Eigen::Index rows = constant.rows();
    constant.conservativeResize(m, Eigen::NoChange);
    columns.conservativeResize(m, Eigen::NoChange);
    constant.bottomRows(m - rows).setZero();
    columns.bottomRows(m - rows).setZero();
  }
  return split(constant, columns, shaped);
}

Digest merge(const std::vector<Digest>& parts) {
  if (parts.size() == 1) return parts[0];
  std::vector<Digest> merged;
  for (std::size_t begin = 0; begin < parts.size(); begin += kMerged) {
    const std::size_t end = std::min(parts.size(), begin + kMerged);
    const auto count = static_cast<Eigen::Index>(end - begin);
    const Eigen::Index m = parts[begin].triangle.cols();
    Eigen::MatrixXd constant(count * m, m);
    Eigen::MatrixXd columns(count * m, parts[begin].projections.cols());
    Eigen::MatrixXd remainders =
        Eigen::MatrixXd::Zero(parts[begin].remainders.rows(), parts[begin].remainders.cols());
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto& part = parts[begin + static_cast<std::size_t>(i)];
      constant.middleRows(i * m, m) = part.triangle;
      columns.middleRows(i * m, m) = part.projections;
      remainders += part.remainders;
    }
    const Eigen::Index shaped =
        remainders.cols() > 0 ? columns.cols() / remainders.cols() : Eigen::Index{0};
    merged.push_back(split(constant, columns, shaped));
    merged.back().remainders += remainders;
  }
  return merged.size() == 1 ? merged[0] : merge(merged);
}

}  // namespace jointid::identify
