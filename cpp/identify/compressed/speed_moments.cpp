#include "identify/compressed/speed_moments.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clones.hpp"
#include "identify/compressed/digest.hpp"

namespace jointid::identify {

namespace {

constexpr std::size_t kDecomposed = 4096;  // whose constant columns are decomposed at once
constexpr std::size_t kPart = 200'000;     // nodes, so that a part outweighs its matrix of products
constexpr std::size_t kMostParts = 16;     // that matrix has some megabytes

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

JOINTID_CLONES void add_scaled(double factor, const double* row, std::size_t begin, std::size_t end,
                               double* sum) {
  for (std::size_t j = begin; j < end; ++j) sum[j] += factor * row[j];
}

/// Products of all pairs of a row's spans, i <= j.
JOINTID_CLONES void add_products(const double* row, const Span* spans, std::size_t count,
                                 std::size_t stride, double* products) {
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t i = spans[a].begin; i < spans[a].end; ++i) {
      double* sum = products + i * stride;
      const double factor = row[i];
      for (std::size_t j = i; j < spans[a].end; ++j) sum[j] += factor * row[j];
      for (std::size_t b = a + 1; b < count; ++b) {
        for (std::size_t j = spans[b].begin; j < spans[b].end; ++j) sum[j] += factor * row[j];
      }
    }
  }
}

/// Of consecutive windows.
struct Part {
  std::vector<Eigen::MatrixXd> triangles;
  std::vector<Matrix> projections;  ///< of the moments, then of the probes' columns
  Eigen::MatrixXd products;         ///< of the moments, the lower triangle
};

class Sums {
 public:
  Sums(const Penalty& penalty, const SpeedPieces& pieces, const Probes& probes)
      : penalty_(penalty), pieces_(pieces), shaped_(penalty.shaped().size()) {
    const auto& all = penalty.shaped();
    direct_.resize(penalty.window_count(), static_cast<Eigen::Index>(shaped_ * probes.size()));
    for (std::size_t k = 0; k < probes.size(); ++k) {
      for (std::size_t j = 0; j < shaped_; ++j) {
        auto column = direct_.col(static_cast<Eigen::Index>(k * shaped_ + j));
        integrate_friction(all[j].term, penalty.nodes(all[j].term.direction), probes[k].data(),
                           nullptr, column);
        if (!penalty.cumulative()) continue;
        const auto& recording = penalty.recording_of();
        for (Eigen::Index w = 1; w < column.size(); ++w) {
          const auto row = static_cast<std::size_t>(w);
          if (recording[row] == recording[row - 1]) column[w] += column[w - 1];
        }
      }
    }
  }

  [[nodiscard]] const Eigen::MatrixXd& direct() const { return direct_; }
  [[nodiscard]] std::size_t moments() const { return shaped_ * pieces_.moments(); }

  [[nodiscard]] Part part(const Stretch& windows, const base::Cancel& cancel) const {
    Part result;
    const auto count = static_cast<Eigen::Index>(moments());
    result.products.setZero(count, count);
    std::vector<double> row(moments());
    std::vector<Span> spans(shaped_);
    std::size_t begin = windows.begin;
    do {
      cancel.check();
      const Stretch block{begin, std::min(windows.end, begin + kDecomposed)};
      add_block(block, row, spans, result);
      begin = block.end;
    } while (begin < windows.end);
    return result;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd constant(const Stretch& block) const {
    const auto rows = static_cast<Eigen::Index>(block.end - block.begin);
    const auto first = static_cast<Eigen::Index>(block.begin);
    const Eigen::Index m = penalty_.coefficients() - static_cast<Eigen::Index>(shaped_) + 1;
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(std::max(rows, m), m);
    Eigen::Index to = 0;
    for (Eigen::Index j = 0; j < penalty_.coefficients(); ++j) {
      if (penalty_.is_shaped(j)) continue;
      result.col(to++).head(rows) = penalty_.constant_columns().col(j).segment(first, rows);
    }
    result.col(to).head(rows) = penalty_.target().segment(first, rows);
    return result;
  }

  /// `row` and `spans` hold the sums over the recording's windows before, for running integrals.
  void add_block(const Stretch& block, std::vector<double>& row, std::vector<Span>& spans,
                 Part& part) const {
    const Eigen::MatrixXd columns = constant(block);
    const Eigen::Index m = columns.cols();
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
    const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), m);
    const auto count = static_cast<Eigen::Index>(moments());
    Matrix projections = Matrix::Zero(m, count + direct_.cols());
    for (std::size_t w = block.begin; w < block.end; ++w) {
      const auto& recording = penalty_.recording_of();
      const bool on = penalty_.cumulative() && w > 0 && recording[w] == recording[w - 1];
      take(w, on, row, spans);
      const auto at = static_cast<Eigen::Index>(w - block.begin);
      for (const auto& span : spans) {
        for (Eigen::Index r = 0; r < m; ++r) {
          add_scaled(q(at, r), row.data(), span.begin, span.end, projections.row(r).data());
        }
      }
      add_products(row.data(), spans.data(), spans.size(), moments(), part.products.data());
    }
    const auto rows = static_cast<Eigen::Index>(block.end - block.begin);
    projections.rightCols(direct_.cols()) =
        q.topRows(rows).transpose() *
        direct_.middleRows(static_cast<Eigen::Index>(block.begin), rows);
    part.triangles.emplace_back(qr.matrixQR().topRows(m).triangularView<Eigen::Upper>());
    part.projections.push_back(std::move(projections));
  }

  /// A window's moments, `on` from those before.
  void take(std::size_t window, bool on, std::vector<double>& row, std::vector<Span>& spans) const {
    const std::size_t size = pieces_.moments();
    for (std::size_t j = 0; j < shaped_; ++j) {
      Span local{size, 0};
      double* own = row.data() + j * size;
      if (on) {
        local = {spans[j].begin - j * size, spans[j].end - j * size};
      } else {
        std::fill(own, own + size, 0.0);
      }
      const auto& nodes = penalty_.nodes(penalty_.shaped()[j].term.direction);
      const std::size_t first = nodes.first[window];
      add_moments(pieces_, nodes.logarithm.data() + first, nodes.weight.data() + first,
                  nodes.first[window + 1] - first, own, local);
      if (local.begin >= local.end) local = {0, 0};  // an empty one, where it adds nothing
      spans[j] = {local.begin + j * size, local.end + j * size};
    }
  }

  const Penalty& penalty_;
  const SpeedPieces& pieces_;
  std::size_t shaped_;
  Eigen::MatrixXd direct_;  ///< probes' columns, over all windows
};

