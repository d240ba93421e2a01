// Digests of parts against the digest of the whole, and the table of a shape.

#include <Eigen/QR>
#include <cmath>
#include <string>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "identify/compressed/digest.hpp"
#include "identify/compressed/shape_table.hpp"

namespace jointid::tests {
namespace {

using identify::Digest;
using identify::ShapeAxis;
using identify::ShapeTable;

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint32_t stream) {
  base::Random random(5, stream, 0, 0);
  Eigen::MatrixXd result(rows, columns);
  for (double& value : result.reshaped()) value = 2.0 * random.uniform() - 1.0;
  return result;
}

Digest digest_rows(const Eigen::MatrixXd& constant, const Eigen::MatrixXd& columns,
                   Eigen::Index begin, Eigen::Index count) {
  Eigen::MatrixXd a = constant.middleRows(begin, count);
  Eigen::MatrixXd b = columns.middleRows(begin, count);
  return identify::digest(a, b, 2);
}

CHECK_CASE("digest: holds every inner product of the rows, whole or merged from parts") {
  const Eigen::Index rows = 997;
  const auto constant = random_matrix(rows, 5, 0);
  const auto columns = random_matrix(rows, 8, 1);  // two shaped columns at four nodes
  for (const Eigen::Index part : {rows, Eigen::Index{100}, Eigen::Index{3}, Eigen::Index{1}}) {
    std::vector<Digest> parts;
    for (Eigen::Index begin = 0; begin < rows; begin += part) {
      parts.push_back(digest_rows(constant, columns, begin, std::min(part, rows - begin)));
    }
    const Digest whole = identify::merge(parts);
    const Eigen::MatrixXd gram = whole.triangle.transpose() * whole.triangle;
    CHECK_CLOSE((gram - constant.transpose() * constant).norm(), 0.0, 1e-11);
    const Eigen::MatrixXd cross = whole.triangle.transpose() * whole.projections;
    CHECK_CLOSE((cross - constant.transpose() * columns).norm(), 0.0, 1e-11);
    for (Eigen::Index node = 0; node < 4; ++node) {
      const Eigen::MatrixXd own = columns.middleCols(2 * node, 2);
      const Eigen::MatrixXd projected = whole.projections.middleCols(2 * node, 2);
      const Eigen::MatrixXd expected = own.transpose() * own - projected.transpose() * projected;
      CHECK_CLOSE(whole.remainders(0, node), expected(0, 0), 1e-11);
      CHECK_CLOSE(whole.remainders(1, node), expected(0, 1), 1e-11);
      CHECK_CLOSE(whole.remainders(2, node), expected(1, 1), 1e-11);
    }
  }
}

CHECK_CASE("shape axis: pieces cover the range, positions and shapes agree") {
  const ShapeAxis gaussian(0.0, 200.0, 1.0, 0.4, 3);
  const ShapeAxis velocity(0.07, 1.7, 0.0, 1.0, 2);
  for (const auto& axis : {gaussian, velocity}) {
    for (int i = 0; i <= 1000; ++i) {
      const double shape = axis.lower() + (axis.upper() - axis.lower()) * i / 1000.0;
      const auto place = axis.place(shape);
      CHECK(place.piece >= 0 && place.piece < axis.pieces());
      CHECK(place.local >= -1.0 && place.local < 1.0);
      CHECK_CLOSE(axis.shape_in(place.piece, place.local), shape, 1e-13 * (1.0 + shape));
      CHECK_CLOSE(axis.shape(axis.position(shape)), shape, 1e-12 * (1.0 + shape));
    }
  }
  CHECK_REFUSED(ShapeAxis(-1.0, 1.0, 0.0, 1.0, 3), "positive scale");
}

CHECK_CASE("shape table: gives smooth functions and their derivatives to rounding") {
  const ShapeAxis axis(0.0, 200.0, 1.0, 0.4, 3);
  const std::vector<double> squares{0.0, 0.01, 0.3, 4.0};
  const auto points = identify::chebyshev_points(70);
  Eigen::MatrixXd values(4, points.size());
  for (Eigen::Index k = 0; k < points.size(); ++k) {
    for (std::size_t f = 0; f < 4; ++f) {
      values(static_cast<Eigen::Index>(f), k) = std::exp(-axis.shape(points[k]) * squares[f]);
    }
  }
  const ShapeTable table(axis, values, 11);
  std::vector<double> found(table.width());
  std::vector<double> slope(table.width());
  for (int i = 0; i <= 3000; ++i) {
    const double shape = 200.0 * std::pow(i / 3000.0, 3.0);
    table.values(shape, found.data());
    table.slopes(shape, slope.data());
    for (std::size_t f = 0; f < 4; ++f) {
      const double expected = std::exp(-shape * squares[f]);
      CHECK_CLOSE(found[f], expected, 2e-13);
      CHECK_CLOSE(slope[f], -squares[f] * expected, 1e-11);
    }
  }
}

}  // namespace
}  // namespace jointid::tests