std::vector<Stretch> shares_of(const Penalty& penalty) {
  const auto windows = static_cast<std::size_t>(penalty.window_count());
  std::size_t nodes = 0;
  for (const auto& shaped : penalty.shaped()) {
    nodes = std::max(nodes, penalty.nodes(shaped.term.direction).speed.size());
  }
  const std::size_t count =
      penalty.cumulative() ? 1 : std::clamp(nodes / kPart, std::size_t{1}, kMostParts);
  std::vector<Stretch> parts;
  for (std::size_t i = 0; i < count; ++i) {
    parts.push_back({windows * i / count, windows * (i + 1) / count});
  }
  return parts;
}

}  // namespace

SpeedMoments speed_moments(const Penalty& penalty, const SpeedPieces& pieces, const Probes& probes,
                           base::Pool& pool) {
  const Sums sums(penalty, pieces, probes);
  const auto stretches = shares_of(penalty);
  std::vector<Part> parts(stretches.size());
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) parts[i] = sums.part(stretches[i], pool.cancel());
  };
  if (parts.size() == 1) {
    work(0, 1);
  } else {
    pool.for_each(parts.size(), work);
  }

  const Eigen::Index m = parts[0].triangles[0].cols();
  const auto count = static_cast<Eigen::Index>(sums.moments());
  const auto shaped = static_cast<Eigen::Index>(penalty.shaped().size());
  Eigen::Index blocks = 0;
  for (const auto& part : parts) blocks += static_cast<Eigen::Index>(part.triangles.size());
  Eigen::MatrixXd triangles(blocks * m, m);
  Eigen::MatrixXd projections(blocks * m, count + sums.direct().cols());
  Eigen::MatrixXd products = std::move(parts[0].products);  // by itself as large as all the rest
  for (std::size_t i = 1; i < parts.size(); ++i) products += parts[i].products;
  Eigen::Index row = 0;
  for (const auto& part : parts) {
    for (std::size_t i = 0; i < part.triangles.size(); ++i, row += m) {
      triangles.middleRows(row, m) = part.triangles[i];
      projections.middleRows(row, m) = part.projections[i];
    }
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(triangles);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(triangles.rows(), m);
  SpeedMoments result;
  result.triangle = qr.matrixQR().topRows(m).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd all = q.transpose() * projections;
  result.projections = all.leftCols(count);
  products.selfadjointView<Eigen::Lower>().rankUpdate(result.projections.transpose(), -1.0);
  for (Eigen::Index j = 0; j < count; ++j) {
    const Eigen::Index rest = count - 1 - j;
    products.row(j).tail(rest) = products.col(j).tail(rest).transpose();
  }
  result.products = std::move(products);

  const auto number = static_cast<Eigen::Index>(probes.size());
  result.expected.resize(m * shaped + pairs(shaped), number);
  for (Eigen::Index k = 0; k < number; ++k) {
    const auto own = all.middleCols(count + k * shaped, shaped);
    const auto direct = sums.direct().middleCols(k * shaped, shaped);
    result.expected.col(k).head(m * shaped) = own.reshaped();
    Eigen::Index pair = m * shaped;
    for (Eigen::Index j = 0; j < shaped; ++j) {
      for (Eigen::Index i = 0; i <= j; ++i) {
        result.expected(pair++, k) = direct.col(i).dot(direct.col(j)) - own.col(i).dot(own.col(j));
      }
    }
  }
  return result;
}

}  // namespace jointid::identify
